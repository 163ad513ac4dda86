"""What it takes to make stored records again: settings, versions, random streams."""

import inspect
import platform
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, fields, is_dataclass
from functools import partial
from importlib.metadata import version
from typing import Any, cast

import numpy as np

from handeye.thesis.experiment import FULL, Effort, Experiment

STREAMS = (
    "numpy default_rng(SeedSequence([crc32(name), replicate])); names such as 'world: train poses' "
    "(handeye.randomness, handeye.calibration.session)"
)
_PACKAGES = ("handeye", "numpy", "scipy", "numba")


@dataclass(frozen=True)
class Ran:
    """One experiment as it was run: its settings as text, and what measured them."""

    measure: str
    replicates: int
    deterministic: bool
    settings: Mapping[str, str]


@dataclass(frozen=True)
class Manifest:
    """How records came about.

    versions     of the interpreter and of the packages that decide the numbers
    replicates   repetitions that were asked for, None for each experiment's own number
    effort       fraction of the trials and tests that were run; verdicts mean something at 1
    streams      how random numbers follow from names and replicates
    experiments  by id
    """

    versions: Mapping[str, str]
    replicates: int | None
    effort: float
    streams: str
    experiments: Mapping[str, Ran]

    @classmethod
    def of(
        cls,
        experiments: Sequence[Experiment[Any]],
        replicates: int | None = None,
        effort: Effort = FULL,
    ) -> "Manifest":
        """Of a run with these arguments, by this interpreter."""
        ran = {
            experiment.id: Ran(
                describe(experiment.measure),
                experiment.repetitions(replicates),
                experiment.deterministic,
                {name: describe(setting) for name, setting in experiment.settings.items()},
            )
            for experiment in experiments
        }
        versions = {"python": platform.python_version()}
        versions |= {name: version(name) for name in _PACKAGES}
        return cls(versions, replicates, effort.fraction, STREAMS, ran)

    @classmethod
    def from_json(cls, data: Mapping[str, Any]) -> "Manifest":
        """What `to_json` gave; a KeyError or TypeError where it is something else."""
        ran = {name: Ran(**one) for name, one in data["experiments"].items()}
        replicates, effort = data["replicates"], float(data["effort"])
        return cls(dict(data["versions"]), replicates, effort, str(data["streams"]), ran)

    def to_json(self) -> dict[str, Any]:
        """Plain values under the fields' names."""
        return asdict(self)

    def deterministic(self, names: Sequence[str]) -> bool:
        """Whether nothing was random in any of these experiments."""
        return all(self.experiments[name].deterministic for name in names)


def describe(value: Any) -> str:
    """A setting as text, the same on every run: classes with all fields, functions by name."""
    if is_dataclass(value) and not isinstance(value, type):
        named = {field.name: getattr(value, field.name) for field in fields(value)}
        return _call(type(value).__name__, (), named)
    named_tuple = None if isinstance(value, type) else getattr(value, "_asdict", None)
    if named_tuple is not None:
        return _call(type(value).__name__, (), named_tuple())
    if isinstance(value, partial):
        of = cast("partial[Any]", value)
        return _call(f"partial:{describe(of.func)}", of.args, of.keywords)
    if isinstance(value, type) or inspect.isroutine(value):
        return f"{value.__module__}.{value.__qualname__}"
    return _plain(value)


def _plain(value: Any) -> str:
    if isinstance(value, np.ndarray | np.generic):
        return describe(value.tolist())
    if isinstance(value, tuple | list):
        inside = ", ".join(describe(part) for part in cast("Sequence[object]", value))
        return f"({inside})" if isinstance(value, tuple) else f"[{inside}]"
    if isinstance(value, Mapping):
        items = cast("Mapping[object, object]", value).items()
        return "{" + ", ".join(f"{describe(k)}: {describe(v)}" for k, v in items) + "}"
    if value is None or isinstance(value, str | bytes | bool | int | float | complex):
        return repr(value)
    # Most other classes would show their address.
    return type(value).__name__


def _call(name: str, values: Sequence[object], named: Mapping[str, object]) -> str:
    parts = [describe(value) for value in values]
    parts += [f"{key}={describe(value)}" for key, value in named.items()]
    return f"{name}({', '.join(parts)})"
