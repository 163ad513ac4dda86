"""Appendix B: what its claim looks at, and what the experiment measures."""

import numpy as np
import pytest
from tests.thesis.made_up import LIMITS, REPLICATES, curves

from handeye.networks import FixedPoint, HardwareNetwork, ResourceAllocatingNetwork
from handeye.thesis.experiment import Curve, Effort
from handeye.thesis.experiments.hardware import (
    CLEAN,
    HARDWARE,
    NEURONS,
    ONE,
    OnChip,
    grid_of_poses,
    on_chip,
)
from handeye.thesis.plants import NOMINAL, NORMAL
from handeye.thesis.records import Record, Records
from handeye.thesis.shapes import SHAPES, Finding

CHIPS = [setting for setting in HARDWARE.settings if not setting.endswith("float")]


def found_in(divisions: float = 1.0, **change: float) -> Finding:
    """What the claim finds in curves of all settings; in the names of `change` a dash is _."""
    paths: dict[str, object] = {}
    for setting in HARDWARE.settings:
        bits = setting.rpartition("-")[2]
        paths[f"hardware/{setting}/error"] = 0.013 if bits in {"8", "10"} else 0.010
        paths[f"hardware/{setting}/uncorrected"] = 0.045
    paths |= {f"hardware/{name.replace('_', '-')}/error": level for name, level in change.items()}
    counts = {"divide": 1.0, "phases": 9.0, "phases_single": 11.0}
    rows = [
        Record("hardware", setting, replicate, name, None, value)
        for setting in CHIPS
        for replicate in range(REPLICATES)
        for name, value in {**counts, "divide": divisions}.items()
    ]
    records = Records([*curves(paths).rows, *rows])
    return SHAPES["hardware-rules"](records, LIMITS["hardware-rules"])


@pytest.mark.parametrize(
    ("change", "holds"),
    [
        ({}, True),
        ({"cmac_noisy_16": 0.0104}, True),
        ({"cmac_noisy_16": 0.0106}, False),
        ({"virtual_neuron_clean_16": 0.0106}, False),
        ({"virtual_neuron_clean_14": 0.02}, True),
        ({"grid_one_width_clean_16": 0.0106}, False),
        ({"grid_one_width_noisy_16": 0.008}, True),
        ({"grid_nearest_clean_16": 0.008}, False),
        ({"cmac_clean_16": 0.0227, "cmac_clean_float": 0.0227}, False),
    ],
)
def test_the_claim(change: dict[str, float], holds: bool):
    found = found_in(**change)
    assert found.holds is holds
    assert found.held == (holds,) * 4


def test_a_second_division_breaks_the_claim():
    assert not any(found_in(divisions=2.0).held)


def test_the_note_names_the_shortest_words_that_suffice():
    note = found_in(cmac_noisy_12=0.02).note
    assert (
        "virtual neuron 12, virtual neuron rounded at random 12, CMAC 14, CMAC rounded at " in note
    )
    assert "CMAC more than there are" in found_in(cmac_noisy_24=0.02).note
    assert "9 with paired neurons, 11 with single ones" in note


def test_neurons_stand_where_the_nominal_robot_sees_a_regular_grid():
    setting = OnChip(CLEAN, adaptation=ONE, on_grid=True)
    seen = grid_of_poses(setting)
    assert len(seen) == 216
    for column in (*seen.joints.T,):
        assert len(np.unique(np.round(column, 9))) == 6
    network = setting.calibrator(0).network
    assert isinstance(network, ResourceAllocatingNetwork)
    assert network.n_neurons == 216
    inputs = setting.calibrator(0).model.features(seen)
    np.testing.assert_allclose(network.centers, inputs)
    np.testing.assert_allclose(inputs[:, :2], seen.joints, atol=1e-9)
    np.testing.assert_allclose(seen.range, NOMINAL.sight(
        NOMINAL.tips(seen.joints), np.zeros(216), np.zeros((216, 2)))[1])  # fmt: skip


def test_chip_and_network_start_alike_and_meet_the_same_world():
    effort = Effort(0.02)
    chip, floating = (
        on_chip(HARDWARE.settings[f"virtual-neuron-noisy-{bits}"], 100, effort)
        for bits in (24, "float")
    )
    for name in ("error", "uncorrected", "neurons"):
        ours, theirs = chip[name], floating[name]
        assert isinstance(ours, Curve)
        assert isinstance(theirs, Curve)
        np.testing.assert_allclose(ours.value, theirs.value, rtol=1e-3)
    assert chip["divide"] == 1.0
    assert (chip["phases"], chip["phases_single"]) == (9.0, 11.0)
    assert "divide" not in floating


def test_the_settings_differ_in_their_arithmetic_only():
    assert len(HARDWARE.settings) == 2 * (2 * 8 + 2 * 7 + 4)
    for name, setting in HARDWARE.settings.items():
        assert (setting.plant is NORMAL) == ("noisy" in name)
        assert setting.on_grid == name.startswith("grid")
        learner = setting.calibrator(100).network
        if setting.fixed is None:
            assert name.endswith("float")
            continue
        assert isinstance(learner, HardwareNetwork)
        assert isinstance(setting.fixed, FixedPoint)
        assert name.endswith(f"-{setting.fixed.word_length}")
        assert (setting.fixed.rounding == "random") == ("random" in name)
        assert learner.n_neurons == (216 if setting.on_grid else NEURONS)
