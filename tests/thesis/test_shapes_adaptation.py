import pytest
from tests.thesis.made_up import judged

RULES = ("gradient", "virtual-neuron", "cmac")
RATES = (1.0, 0.1, 0.06, 0.02, 0.01)
STATED = {"gradient": 0.02, "virtual-neuron": 0.06, "cmac": 0.02}
FLOOR = {"gradient": 0.0120, "virtual-neuron": 0.0115, "cmac": 0.0125}


def levels(change: dict[str, float]) -> dict[str, object]:
    """Every rule at its floor with the stated rate, worse with others, CMAC worst with 1."""
    made = {
        f"{rule}-{rate}": FLOOR[rule] * (1.0 if rate == STATED[rule] else 1.1)
        for rule in RULES
        for rate in RATES
    }
    made |= {"gradient-1.0": 0.02, "virtual-neuron-1.0": 0.03, "cmac-1.0": 0.04, **change}
    return {
        f"adaptation/{name}{h}/error": level for name, level in made.items() for h in ("", "-h-0.8")
    }


@pytest.mark.parametrize(
    ("change", "holds"),
    [
        ({}, True),
        ({"gradient-0.02": 0.0129}, True),
        ({"cmac-0.1": 0.0110}, False),
        ({"gradient-0.01": 0.0114}, False),
        ({"virtual-neuron-0.06": 0.0109}, False),
        ({"virtual-neuron-0.06": 0.0125}, False),
    ],
)
def test_virtual_neurons_are_best_by_a_millimetre_or_so(change: dict[str, float], holds: bool):
    found = judged("adapt-best", levels(change))
    assert found.holds is holds
    assert found.held == (holds,) * 4


@pytest.mark.parametrize(
    ("change", "holds"),
    [
        ({}, True),
        ({"gradient-0.01": 0.0119}, False),
        ({"virtual-neuron-0.1": 0.0114}, False),
        ({"cmac-0.06": 0.0124}, False),
        ({"cmac-1.0": 0.029}, False),
    ],
)
def test_stated_rates_are_best_and_cmac_suffers_most(change: dict[str, float], holds: bool):
    found = judged("adapt-rates", levels(change))
    assert found.holds is holds
    assert found.held == (holds,) * 4


def test_notes_name_the_best_rates_and_the_other_reading():
    note = judged("adapt-rates", levels({})).note
    assert "virtual neuron 1.15 cm (rate 0.06), CMAC 1.25 cm (rate 0.02)" in note
    assert "With h = 0.8 all of it holds" in note
    only_one = levels({}) | {"adaptation/cmac-0.06-h-0.8/error": 0.001}
    assert "With h = 0.8 it does not hold either" in judged("adapt-rates", only_one).note
