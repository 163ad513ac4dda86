"""Rows of a log as equations, before and after a part has changed."""

from dataclasses import replace

import numpy as np
import pytest
from tests.calibration.arm.arms import SHEET, errors_of, kernel_of, model, sightings

from handeye.calibration.arm.groups import shown_by
from handeye.calibration.arm.log_system import Jump, LogSystem
from handeye.calibration.arm.robot import ArmRobot
from handeye.calibration.arm.sheet import ArmSheet, ChosenTerms, CurveTerms

ROBOT = ArmRobot(model(), SHEET)
N = 30
SEEN = ROBOT.seen_rows(sightings(model(), errors_of(model()), N))
JUMPS = (Jump(10, (17, 3)), Jump(20, (17,)))


def gathered(system, x, *, slopes=True):
    parts = list(system.rows(x, slopes=slopes))
    assert [part.first for part in parts] == np.cumsum(
        [0, *(len(part.residuals) for part in parts[:-1])]
    ).tolist()
    return np.concatenate([p.residuals for p in parts]), np.concatenate([p.slopes for p in parts])


def test_before_a_jump_a_part_is_where_it_was_and_afterwards_where_it_is():
    plain = LogSystem(ROBOT.kernel, ROBOT.chain.tolerance, SEEN)
    jumped = LogSystem(ROBOT.kernel, ROBOT.chain.tolerance, SEEN, JUMPS)
    n = len(ROBOT.chain.tolerance)
    x = 0.3 * ROBOT.chain.tolerance * np.random.default_rng(0).normal(size=n)
    off = np.array([1e-3, 2e-3, -4e-3])
    found, _ = gathered(jumped, np.concatenate([x, off]))
    # The first jump's unknowns, then the second's: of row 0 both count.
    for rows, change in (
        (slice(0, 10), {17: off[0] + off[2], 3: off[1]}),
        (slice(10, 20), {17: off[2]}),
        (slice(20, N), {}),
    ):
        there = x.copy()
        for place, amount in change.items():
            there[place] += amount
        np.testing.assert_array_equal(found[rows], gathered(plain, there)[0][rows])


@pytest.mark.parametrize("jumps", [(), JUMPS])
def test_slopes_are_those_of_differences(jumps):
    system = LogSystem(ROBOT.kernel, ROBOT.chain.tolerance, SEEN, jumps)
    x = 0.3 * system.tolerance * np.random.default_rng(1).normal(size=len(system.tolerance))
    x[system.n_arm :] /= 100.0
    _, slopes = gathered(system, x)
    for place in [3, 17, system.n_arm - 1, *range(system.n_arm, len(x))]:
        ahead, behind = x.copy(), x.copy()
        ahead[place] += 1e-6
        behind[place] -= 1e-6
        by = (gathered(system, ahead)[0] - gathered(system, behind)[0]) / 2e-6
        np.testing.assert_allclose(slopes[:, :, place], by, atol=1e-7)


def test_residuals_alone_are_the_same():
    system = LogSystem(ROBOT.kernel, ROBOT.chain.tolerance, SEEN, JUMPS)
    x = system.tolerance * 1e-2
    np.testing.assert_allclose(
        gathered(system, x)[0], gathered(system, x, slopes=False)[0], atol=1e-14
    )


def test_a_jump_has_a_prior_of_its_own():
    system = LogSystem(ROBOT.kernel, ROBOT.chain.tolerance, SEEN, JUMPS)
    extra = slice(system.n_arm, None)
    np.testing.assert_allclose(system.tolerance[extra], 30.0 * ROBOT.chain.tolerance[[17, 3, 17]])
    assert (system.groups[extra] == -1).all()
    assert system.shown[extra].all()


@pytest.mark.parametrize(
    ("numbers", "own", "others"),
    [(0, 0, 0), (36 * 9, 9, 0), (36 * 10, 5, 1), (36 * 40, 20, 4), (36 * 100, 64, 6)],
)
def test_no_more_unknowns_of_curves_than_a_third_of_what_was_measured(numbers, own, others):
    kernel = kernel_of(model(), replace(ArmSheet(), curves=CurveTerms(64, 6)))
    shown = shown_by(kernel, numbers)
    terms = kernel.terms[shown[-2 * len(kernel.terms) :: 2]]
    assert 3 * 2 * len(terms) <= max(numbers, 0)
    along = terms[:, 1] == 5
    assert terms[along, 2].max(initial=0) == own
    assert terms[~along, 2].max(initial=0) == others
    assert shown[: -2 * len(kernel.terms)].all()


def test_chosen_terms_are_those_that_were_chosen():
    table = CurveTerms(3, 1).table(np.zeros(2, np.bool_))[::2]
    chosen = ChosenTerms.of(table)
    np.testing.assert_array_equal(chosen.table(np.zeros(2, np.bool_)), table)
    assert ChosenTerms.of(table[:0]).table(np.zeros(2, np.bool_)).shape == (0, 3)
