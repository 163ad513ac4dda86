"""Commands stay in their envelope, and fall back to nominal while corrections are worse."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.calibration.combined.robots import MODEL, joined, mean_error, stream, taught

from handeye.calibration.combined import Combined, Settings
from handeye.calibration.combined.guard import Comparison
from handeye.thesis.plants import NOMINAL

FOOLING = st.sampled_from(["mirrored", "frozen", "scaled", "random", "shifted", "turned"])


def fooled(seen, how, rng):
    """A stream that no robot could have sent, or one that is not this robot."""
    n = len(seen)
    if how == "mirrored":
        return replace(seen, pointing=-seen.pointing)
    if how == "frozen":
        return replace(seen, range=np.full(n, 1.3), eccentricity=np.zeros(n))
    if how == "scaled":
        return replace(seen, range=seen.range * 3.0)
    if how == "random":
        return replace(seen, range=rng.uniform(0.1, 5.0, n), pointing=rng.uniform(-3, 3, n))
    if how == "shifted":
        return replace(seen, joints=np.roll(seen.joints, 1, axis=0))
    return replace(seen, pointing=seen.pointing + np.linspace(0.0, 3.0, n))


@settings(max_examples=8)
@given(how=st.lists(FOOLING, min_size=1, max_size=3), seed=st.integers(0, 1000))
def test_no_stream_drives_commands_out_of_their_envelope(how, seed):
    rng = np.random.default_rng(seed)
    envelope = float(rng.uniform(0.02, 0.3))
    combined = Combined(MODEL, settings=Settings(envelope=envelope, window=16))
    combined.observe_many(joined(*(fooled(stream(25, i), h, rng) for i, h in enumerate(how))))
    target = stream(60, 9).target
    joints = combined.command(target)
    assert np.isfinite(joints).all()
    assert (np.abs(joints) <= np.pi).all()
    away = NOMINAL.tips(joints) - NOMINAL.tips(NOMINAL.joints_for(target))
    assert np.linalg.norm(away, axis=1).max() <= envelope * (1.0 + 1e-6)
    assert np.isfinite(combined.covariance(target)).all()
    assert combined.health()


def test_commands_inside_the_envelope_are_not_touched():
    wide, seen = taught(), stream(150)
    narrow = Combined(MODEL, settings=Settings(envelope=0.3))
    narrow.observe_many(seen)
    target = stream(60, 9).target
    np.testing.assert_allclose(narrow.command(target), wide.command(target), atol=1e-12)


def test_it_falls_back_while_it_is_worse_than_nominal_says_so_and_recovers(monkeypatch):
    """Something has got a wrong robot into it, and learning does not mend it."""
    combined, right = Combined(MODEL), taught().engine.x
    monkeypatch.setattr(combined.engine, "learn", lambda _: False)
    combined.engine.x = right.copy()
    combined.engine.x[5] += 0.1
    seen = stream(60, 3)
    errors = combined.observe_many(seen[:30]).error
    assert combined.falling_back
    assert [event.kind for event in combined.events] == ["fallback"]
    fell = combined.comparison.n - np.count_nonzero(
        np.abs(errors - Combined(MODEL).errors(seen[:30])).max(axis=1) < 1e-12
    )
    assert 10 <= fell <= 15
    np.testing.assert_allclose(
        combined.command(seen.target), NOMINAL.joints_for(seen.target), atol=1e-9
    )
    combined.engine.x = right
    combined.observe_many(seen[30:])
    assert not combined.falling_back
    assert [event.kind for event in combined.events] == ["fallback", "recovered"]


def test_after_a_stream_without_sense_it_learns_again():
    rng = np.random.default_rng(1)
    combined = Combined(MODEL, settings=Settings(window=32))
    combined.observe_many(fooled(stream(40), "random", rng))
    combined.observe_many(stream(150, 3))
    assert not combined.falling_back
    assert mean_error(combined) < 1.3 * mean_error(taught())


def test_a_comparison_is_mean_over_standard_error():
    rng = np.random.default_rng(0)
    comparison = Comparison(20, 3.0)
    a, b = rng.uniform(0.5, 1.5, (2, 35))
    for one, other in zip(a, b, strict=True):
        comparison.add(float(one), float(other))
    scores = ((a - b) / (a + b))[-20:]
    expected = scores.mean() / (scores.std(ddof=1) / np.sqrt(20))
    assert comparison.significance == pytest.approx(expected)
    assert not comparison.a_is_worse


@pytest.mark.parametrize(("a", "b"), [(2.0, 1.0), (1.0, 2.0), (1.0, 1.0), (0.0, 0.0)])
def test_a_comparison_tells_who_is_worse(a, b):
    comparison = Comparison(20, 3.0)
    for i in range(20):
        assert comparison.significance == 0.0 or i >= 10
        comparison.add(a, b)
    assert comparison.a_is_worse == (a > b)
    assert comparison.b_is_worse == (b > a)
    other = Comparison(20, 3.0)
    other.restore(comparison.arrays())
    assert other.significance == comparison.significance
    with pytest.raises(ValueError, match="length"):
        Comparison(30, 3.0).restore(comparison.arrays())
