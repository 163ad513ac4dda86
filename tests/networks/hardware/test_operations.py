from fractions import Fraction
from math import floor

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from handeye.networks.hardware.operations import (
    KINDS,
    kept_within,
    next_noise,
    normalised,
    plus,
    rounded,
    scattered,
    times,
)

TALLY = np.zeros(len(KINDS), np.int64)


@given(st.integers(-(2**57), 2**57), st.integers(0, 80))
def test_rounding_is_to_the_nearest_halves_up(value, shift):
    exact = floor(Fraction(value, 2**shift) + Fraction(1, 2))
    assert rounded(value, shift, TALLY) == (exact if shift <= 62 else 0)


@given(st.integers(-(2**30), 2**30), st.integers(0, 30))
def test_a_negative_shift_multiplies(value, shift):
    assert rounded(value, -shift, TALLY) == value * 2**shift


@given(st.integers(1, 2**60), st.integers(8, 25))
def test_a_mantissa_keeps_the_leading_bits(value, bits):
    mantissa, length = normalised(value, bits, TALLY)
    assert length == value.bit_length()
    assert 2 ** (bits - 1) <= mantissa < 2**bits
    # Half a step of the mantissa, or a whole one where all bits are set and rounding would carry.
    assert abs(Fraction(mantissa) * Fraction(2) ** (length - bits) / value - 1) <= 2.0 ** (1 - bits)


@given(st.integers(-(2**40), 2**40), st.integers(1, 2**24))
def test_saturation(value, limit):
    assert kept_within(value, limit, TALLY) == min(max(value, -limit), limit)


def test_the_noise_is_xorshift32():
    register = np.array([1])
    # The sequence of Marsaglia's shifts 13, 17, 5 from 1, computed apart with 32-bit numbers.
    state = np.array([1], np.uint32)
    for _ in range(1000):
        for shift in (13, -17, 5):
            state ^= state << np.uint32(shift) if shift > 0 else state >> np.uint32(-shift)
        assert next_noise(register) == state[0]
    assert next_noise(np.array([1])) == 270369


@pytest.mark.parametrize("shift", [3, 31, 32, 40])
@pytest.mark.parametrize("part", [0.1, 0.5, -0.8, 5.3])
def test_random_rounding_keeps_the_mean(shift, part):
    register, value = np.array([7]), round(part * 2**shift)
    drawn = np.array([scattered(value, shift, register, TALLY) for _ in range(4000)])
    assert set(drawn) <= {floor(value / 2**shift), floor(value / 2**shift) + 1}
    assert drawn.mean() == pytest.approx(value / 2**shift, abs=0.035)


def test_every_operation_is_counted_once_and_by_its_kind():
    tally = np.zeros(len(KINDS), np.int64)
    assert times(3, 4, tally) == 12
    assert plus(3, 4, tally) == 7
    assert rounded(8, 2, tally) == 2
    kept_within(3, 2, tally)
    normalised(100, 8, tally)
    assert dict(zip(KINDS, tally, strict=True)) == {
        "multiply": 1, "add": 1, "compare": 1, "shift": 2, "look up": 0, "divide": 0,
    }  # fmt: skip
