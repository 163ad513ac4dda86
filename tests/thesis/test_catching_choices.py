"""What is varied of the thesis's learner, and only that."""

from dataclasses import fields

import numpy as np
import pytest

from handeye.catching.settings import IMPROVED, THESIS
from handeye.thesis.experiment import Effort
from handeye.thesis.experiments.catch_choices import (
    CATCH_CHOICES,
    CATCH_DELAY,
    CHOICES,
    DELAYED,
    DELAYS,
    practised,
)


def changed(settings, other):
    return {f.name for f in fields(other) if getattr(settings, f.name) != getattr(other, f.name)}


@pytest.mark.parametrize(
    ("choice", "names"),
    [
        ("threshold", {"motor_command"}), ("velocity", {"motor_command"}),
        ("time", {"motor_command"}), ("amplitude", {"least_amplitude"}),
        ("limits", {"ball_comparator", "arm_comparator"}),
    ],
)  # fmt: skip
def test_each_choice_changes_its_own_setting_and_passes_the_thesiss(choice, names):
    make, values = CHOICES[choice]
    kept = [value for value in values if make(value) == THESIS]
    assert len(kept) == 1
    assert all(changed(make(value), THESIS) == names for value in values if value not in kept)
    assert all(f"{choice}-{value:g}" in CATCH_CHOICES.settings for value in values)


def test_what_is_changed_is_what_is_named():
    assert CHOICES["threshold"][0](0.4).motor_command.threshold == 0.4
    v, x, t = THESIS.motor_command.input_scales
    assert CHOICES["velocity"][0](20.0).motor_command.input_scales == (20.0, x, t)
    assert CHOICES["time"][0](20.0).motor_command.input_scales == (v, x, 20.0)
    wide = CHOICES["limits"][0](4.0)
    np.testing.assert_allclose(
        wide.arm_comparator.thresholds, 4.0 * np.array(THESIS.arm_comparator.thresholds)
    )


def test_both_learners_meet_every_delay():
    assert DELAYED == {"thesis": THESIS, "improved": IMPROVED}
    for name, settings in DELAYED.items():
        for ticks in DELAYS:
            setting = CATCH_DELAY.settings[f"{name}-{ticks}"].settings
            assert setting.perceptual_delay == ticks
            assert changed(setting, settings) <= {"perceptual_delay"}


def test_a_late_learner_practises_and_is_tested():
    measured = practised(CATCH_DELAY.settings["improved-2"], 300, Effort(0.05))
    assert 0.0 <= float(str(measured["caught"])) <= 1.0
    assert 0.0 < float(str(measured["rms"])) < 2.0
