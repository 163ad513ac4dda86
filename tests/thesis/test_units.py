import pytest

from handeye.thesis.units import Scale, digits, scale_for, show, show_interval, show_stated


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (2.0, "2.00 m"),
        (0.048, "4.80 cm"),
        (0.01, "1.00 cm"),
        (0.0026, "2.60 mm"),
        (2e-6, "2.00 µm"),
        (4e-15, "4.00e-15 m"),
        (0.0, "0 m"),
    ],
)
def test_lengths_are_shown_in_the_unit_that_is_easiest_to_read(value: float, text: str):
    assert show(value, "m") == text


def test_other_units():
    assert show(3771.4, "neurons") == "3,771 neurons"
    assert show(0.0, "neurons") == "0 neurons"
    assert show(0.01234, "fraction") == "1.23 %"
    assert show(1.5, "") == "1.50"


def test_a_scale_can_be_given():
    assert show(0.012, "m", scale_for(0.009, "m")) == "12.0 mm"
    assert scale_for(-0.5, "m") == Scale("cm", 100.0)


def test_stated_values_keep_their_digits():
    assert show_stated(0.046, "m") == "4.6 cm"
    assert show_stated(0.009, "m") == "9 mm"
    assert show_stated(4770, "neurons") == "4,770 neurons"
    assert show_stated(0.95, "fraction") == "95 %"


def test_means_are_rounded_where_their_interval_begins():
    assert show_interval(0.011724, 0.0000612, "m") == "1.172 ± 0.006 cm"
    assert show_interval(4780.4, 14.4, "neurons") == "4,780 ± 14 neurons"
    assert show_interval(0.0123, 0.0, "m") == "1.23 cm"


@pytest.mark.parametrize(
    ("value", "text"), [(9.9999, "10.0"), (99.96, "100"), (123456.7, "123,457"), (-0.5, "-0.500")]
)
def test_digits_count_after_rounding(value: float, text: str):
    assert digits(value, 3) == text
