"""What the thesis states, as data."""

import tomllib
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cache
from importlib import resources
from typing import Any, Literal

Rule = Literal["within", "at_most", "at_least", "order", "shape"]


@dataclass(frozen=True)
class Also:
    """Another measured quantity that a claim's note quotes: path in the records, unit."""

    what: str
    measure: str
    unit: str


@dataclass(frozen=True)
class Claim:
    """One statement, and what in the records of which experiment measures it.

    The keys are explained at the top of `claims.toml`. `measure` is None as long as no experiment
    of this version can check the claim.
    """

    id: str
    where: str
    says: str
    rule: Rule
    value: float | None = None
    unit: str | None = None
    tol: float | None = None
    note: str = ""
    measure: str | None = None
    limits: Mapping[str, float] = field(default_factory=dict[str, float])
    also: tuple[Also, ...] = ()

    @property
    def experiments(self) -> tuple[str, ...]:
        """The experiments whose records it looks at, each once."""
        paths = [self.measure, *(other.measure for other in self.also)]
        return tuple(dict.fromkeys(path.split("/")[0] for path in paths if path))


def load_claims() -> tuple[Claim, ...]:
    """Every claim, in the order of the thesis."""
    text = resources.files("handeye.thesis").joinpath("claims.toml").read_text(encoding="utf-8")
    return tuple(_claim(table) for table in tomllib.loads(text)["claim"])


@cache
def claims_by_id() -> Mapping[str, Claim]:
    """Every claim, by id."""
    return {claim.id: claim for claim in load_claims()}


def _claim(table: dict[str, Any]) -> Claim:
    others = tuple(Also(**{"unit": table.get("unit", ""), **o}) for o in table.pop("also", ()))
    return Claim(**table, also=others)
