import os
import tomllib
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from handeye.errors import InvalidInput
from handeye.thesis.claims import load_all, load_claims
from handeye.thesis.experiment import Effort
from handeye.thesis.experiments import EXPERIMENTS
from handeye.thesis.judge import judge
from handeye.thesis.records import Records
from handeye.thesis.reproduce import select
from handeye.thesis.runner import run
from handeye.thesis.shapes import SHAPES

CLAIMS = load_claims()
MEASURED = [claim for claim in load_all() if claim.measure]


@pytest.fixture(scope="module")
def original(repository: Path) -> list[dict[str, Any]]:
    """The list that the package's own was made from, which is not part of the repository."""
    folder = Path(os.environ.get("HANDEYE_SHARED", repository.parent / "shared"))
    path = folder / "thesis" / "claims.toml"
    if not path.is_file():
        pytest.skip("the original list of claims is absent (set HANDEYE_SHARED to its folder)")
    return tomllib.loads(path.read_text(encoding="utf-8"))["claim"]


def test_no_claim_is_missing_or_loosened(original: list[dict[str, Any]]):
    ours = {claim.id: claim for claim in CLAIMS}
    for stated in original:
        claim = ours[stated["id"]]
        for key in ("rule", "value", "unit"):
            assert getattr(claim, key) == stated.get(key), (claim.id, key)
        if "tol" in stated:
            assert claim.tol is not None
            assert claim.tol <= stated["tol"], claim.id
    order = [claim.id for claim in CLAIMS if claim.id in {stated["id"] for stated in original}]
    assert order == [stated["id"] for stated in original]


def test_ids_are_unique_and_every_claim_can_be_judged():
    assert len({claim.id for claim in CLAIMS}) == len(CLAIMS)
    for claim in CLAIMS:
        assert claim.says, claim.id
        assert claim.where, claim.id
        by_value = claim.rule in {"within", "at_most", "at_least"}
        assert by_value or claim.rule in {"order", "shape"}
        for needed in (claim.value, claim.tol, claim.unit):
            assert (needed is not None) == by_value, claim.id
        if claim.value is not None and claim.tol is not None:
            assert claim.value > 0.0
            assert claim.tol >= 0.0


def test_this_version_measures_every_claim_of_the_thesis():
    assert all(claim.measure for claim in CLAIMS)
    assert select() == MEASURED


def test_orderings_and_shapes_have_a_predicate_and_of_the_figures_what_says_more_than_that():
    assert {claim.id for claim in MEASURED if claim.value is None} == set(SHAPES) - {"mentor"}


def test_claims_name_experiments_and_every_experiment_serves_a_claim_or_a_drawing():
    drawings = {
        "distortions", "comparison", "catch-flights", "catch-changes", "combined-misfit",
        "catch-choices", "catch-delay", "paired-series", "influence", "earlier", "real-ur10-order",
    }  # fmt: skip
    claimed = {name for claim in MEASURED for name in claim.experiments}
    assert claimed | drawings == set(EXPERIMENTS)


@pytest.fixture(scope="module")
def small() -> Records:
    return run(list(EXPERIMENTS.values()), replicates=2, jobs=1, effort=Effort(0.01))


def test_every_measured_claim_finds_its_records(small: Records):
    for claim in MEASURED:
        row = judge(claim, small)
        assert row.id == claim.id
        assert row.stated == claim.value
        assert row.measured is not None
        for other in claim.also:
            assert other.what in row.note.lower() or other.what in row.note


def test_a_claim_without_an_experiment_has_no_row(small: Records):
    pending = replace(CLAIMS[0], measure=None)
    with pytest.raises(InvalidInput, match=pending.id):
        judge(pending, small)
