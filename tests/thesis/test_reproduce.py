from dataclasses import replace

import pytest

from handeye.errors import InvalidInput
from handeye.thesis.claims import load_all
from handeye.thesis.experiment import Effort
from handeye.thesis.reproduce import choose, reproduce, select, verdicts
from handeye.thesis.storage import Stored


def ids(*names: str) -> list[str]:
    return [claim.id for claim in select(names)]


def test_names_are_exact_beginnings_or_patterns():
    assert ids("plant-uncorrected-full") == ["plant-uncorrected-full"]
    assert ids("preferred-free") == [
        "preferred-free-noisy", "preferred-free-noisy-neurons",
        "preferred-free-clean", "preferred-free-clean-neurons",
    ]  # fmt: skip
    assert ids("preferred") == ids("preferred-*")
    assert ids("*-floor") == ["plant-noise-floor"]


def test_a_claim_is_meant_before_those_whose_names_begin_with_its_own():
    assert ids("plant-uncorrected") == ["plant-uncorrected"]
    assert ids("preferred-free-noisy") == ["preferred-free-noisy"]


def test_claims_come_once_and_in_the_order_of_the_thesis():
    assert ids("preferred", "plant", "*") == [c.id for c in load_all() if c.measure]


def test_patterns_pass_over_claims_that_cannot_be_measured_yet():
    assert ids("p*") == [c.id for c in load_all() if c.id.startswith("p") and c.measure]


def test_unknown_names_are_answered_with_near_ones():
    with pytest.raises(InvalidInput, match=r"'plant-uncorected'.*did you mean plant-uncorrected"):
        reproduce(["plant-uncorected"])
    with pytest.raises(InvalidInput, match=r"'floor'.*did you mean plant-noise-floor"):
        select(["floor"])
    with pytest.raises(InvalidInput, match=r"'zzz'.*claims begin with plant, exact"):
        select(["plant", "zzz"])


def test_a_name_is_not_matched_in_the_middle_of_a_word():
    with pytest.raises(InvalidInput, match=r"'plan'"):
        select(["plan"])


def test_claims_without_an_experiment_are_named(monkeypatch: pytest.MonkeyPatch):
    known = load_all()
    later = replace(known[0], id="later-claim", measure=None)
    monkeypatch.setattr("handeye.thesis.reproduce.load_all", lambda: (*known, later))
    with pytest.raises(InvalidInput, match=r"no experiment .* later-claim; it has"):
        reproduce(["later-*"])


def test_rows_of_one_claim_with_a_measured_interval():
    (row,) = reproduce(["plant-uncorrected-large"], replicates=3, jobs=1)
    assert row.stated == 0.40
    assert row.replicates == 3
    assert row.measured is not None
    assert row.low is not None
    assert row.high is not None
    assert row.low < row.measured < row.high
    assert row.verdict == "reproduced"
    assert "With both" in row.note


def test_deterministic_claims_have_one_replicate():
    fixed = ("plant-perturbation-size", "plant-excluded-region")
    for row in reproduce(fixed, replicates=5, jobs=1):
        assert (row.low, row.measured, row.high) == (1.0, 1.0, 1.0)
        assert (row.replicates, row.verdict) == (1, "reproduced")


def test_every_claim_has_a_row_even_in_a_small_run(smoke_run: Stored):
    rows = verdicts(choose().claims, smoke_run)
    assert [row.id for row in rows] == [claim.id for claim in select()]


def test_progress_is_told():
    told: list[int] = []
    reproduce(
        ["plant-excluded-region", "plant-uncorrected"],
        replicates=2,
        jobs=1,
        effort=Effort(0.01),
        progress=lambda done, _: told.append(done),
    )
    assert told == list(range(len(told)))
    assert len(told) > 2
