"""What a figure of the thesis is here: drawn from records, or listed with the reason why not."""

import re
from collections.abc import Callable
from dataclasses import dataclass

from matplotlib.figure import Figure

from handeye.thesis.claims import claims_by_id
from handeye.thesis.records import Records


@dataclass(frozen=True)
class Drawn:
    """A figure that shows a result.

    number       in the thesis, such as "3.22"
    title        what is asked or compared
    caption      what is drawn, and what to see
    draw         makes it, from records only
    experiments  whose records it needs, by id
    claims       that it illustrates besides those that name it, by id
    """

    number: str
    title: str
    caption: str
    draw: Callable[[Records], Figure]
    experiments: tuple[str, ...]
    claims: tuple[str, ...] = ()

    @property
    def shows(self) -> tuple[str, ...]:
        """Every claim that it illustrates, by id."""
        named = [c.id for c in claims_by_id().values() if self.number in _figures(c.where)]
        return tuple(dict.fromkeys((*named, *self.claims)))


@dataclass(frozen=True)
class NotDrawn:
    """A figure that shows no result: a drawing or a diagram."""

    number: str
    title: str
    reason: str


def stated(claim: str) -> float:
    """The figure that a claim states."""
    value = claims_by_id()[claim].value
    assert value is not None, f"{claim} states no figure"
    return value


def _figures(where: str) -> list[str]:
    """The figures in a reference such as "3.5.4, figures 3.22a, 3.23"."""
    return re.findall(r"(?:\d+|[A-Z])\.\d+", where.partition("figure")[2])
