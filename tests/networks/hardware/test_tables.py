from itertools import pairwise

import numpy as np
import pytest
from tests.networks.hardware.made import trained

from handeye.networks.adaptation import CMAC
from handeye.networks.hardware import FixedPoint, HardwareNetwork
from handeye.networks.hardware.arithmetic import activity
from handeye.networks.hardware.bounds import RESPONSE_STEPS
from handeye.networks.hardware.curves import (
    CURVES,
    curve,
    reciprocal_error,
    reciprocal_table,
    response_table,
    squared_half_distances,
)
from handeye.networks.hardware.fixed import between
from handeye.networks.hardware.operations import KINDS as OPERATIONS
from handeye.networks.responses import respond, width

TALLY = np.zeros(len(OPERATIONS), np.int64)
KINDS = [pytest.param(kind(), id=kind.__name__) for kind in CURVES]


@pytest.mark.parametrize("kind", KINDS)
def test_a_curve_is_the_response_whatever_the_width(kind):
    z = np.linspace(0.0, 3.0, 301)
    for half in (0.05, 0.3, 1.0, 4.0):
        widths, out = np.full(z.size, width(kind, half)), np.empty(z.size)
        respond(kind, z, widths, out)
        np.testing.assert_allclose(squared_half_distances(kind, widths), half**2, rtol=1e-14)
        np.testing.assert_allclose(
            [curve(kind, u) for u in z / half**2], out, rtol=1e-12, atol=1e-13
        )


@pytest.mark.parametrize("kind", KINDS)
def test_a_curve_falls_from_one_through_one_half_no_faster_than_its_width(kind):
    distance = np.linspace(0.0, 3.0, 3001)
    values = np.array([curve(kind, d * d) for d in distance])
    assert values[0] == 1.0
    assert curve(kind, 1.0) == pytest.approx(0.5, rel=1e-15)
    assert np.all(np.diff(values) <= 0.0)
    assert np.max(-np.diff(values) / np.diff(distance)) <= 1.0


@pytest.mark.parametrize("word_length", [8, 12, 16])
def test_the_reciprocal_is_within_its_bound_for_every_number(word_length):
    fixed = FixedPoint(word_length)
    table = reciprocal_table(fixed.index_bits, word_length)
    assert len(table) == 2**fixed.index_bits + 1
    mantissas = np.arange(2**word_length)
    read = [between(table, m, word_length, fixed.index_bits, TALLY) for m in mantissas]
    exact = 1.0 / (1.0 + mantissas / 2**word_length)
    worst = np.max(np.abs(np.array(read) / 2**word_length - exact))
    bound = reciprocal_error(fixed.index_bits, word_length)
    assert 0.4 * bound < worst <= bound


def test_more_bits_make_tables_longer_and_errors_smaller():
    lengths, errors = zip(
        *(
            (len(reciprocal_table(bits, W)), reciprocal_error(bits, W))
            for W in (8, 12, 16, 20, 24)
            for bits in [FixedPoint(W).index_bits]
        ),
        strict=True,
    )
    assert lengths == (5, 17, 65, 257, 1025)
    assert all(a > 8.0 * b for a, b in pairwise(errors))


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("word_length", [8, 16, 24])
def test_a_response_is_within_three_steps_of_the_curve(kind, word_length):
    chip = HardwareNetwork.of(trained(8, response=kind, adaptation=CMAC()), FixedPoint(word_length))
    rng = np.random.default_rng(0)
    W, worst = word_length, 0.0
    for gain, shift in zip(chip.cells.gains, chip.cells.shifts, strict=True):
        per_step = gain / 2.0**shift
        # Evenly over u from 0 to 6, and far away.
        for z in [*(rng.uniform(0.0, 6.0, 200) / per_step).astype(int), 0, 2 ** (2 * W + 2)]:
            found = activity(chip.numbers, chip.tables.responses, int(z), gain, shift, TALLY)
            exact = curve(kind, z * per_step) * 2.0 ** (W - 1)
            worst = max(worst, abs(found - exact))
            assert 0 <= found <= 2 ** (W - 1)
    assert 0.4 < worst <= RESPONSE_STEPS


def test_tables_hold_the_curve_and_round_to_the_nearest():
    for curve_kind, folds in CURVES.items():
        table = response_table(curve_kind(), 4, 12)
        at = np.arange(len(table)) / 16
        assert at[-1] == (1.0 if folds else 4.0)
        np.testing.assert_allclose(
            table / 2.0**11, [curve(curve_kind(), u) for u in at], atol=0.5 * 2.0**-11 + 1e-12
        )
