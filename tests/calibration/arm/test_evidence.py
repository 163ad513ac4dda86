"""Widths of priors and noise are those of greatest evidence; wild rows count little."""

from dataclasses import dataclass

import numpy as np
import pytest
from scipy.optimize import minimize

from handeye.calibration.arm import evidence, student
from handeye.calibration.arm.evidence import solve
from handeye.calibration.arm.system import Rows


@dataclass
class Linear:
    """values = slopes x + noise, k values a row; the slopes of residuals are -slopes."""

    by: np.ndarray
    values: np.ndarray
    tolerance: np.ndarray
    groups: np.ndarray
    channels: np.ndarray
    std: np.ndarray

    @property
    def shown(self):
        return np.ones(len(self.tolerance), bool)

    @property
    def n_rows(self):
        return len(self.values)

    @property
    def n_channels(self):
        return self.channels.max() + 1

    def rows(self, x, *, slopes=True):
        for first in range(0, len(self.values), 7):
            some = slice(first, first + 7)
            r = self.values[some] - self.by[some] @ x
            by = -self.by[some] if slopes else np.empty((*r.shape, 0))
            yield Rows(r, by, self.std[some], self.channels, first)


def made(seed=0, n=60, k=2, unknowns=6, noise=0.1, widths=(2.0, 0.3), channels=(0, 0)):
    rng = np.random.default_rng(seed)
    groups = np.repeat(np.arange(len(widths)), unknowns // len(widths))
    tolerance = rng.uniform(0.5, 2.0, unknowns)
    x = rng.normal(size=unknowns) * tolerance * np.array(widths)[groups]
    by = rng.normal(size=(n, k, unknowns))
    values = by @ x + noise * rng.normal(size=(n, k))
    std = np.zeros((n, k))
    return Linear(by, values, tolerance, groups, np.array(channels), std), x


@pytest.fixture
def normal_noise(monkeypatch):
    """No tails: then the evidence has a closed form."""
    monkeypatch.setattr(student, "FREEDOM", 1e9)
    monkeypatch.setattr(evidence, "_SETTLED", 1e-9)
    monkeypatch.setattr(evidence, "_SAME_NOISE", 1e-9)
    monkeypatch.setattr(evidence, "_ROUNDS", 150)


@pytest.mark.usefixtures("normal_noise")
@pytest.mark.parametrize("seed", range(2))
def test_widths_and_noise_maximise_the_marginal_likelihood(seed):
    system, _ = made(seed, n=40, k=1, channels=(0,))
    found = solve(system)
    J, y = system.by.reshape(-1, 6), system.values.reshape(-1)

    def lost(logs):
        prior = (system.tolerance * np.exp(logs[:2])[system.groups]) ** 2
        spread = J @ np.diag(prior) @ J.T + np.exp(2.0 * logs[2]) * np.eye(len(y))
        L = np.linalg.cholesky(spread)
        return 0.5 * np.sum(np.linalg.solve(L, y) ** 2) + np.sum(np.log(np.diag(L)))

    best = minimize(lost, np.log([1.0, 1.0, 0.1]), method="Nelder-Mead", tol=1e-7)
    ours = np.log([*(found.widths / system.tolerance)[[0, 3]], found.noise[0]])
    np.testing.assert_allclose(ours, best.x, atol=2e-3)


@pytest.mark.usefixtures("normal_noise")
def test_the_estimate_is_the_mean_and_the_root_the_precision_given_widths_and_noise():
    system, _ = made(1)
    found = solve(system)
    J = system.by.reshape(-1, 6) / found.noise[0]
    precision = J.T @ J + np.diag(found.widths**-2.0)
    mean = np.linalg.solve(precision, J.T @ system.values.reshape(-1) / found.noise[0])
    np.testing.assert_allclose(found.x, mean, rtol=1e-6)
    wider = np.maximum(found.widths, system.tolerance)
    precision += np.diag(wider**-2.0 - found.widths**-2.0)
    scaled = precision * np.outer(system.tolerance, system.tolerance)
    np.testing.assert_allclose(found.root @ found.root.T, scaled, rtol=1e-4)


@pytest.mark.usefixtures("normal_noise")
def test_leverage_is_the_diagonal_of_the_hat_matrix():
    system, _ = made(2)
    found = solve(system)
    J = system.by.reshape(-1, 6) / found.noise[0]
    hat = J @ np.linalg.solve(J.T @ J + np.diag(found.widths**-2.0), J.T)
    expected = np.diag(hat).reshape(-1, 2).sum(axis=1)
    np.testing.assert_allclose(found.leverage[:, 0], expected, rtol=1e-4)


def test_what_the_data_do_not_show_is_switched_off():
    system, _ = made(3, n=150, widths=(1.0, 0.0))
    found = solve(system)
    assert np.all(np.abs(found.x[3:]) < 0.03)
    assert np.all(found.widths[3:] < 0.05 * system.tolerance[3:])


def test_a_group_of_number_minus_one_keeps_its_prior():
    system, _ = made(4, widths=(3.0, 0.1))
    system.groups = np.array([-1, -1, -1, 0, 0, 0])
    np.testing.assert_array_equal(solve(system).widths[:3], system.tolerance[:3])


def test_a_tenth_of_wild_rows_moves_the_estimate_less_than_the_noise_of_one():
    system, x = made(5, n=150)
    clean = solve(system)
    wild = np.random.default_rng(0).choice(150, 15, replace=False)
    system.values[wild] += 50.0
    found = solve(system)
    assert np.max(np.abs(found.x - clean.x)) < 0.1
    assert np.max(np.abs(found.x - x)) < 0.1
    assert set(np.argsort(-found.squares[:, 0])[:15]) == set(wild)


def test_each_channel_has_its_own_noise():
    system, _ = made(6, n=300, channels=(0, 1))
    rng = np.random.default_rng(1)
    system.values[:, 1] += 2.0 * rng.normal(size=300)
    found = solve(system)
    # Of a t that is as wide as a normal distribution in its middle.
    assert 0.07 < found.noise[0] < 0.11
    assert 1.5 < found.noise[1] < 2.2


@pytest.mark.usefixtures("normal_noise")
def test_stated_noise_is_not_found_again():
    system, _ = made(7, n=400)
    system.std[:] = 0.1
    assert solve(system).noise[0] < 0.04
    system.std[:] = 0.06
    assert abs(solve(system).noise[0] - 0.08) < 0.01


def test_standard_deviations_are_honest():
    errors = []
    for seed in range(40):
        system, x = made(100 + seed)
        found = solve(system)
        errors.append(found.root.T @ ((found.x - x) / system.tolerance))
    assert 0.8 < np.mean(np.square(np.concatenate(errors))) < 1.25


def test_progress_is_told_round_by_round():
    told = []
    solve(made(8)[0], lambda done, of: told.append((done, of)))
    assert [done for done, _ in told] == list(range(1, len(told) + 1))
    assert told[-1][0] <= told[-1][1]
