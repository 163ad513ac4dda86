"""The bank of filters: batch and recursive, gauges, evidence, the window."""

from dataclasses import asdict

import numpy as np
import pytest
from tests.calibration.combined.robots import CHAIN, MODEL, stream

from handeye.calibration.combined import Combined, DataSheet, Hypothesis, Settings
from handeye.calibration.combined.planar.chain import planar_chain, seen_rows
from handeye.calibration.combined.planar.kernels import planar_residuals
from handeye.calibration.engine.engine import Engine
from handeye.calibration.engine.filter import relearn
from handeye.errors import InvalidInput
from handeye.thesis.plants import NOMINAL, NORMAL

STEADY = Settings(hypotheses=(Hypothesis("steady", memory=1e15),), window=16, gate=1e-12)
TINY = DataSheet(
    **{
        name: value * 1e-6 if name not in {"joint_length", "pointing_length"} else value
        for name, value in asdict(DataSheet()).items()
        if name not in {"unexplained", "resolution"}
    },
    unexplained=1e-9,
    resolution=1e-9,
)


def learned(rows, settings=STEADY, sheet=None, chain=None):
    sheet = sheet or DataSheet()
    chain = chain or planar_chain(MODEL, sheet)
    engine = Engine(chain, settings, (sheet.unexplained, sheet.unexplained))
    for row in rows:
        engine.learn(row)
    return engine


def batch(chain, rows, doubt, x):
    """Normal equations of residuals at x, priors included: information in tolerances, estimate."""
    basis = np.linalg.qr(np.array([g.direction for g in chain.gauges]).T).Q
    away = np.eye(len(x)) - basis @ basis.T
    information, right = np.eye(len(x)), np.zeros(len(x))
    for row in rows:
        values, slopes = np.empty(2), np.empty((2, len(x)))
        planar_residuals(chain.kernel, x, row, doubt, values, slopes)
        H = slopes * chain.tolerance @ away
        information += H.T @ H
        right += H.T @ (H @ (x / chain.tolerance) - values)
    return information, np.linalg.solve(information, right)


def test_recursive_is_batch_where_the_robot_is_linear():
    rows = seen_rows(stream(40, plant=NOMINAL))
    chain = planar_chain(MODEL, TINY)
    engine = learned(rows, sheet=TINY, chain=chain)
    information, d = batch(chain, rows, TINY.unexplained, np.zeros(len(chain.names)))
    R = engine.bank.roots[0, :, :-1]
    np.testing.assert_allclose(R.T @ R, information, rtol=1e-5, atol=1e-8)
    np.testing.assert_allclose(engine.bank.d[0], d, rtol=1e-3, atol=1e-9)


def test_within_the_window_it_is_gauss_newton_over_everything():
    rows = seen_rows(stream(12))
    engine = learned(rows)
    relearn(CHAIN.kernel, engine.rules, engine.bank, 0, 20)
    x = engine.rules.spreads[0] * engine.bank.d[0]
    information, d = batch(engine.chain, rows, DataSheet().unexplained, x)
    R = engine.bank.roots[0, :, :-1]
    np.testing.assert_allclose(R.T @ R, information, rtol=1e-4, atol=1e-3)
    np.testing.assert_allclose(d, engine.bank.d[0], atol=1e-4)


def test_evidence_is_the_log_likelihood_of_all_that_was_seen():
    rows = seen_rows(stream(10, plant=NOMINAL))
    chain = planar_chain(MODEL, TINY)
    engine = learned(rows, sheet=TINY, chain=chain)
    n = len(chain.names)
    H, r = [], []
    basis = np.linalg.qr(np.array([g.direction for g in chain.gauges]).T).Q
    for row in rows:
        values, slopes = np.empty(2), np.empty((2, n))
        planar_residuals(chain.kernel, np.zeros(n), row, TINY.unexplained, values, slopes)
        H.append(slopes * chain.tolerance @ (np.eye(n) - basis @ basis.T))
        r.append(values)
    H, r = np.concatenate(H), np.concatenate(r)
    S = np.eye(len(r)) + H @ H.T
    expected = -0.5 * r @ np.linalg.solve(S, r) - 0.5 * np.linalg.slogdet(S)[1]
    assert engine.bank.gains[0].sum() == pytest.approx(expected, rel=1e-5)


def test_nothing_is_ever_learned_about_the_gauges_and_they_are_named():
    combined = Combined(MODEL)
    combined.observe_many(stream(200))
    engine = combined.engine
    for h in range(3):
        gauges = engine.rules.gauges[h]
        R = engine.bank.roots[h, :, :-1]
        np.testing.assert_allclose(gauges @ R.T @ R @ gauges.T, np.eye(2), atol=1e-6)
        np.testing.assert_allclose(gauges @ engine.bank.d[h], 0.0, atol=1e-6)
    knowledge = combined.knowledge()
    assert [w for w in knowledge.undetermined if "turning" in w]
    assert [w for w in knowledge.undetermined if "growing" in w]
    tolerance = engine.chain.tolerance
    scaled = knowledge.covariance / np.outer(tolerance, tolerance)
    np.testing.assert_allclose(
        np.diag(engine.rules.gauges[0] @ scaled @ engine.rules.gauges[0].T), 1.0, atol=1e-3
    )


def test_evidence_tells_a_straight_robot_from_a_crooked_one():
    straight, crooked = Combined(MODEL), Combined(MODEL)
    straight.observe_many(stream(100, plant=NORMAL.without_perturbations()))
    crooked.observe_many(stream(100))
    assert straight.engine.shares[0] > 0.9
    assert crooked.engine.shares[0] < 1e-3
    assert "as drawn" in straight.health()
    assert np.abs(straight.engine.x[8:]).max() < 1e-4


def test_cost_and_memory_stay_the_same():
    combined = Combined(MODEL)
    sizes = []
    for n in (70, 400):
        combined.observe_many(stream(n))
        sizes.append(sum(part.nbytes for part in combined.engine.bank))
    assert sizes[0] == sizes[1]


@pytest.mark.parametrize(
    ("kind", "wrong"),
    [
        (Settings, {"window": 2}),
        (Settings, {"gate": 0.5}),
        (Settings, {"odds": 0.5}),
        (Settings, {"envelope": 0.0}),
        (Settings, {"recent": 3}),
        (Settings, {"capacity": -1}),
        (Settings, {"hypotheses": (Hypothesis("straight", curved=False),)}),
        (Hypothesis, {"words": "fast", "walk": 0.9}),
        (Hypothesis, {"words": "forgetful", "memory": 3.0}),
    ],
)
def test_settings_that_make_no_sense_are_refused(kind, wrong):
    with pytest.raises(InvalidInput):
        kind(**wrong)
