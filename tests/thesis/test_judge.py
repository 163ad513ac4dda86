from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy import stats

from handeye.errors import InvalidInput
from handeye.intervals import wilson_interval
from handeye.thesis.claims import Also, Claim, Rule
from handeye.thesis.judge import SHARE, agrees, judge, t_interval
from handeye.thesis.records import Record, Records
from handeye.thesis.shapes import SHAPES, Finding

VALUED: tuple[Rule, ...] = ("within", "at_most", "at_least")
CLAIM = Claim("made-up", "1.1", "a length", "within", 0.01, "m", 0.1, measure="x/y/error")


def recorded(*values: float, quantity: str = "error") -> Records:
    return Records(Record("x", "y", i, quantity, None, v) for i, v in enumerate(values))


@pytest.mark.parametrize(
    ("rule", "kept", "broken"),
    [
        ("within", (0.9, 1.0, 1.1), (0.899, 1.101)),
        ("at_most", (-5.0, 0.0, 1.0, 1.1), (1.101,)),
        ("at_least", (0.9, 1.0, 50.0), (0.899, 0.0)),
    ],
)
def test_rules_by_hand(rule: Rule, kept: tuple[float, ...], broken: tuple[float, ...]):
    claim = replace(CLAIM, rule=rule, value=1.0, tol=0.1)
    assert all(agrees(claim, measured) for measured in kept)
    assert not any(agrees(claim, measured) for measured in broken)


values = st.floats(1e-6, 1e4)
tolerances = st.floats(0.0, 0.9)


@given(value=values, tol=tolerances, outside=st.floats(1e-6, 10.0))
def test_the_limit_itself_agrees_and_beyond_it_nothing_does(
    value: float, tol: float, outside: float
):
    low, high = value * (1.0 - tol), value * (1.0 + tol)
    below, above = low - outside * value, high + outside * value
    claims = {rule: replace(CLAIM, rule=rule, value=value, tol=tol) for rule in VALUED}
    for rule, agreeing, not_agreeing in (
        ("within", (low, value, high), (below, above)),
        ("at_most", (below, low, value, high), (above,)),
        ("at_least", (low, value, high, above), (below,)),
    ):
        assert all(agrees(claims[rule], measured) for measured in agreeing)
        assert not any(agrees(claims[rule], measured) for measured in not_agreeing)


def test_only_claims_with_a_value_and_a_rule_for_it_are_compared():
    no_value, no_tol = replace(CLAIM, value=None), replace(CLAIM, tol=None)
    for wrong in (no_value, no_tol, replace(CLAIM, rule="order")):
        with pytest.raises(InvalidInput, match="made-up"):
            agrees(wrong, 0.01)


def test_the_mean_is_judged_whatever_single_replicates_are():
    row = judge(CLAIM, recorded(0.002, 0.018))
    assert row.measured == pytest.approx(0.01)
    assert (row.verdict, row.replicates) == ("reproduced", 2)
    row = judge(CLAIM, recorded(0.0119, 0.0121, 0.0120))
    assert row.verdict == "not reproduced"
    assert row.measured == pytest.approx(0.012)
    assert row.stated == 0.01
    assert row.unit == "m"


@pytest.mark.parametrize(
    ("error", "holds", "verdict"),
    [
        (0.01, True, "reproduced"), (0.01, False, "not reproduced"), (0.02, True, "not reproduced"),
    ],
)  # fmt: skip
def test_a_figure_with_a_predicate_keeps_both_or_neither(
    error: float, holds: bool, verdict: str, monkeypatch: pytest.MonkeyPatch
):
    found = Finding((holds, holds), holds, "What decides.")
    monkeypatch.setitem(SHAPES, CLAIM.id, lambda records, limits: found)  # noqa: ARG005
    row = judge(CLAIM, recorded(error, error))
    assert row.verdict == verdict
    assert row.measured == pytest.approx(error)
    assert row.note.startswith("What decides.")


