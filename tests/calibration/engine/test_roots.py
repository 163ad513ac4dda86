"""Square-root information arithmetic against dense matrices."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from handeye.calibration.engine.roots import (
    absorb,
    absorb_threes,
    fade,
    loosen,
    minimum,
    spread_of,
    surprise,
    wander,
)

N = 7


def known(rng, n=N, lines=12):
    """A root with what `lines` random lines and the priors tell."""
    root = np.hstack([np.eye(n), np.zeros((n, 1))])
    absorb(root, rng.normal(size=(lines, n + 1)))
    return root


def belief(root):
    """Information, covariance and estimate."""
    R, z = root[:, :-1], root[:, -1]
    return R.T @ R, np.linalg.inv(R.T @ R), np.linalg.solve(R, z)


SEEDS = st.integers(0, 2**32 - 1)


@given(seed=SEEDS, k=st.integers(1, 4))
def test_folding_in_is_adding_normal_equations(seed, k):
    rng = np.random.default_rng(seed)
    root, lines = known(rng), rng.normal(size=(k, N + 1))
    information, P, d = belief(root)
    H, rhs = lines[:, :N], lines[:, N]
    left, growth = absorb(root, lines.copy())
    new, _, d_new = belief(root)
    np.testing.assert_allclose(new, information + H.T @ H, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(new @ d_new, information @ d + H.T @ rhs, rtol=1e-8, atol=1e-8)
    S, r = np.eye(k) + H @ P @ H.T, rhs - H @ d
    np.testing.assert_allclose(left, r @ np.linalg.solve(S, r), rtol=1e-7, atol=1e-9)
    np.testing.assert_allclose(growth, 0.5 * np.linalg.slogdet(S)[1], rtol=1e-8, atol=1e-9)
    assert (np.tril(root[:, :N], -1) == 0.0).all()
    assert (np.diag(root) > 0.0).all()


@given(seed=SEEDS, threes=st.integers(1, 3))
def test_threes_of_lines_are_folded_in_as_one_by_one(seed, threes):
    rng = np.random.default_rng(seed)
    root, lines = known(rng), rng.normal(size=(3 * threes, N + 1))
    lines[:, 2] = 0.0
    other = root.copy()
    said = absorb(root, lines.copy())
    np.testing.assert_allclose(absorb_threes(other, lines), said, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(other, root, rtol=1e-9, atol=1e-9)
    np.testing.assert_allclose(lines[:, :N], 0.0, atol=1e-12)


@given(seed=SEEDS, k=st.integers(1, 7))
def test_surprise_is_what_folding_in_would_report(seed, k):
    rng = np.random.default_rng(seed)
    root, lines = known(rng), rng.normal(size=(k, N + 1))
    d, spread = np.empty(N), np.empty((k, N))
    minimum(root, d)
    spread_of(root, lines, spread)
    before = surprise(lines[:, N] - lines[:, :N] @ d, spread)
    np.testing.assert_allclose(before, absorb(root, lines), rtol=1e-7, atol=1e-9)


@given(seed=SEEDS, m=st.integers(1, N), step=st.floats(1e-3, 0.5))
def test_wandering_adds_noise_and_pulls_to_the_priors(seed, m, step):
    root = known(np.random.default_rng(seed))
    _, P, d = belief(root)
    wander(root, m, step)
    F = np.diag(np.where(np.arange(N) < m, np.sqrt(1.0 - step**2), 1.0))
    Q = np.diag(np.where(np.arange(N) < m, step**2, 0.0))
    _, P_new, d_new = belief(root)
    np.testing.assert_allclose(P_new, F @ P @ F + Q, rtol=1e-6, atol=1e-8)
    np.testing.assert_allclose(d_new, F @ d, rtol=1e-6, atol=1e-8)
    assert (np.tril(root[:, :N], -1) == 0.0).all()


def test_what_no_line_tells_wanders_nowhere():
    root = np.hstack([np.eye(N), np.zeros((N, 1))])
    for _ in range(50):
        wander(root, 3, 0.3)
    np.testing.assert_allclose(np.abs(root[:, :N]), np.eye(N), atol=1e-12)


@given(seed=SEEDS, std=st.floats(1e-2, 10.0))
def test_loosening_adds_variance_to_the_named_places_only(seed, std):
    root = known(np.random.default_rng(seed))
    _, P, d = belief(root)
    loosen(root, np.array([4, 1, -1]), std)
    _, P_new, d_new = belief(root)
    Q = np.diag(np.isin(np.arange(N), [1, 4]) * std**2)
    np.testing.assert_allclose(P_new, P + Q, rtol=1e-6, atol=1e-8)
    np.testing.assert_allclose(d_new, d, rtol=1e-6, atol=1e-8)


@given(seed=SEEDS, keep=st.floats(0.1, 1.0))
def test_fading_never_falls_below_the_priors(seed, keep):
    root = known(np.random.default_rng(seed))
    information, _, d = belief(root)
    fade(root, keep)
    new, _, d_new = belief(root)
    np.testing.assert_allclose(new, keep * information + (1.0 - keep) * np.eye(N), atol=1e-8)
    np.testing.assert_allclose(new @ d_new, keep * information @ d, rtol=1e-6, atol=1e-8)
    assert np.linalg.eigvalsh(new).min() > 1.0 - 1e-9


@pytest.mark.parametrize("lines", [1, 100])
def test_minimum_solves_the_triangle(lines):
    root, d = known(np.random.default_rng(1), lines=lines), np.empty(N)
    minimum(root, d)
    np.testing.assert_allclose(root[:, :N] @ d, root[:, N], atol=1e-12)
