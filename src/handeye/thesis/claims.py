"""What the thesis states, and what is to be better than that, as data."""

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
    of this version can check the claim. A target is a claim that the thesis does not make: it has
    no place there (`where` is empty).
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
    worst_of: tuple[str, ...] = ()

    @property
    def is_target(self) -> bool:
        """Whether it says what has to be reached, and not what the thesis has reached."""
        return not self.where

    @property
    def experiments(self) -> tuple[str, ...]:
        """The experiments whose records it looks at, each once."""
        paths = [self.measure, *self.worst_of, *(other.measure for other in self.also)]
        return tuple(dict.fromkeys(path.split("/")[0] for path in paths if path))


def load_claims() -> tuple[Claim, ...]:
    """Every claim of the thesis, in its order."""
    return _load("claims.toml")


def load_targets() -> tuple[Claim, ...]:
    """Where this package has to be better than the thesis."""
    return _load("targets.toml")


def load_all() -> tuple[Claim, ...]:
    """The claims of the thesis, then the targets."""
    return load_claims() + load_targets()


@cache
def claims_by_id() -> Mapping[str, Claim]:
    """Every claim and every target, by id."""
    return {claim.id: claim for claim in load_all()}


def _load(name: str) -> tuple[Claim, ...]:
    text = resources.files("handeye.thesis").joinpath(name).read_text(encoding="utf-8")
    return tuple(_claim(table) for table in tomllib.loads(text)["claim"])


def _claim(table: dict[str, Any]) -> Claim:
    others = tuple(Also(**{"unit": table.get("unit", ""), **o}) for o in table.pop("also", ()))
    where, worst_of = table.pop("where", ""), tuple(table.pop("worst_of", ()))
    return Claim(where=where, **table, also=others, worst_of=worst_of)
