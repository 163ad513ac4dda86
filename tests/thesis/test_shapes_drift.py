import numpy as np
import pytest

from handeye.thesis.analysis.first_order import amplitude_ratio, phase_lead
from handeye.thesis.claims import load_claims
from handeye.thesis.experiment import Curve, Quantities
from handeye.thesis.records import Record, Records, flatten
from handeye.thesis.shapes import SHAPES, Finding

LIMITS = {claim.id: claim.limits for claim in load_claims()}
PERIODS = np.array([100.0, 1000.0, 5000.0])


def finding(claim: str, *measured: tuple[str, int, Quantities]) -> Finding:
    """The predicate of a claim over made-up quantities: path, replicate, quantities."""
    rows: list[Record] = []
    for path, replicate, quantities in measured:
        experiment, setting = path.split("/")
        rows += flatten(experiment, setting, replicate, quantities)
    return SHAPES[claim](Records(rows), LIMITS[claim])


def fixed_point(setting: str, *changes: dict[str, float]) -> Finding:
    """Replicates that are fine but for changes in one setting."""
    fine = {"misfit": 0.001, "mean_noise": 1.0, "mean_gap": 0.1, "curved_gap": 0.01}
    return finding(
        "noisy-fixed-point",
        *((f"fixed-point/{name}", i, fine | (change if name == setting else {}))
          for name in ("centered", "biased", "threshold") for i, change in enumerate(changes)),
    )  # fmt: skip


@pytest.mark.parametrize(
    ("setting", "change", "held"),
    [
        ("centered", {}, True),
        ("centered", {"misfit": 0.011}, False),
        ("biased", {"misfit": 0.011}, False),
        ("biased", {"mean_gap": 0.21}, False),
        ("biased", {"mean_noise": 0.49}, False),
        ("biased", {"mean_gap": 0.19}, True),
        ("centered", {"mean_gap": 1.0}, True),
        ("threshold", {"misfit": 0.5}, True),
    ],
)
def test_fixed_point_is_held_to_recursion_and_end(
    setting: str, change: dict[str, float], held: bool
):
    found = fixed_point(setting, change, change)
    assert found.held == (held, held)
    assert found.holds is held


def test_the_mean_over_replicates_decides_on_the_fixed_point():
    found = fixed_point("biased", {"mean_gap": 0.25}, {"mean_gap": 0.05})
    assert found.held == (False, True)
    assert found.holds
    assert "15.0 % of the mean noise (at most 25.0 %; 1.00 %" in found.note
    assert not fixed_point("biased", {"mean_gap": 0.9}, {"mean_gap": 0.05}).holds


def bode(*replicates: tuple[float, float, float]) -> Finding:
    """Replicates whose response to waves has a time constant, a gain and a turn [degrees]."""
    measured: list[tuple[str, int, Quantities]] = []
    for i, (tau, gain, turn) in enumerate(replicates):
        ratio, lead = amplitude_ratio(PERIODS, tau), phase_lead(PERIODS, tau)
        curves: Quantities = {
            "share_ratio": Curve(PERIODS, gain * ratio),
            "share_lead": Curve(PERIODS, lead + np.radians(turn)),
            "ratio": Curve(PERIODS, 0.5 * ratio),
        }
        step: Quantities = {"share_time_constant": 120.0, "time_constant": 100.0}
        measured += [("periodic/200", i, curves), ("step/virtual-200", i, step)]
    return finding("bode-first-order", *measured)


@pytest.mark.parametrize(
    ("tau", "gain", "turn", "holds"),
    [
        (120.0, 1.0, 0.0, True),
        (90.0, 1.0, 0.0, True),
        (120.0, 1.4, 0.0, True),
        (120.0, 1.42, 0.0, False),
        (120.0, 0.70, 0.0, False),
        (120.0, 1.0, 19.0, True),
        (120.0, 1.0, 21.0, False),
        (120.0, 1.0, -21.0, False),
        (60.0, 1.0, 0.0, False),
        (240.0, 1.0, 0.0, False),
    ],
)
def test_response_is_held_to_the_first_order_model(
    tau: float, gain: float, turn: float, holds: bool
):
    found = bode((tau, gain, turn))
    assert found.holds is holds
    assert found.held == (holds,)


def test_the_mean_response_decides():
    found = bode((120.0, 1.0, 25.0), (120.0, 1.0, -25.0))
    assert found.held == (False, False)
    assert found.holds
    assert "time constant, 120 trials" in found.note
    assert "period 5000: -0.9 dB, +0 degrees" in found.note
    assert "falls by 17 dB per decade" in found.note


def sizes(virtual: dict[int, float], gradient: dict[int, float], spread: float = 0.0) -> Finding:
    """Time constants by number of neurons, in two replicates around them."""
    return finding(
        "time-constant-neurons",
        *((f"step/{rule}-{n}", i, {"time_constant": tau + sign * spread * n})
          for rule, taus in (("virtual", virtual), ("gradient", gradient))
          for n, tau in taus.items() for i, sign in enumerate((1.0, -1.0))),
    )  # fmt: skip


@pytest.mark.parametrize(
    ("virtual", "gradient", "holds"),
    [
        ((100.0, 200.0, 300.0), (20.0, 24.0), True),
        ((100.0, 200.0, 300.0), (20.0, 16.0), True),
        ((100.0, 200.0, 300.0), (20.0, 26.0), False),
        ((100.0, 200.0, 300.0), (20.0, 14.0), False),
        ((100.0, 300.0, 299.0), (20.0, 20.0), False),
        ((100.0, 100.0, 300.0), (20.0, 20.0), False),
    ],
)
def test_neurons_slow_one_rule_and_not_the_other(
    virtual: tuple[float, ...], gradient: tuple[float, ...], holds: bool
):
    found = sizes(
        dict(zip((1000, 200, 3000), (virtual[1], virtual[0], virtual[2]), strict=True)),
        dict(zip((200, 3000), gradient, strict=True)),
    )
    assert found.holds is holds
    assert found.held == (holds, holds)
    assert f"{virtual[0]:.0f} (200), {virtual[1]:.0f} (1000)" in found.note


def test_the_mean_time_constants_decide():
    found = sizes({200: 100.0, 3000: 200.0}, {200: 20.0, 3000: 20.0}, spread=0.003)
    assert found.held == (False, False)
    assert found.holds
