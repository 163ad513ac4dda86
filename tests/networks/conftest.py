"""Every registered kind of response, schedule and rule, so that a new one cannot be forgotten."""

import os
from itertools import product
from typing import NamedTuple

import pytest

from handeye.networks.adaptation import RULES
from handeye.networks.responses import RESPONSES
from handeye.networks.schedules import SCHEDULES


class Kinds(NamedTuple):
    """What one network is made of."""

    response: NamedTuple
    schedule: NamedTuple
    adaptation: NamedTuple


def _ours(kinds: dict[str, type]) -> list[NamedTuple]:
    """The package's own: a test of the documentation may have registered others."""
    return [kind() for kind in kinds.values() if kind.__module__.startswith("handeye.")]


RESPONSE, SCHEDULE, RULE = (_ours(kinds) for kinds in (RESPONSES, SCHEDULES, RULES))
EVERY = [Kinds(*kinds) for kinds in product(RESPONSE, SCHEDULE, RULE)]
# A rule and a response meet inside a formula; a schedule meets neither. Each combination costs
# seconds to compile, so with compilation on we try every pair of the first two and every schedule.
PAIRS = [k for k in EVERY if k.schedule == SCHEDULE[0] or k[::2] == (RESPONSE[0], RULE[0])]


def _name(kinds: NamedTuple) -> str:
    parts = kinds if isinstance(kinds, Kinds) else (kinds,)
    return "-".join(type(part).__name__ for part in parts)


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """`every_kinds`: all combinations; `kinds`: enough of them; and each kind on its own."""
    lists = {
        "every_kinds": EVERY if os.environ.get("NUMBA_DISABLE_JIT") == "1" else PAIRS,
        "kinds": PAIRS,
        "response": RESPONSE,
        "schedule": SCHEDULE,
        "rule": RULE,
    }
    for name in lists.keys() & set(metafunc.fixturenames):
        metafunc.parametrize(name, lists[name], ids=_name)