@given(st.lists(st.floats(-1e3, 1e3), min_size=2, max_size=30))
def test_t_interval_equals_scipys(sample: list[float]):
    interval = t_interval(np.array(sample))
    assert interval is not None
    spread = np.std(sample, ddof=1) / np.sqrt(len(sample))
    if spread > 1e-9:
        low, high = stats.t.interval(0.95, len(sample) - 1, np.mean(sample), spread)
        expected = [float(low), float(high)]
        np.testing.assert_allclose(interval, expected, rtol=1e-9, atol=1e-9)
    assert interval[0] <= np.mean(sample) <= interval[1]


@given(st.integers(1, 500).flatmap(lambda n: st.tuples(st.integers(0, n), st.just(n))))
def test_wilson_interval_equals_scipys(tries: tuple[int, int]):
    successes, n = tries
    low, high = wilson_interval(successes, n)
    expected = stats.binomtest(successes, n).proportion_ci(0.95, "wilson")
    np.testing.assert_allclose((low, high), expected, rtol=1e-9, atol=1e-12)
    assert 0.0 <= low <= successes / n <= high <= 1.0


def test_one_random_replicate_has_no_interval_and_a_deterministic_one_no_width():
    assert t_interval(np.array([1.0])) is None
    row = judge(CLAIM, recorded(0.0105))
    assert (row.low, row.high, row.verdict) == (None, None, "reproduced")
    assert "no interval" in row.note
    row = judge(CLAIM, recorded(0.0105), deterministic=True)
    assert (row.low, row.measured, row.high, row.replicates) == (0.0105, 0.0105, 0.0105, 1)
    assert row.note == ""


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_what_is_not_finite_is_not_testable(bad: float):
    row = judge(CLAIM, recorded(0.01, bad, 0.01))
    assert (row.verdict, row.measured, row.low, row.high) == ("not testable", None, None, None)
    assert "Not finite in 1 of 3" in row.note


def test_notes_quote_what_the_claim_asks_for_in_its_own_scale():
    claim = replace(CLAIM, note="First.", also=(Also("the rest", "x/y/rest", "m"),))
    rows = [*recorded(0.01, 0.01).rows, *recorded(0.002, 0.004, quantity="rest").rows]
    assert judge(claim, Records(rows)).note == "First. The rest: 0.300 cm."


def test_missing_records_are_an_error_that_names_near_ones():
    with pytest.raises(InvalidInput, match="x/y/eror; did you mean x/y/error"):
        judge(replace(CLAIM, measure="x/y/eror"), recorded(0.01))


def shape_records(neurons: tuple[int, ...]) -> Records:
    rows = [Record("exact", "clean", i, "neurons", None, n) for i, n in enumerate(neurons)]
    others = ("largest_error", "change", "change_without_threshold")
    rows += [Record("exact", "clean", i, n, None, 0.0) for n in others for i in range(len(neurons))]
    return Records(rows)


SHAPE = Claim(
    "exact-plant-stays-empty", "1.1", "nothing", "shape", measure="exact", note="Half.",
    limits={"neurons": 0, "error": 1e-11, "change": 1e-11},
)  # fmt: skip


def test_a_shape_is_measured_by_the_share_of_replicates_in_which_it_holds():
    row = judge(SHAPE, shape_records((0, 0, 0, 0)))
    assert (row.stated, row.unit, row.measured, row.replicates) == (None, SHARE, 1.0, 4)
    assert (row.low, row.high) == wilson_interval(4, 4)
    assert row.verdict == "reproduced"
    row = judge(SHAPE, shape_records((0, 1, 0, 0)))
    assert (row.measured, row.verdict) == (0.75, "not reproduced")
    assert (row.low, row.high) == wilson_interval(3, 4)
    assert row.note.startswith("At most 1 neurons")
    assert row.note.endswith("Half.")


def test_a_shape_seen_once_has_no_interval_unless_nothing_is_random():
    assert judge(SHAPE, shape_records((0,))).low is None
    row = judge(SHAPE, shape_records((0,)), deterministic=True)
    assert (row.low, row.high) == (1.0, 1.0)


def test_a_row_has_exactly_the_published_keys():
    assert list(judge(CLAIM, recorded(0.01)).to_json()) == [
        "id", "stated", "unit", "measured", "low", "high", "replicates", "verdict", "note",
    ]  # fmt: skip
