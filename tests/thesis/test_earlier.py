import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from handeye.calibration.calibrators import NetworkCorrection
from handeye.calibration.earlier import KupersteinMap, MurphyTable
from handeye.calibration.models import PlanarMap
from handeye.calibration.session import WorldStreams, learn_in_world
from handeye.calibration.world import PlanarWorld
from handeye.errors import InvalidInput
from handeye.thesis.combining import model_for
from handeye.thesis.earlier import CAPTION, LEVELS, WORDS, earlier_markdown, earlier_table
from handeye.thesis.experiment import FULL, Curve, Effort
from handeye.thesis.experiments.earlier import EARLIER, TRIALS
from handeye.thesis.plants import NOMINAL, NORMAL
from handeye.thesis.reaching import LEARNERS, Reaching, reaching_curve, trials_to
from handeye.thesis.records import Record, Records

AT = (0.0, 10.0, 100.0, 1000.0)


def made_up(*replicates: tuple[float, ...]) -> Records:
    """The same error curves at AT under every setting."""
    return Records(
        Record("earlier", setting, i, "error", at, value)
        for setting in EARLIER.settings
        for i, values in enumerate(replicates)
        for at, value in zip(AT, values, strict=True)
    )


@given(st.lists(st.lists(st.floats(0.0, 1.0), min_size=4, max_size=4), min_size=1, max_size=4))
def test_trials_to_a_level_are_the_first_from_which_it_is_never_left(rows: list[list[float]]):
    found = trials_to(np.array(AT), np.array(rows), 0.5)
    for row, trials in zip(rows, found, strict=True):
        good = [at for k, at in enumerate(AT) if max(row[k:]) <= 0.5]
        assert trials == (good[0] if good else np.inf)


def test_a_level_passed_by_luck_does_not_count():
    values = np.array([[0.04, 0.06, 0.05, 0.01]])
    np.testing.assert_array_equal(trials_to(np.array(AT), values, 0.05), [100.0])


def test_every_learner_meets_every_plant_and_is_named():
    assert set(WORDS) == set(TRIALS) == set(LEARNERS)
    assert set(EARLIER.settings) == {f"{n}-{p}" for n in LEARNERS for p in ("noisy", "clean")}
    for name, setting in EARLIER.settings.items():
        assert name.startswith(setting.learner)
        assert (setting.plant.head.pixel_pitch == 0.0) == name.endswith("clean")


def test_those_that_know_no_kinematics_are_given_none():
    for name, make in LEARNERS.items():
        learner = make(NORMAL)
        knows_no = isinstance(learner, KupersteinMap | MurphyTable)
        assert knows_no == (name in {"kuperstein", "murphy"})
        model = getattr(learner, "model", None)
        assert isinstance(model, PlanarMap) == knows_no
        if not knows_no:
            assert model == model_for(NORMAL)


def test_marks_are_even_on_a_logarithmic_axis_and_end_with_all_trials():
    assert Reaching(NORMAL, "albus", 60).marks == (0, 1, 2, 3, 5, 7, 10, 20, 30, 50, 60)
    assert Reaching(NORMAL, "albus", 100).marks[-2:] == (70, 100)


def test_the_curve_is_that_of_alternating_learning_and_testing():
    """Between equal marks it is the performance test of the thesis, on the same poses."""
    measured = reaching_curve(Reaching(NORMAL, "network", 2, tests=20), 3, FULL)
    error = measured["error"]
    assert isinstance(error, Curve)
    learner = NetworkCorrection(model_for(NORMAL))
    alike = learn_in_world(
        PlanarWorld(NORMAL), learner, learner, WorldStreams.of(3), trials=2, every=1, tests=20
    )
    np.testing.assert_array_equal(error.at, [0.0, 1.0, 2.0])
    np.testing.assert_allclose(error.value, alike.mean, rtol=1e-12)


def test_what_is_quoted_of_the_originals_is_measured():
    few = Effort(0.02)
    map_, table = (EARLIER.measure(EARLIER.settings[f"{n}-noisy"], 0, few)
                   for n in ("kuperstein", "murphy"))  # fmt: skip
    assert set(map_) == {"error", "activation"}
    assert set(table) == {"error", "connections"}
    learner, streams = KupersteinMap(PlanarMap(NOMINAL)), WorldStreams.of(0)
    world = PlanarWorld(NORMAL)
    learner.observe_many(world.observe(np.arange(200), streams.train_poses, streams.train_noise))
    fresh = world.observe(np.arange(2000), streams.test_poses, streams.test_noise)
    off = np.abs(learner.activations(fresh.target) - learner.muscles(fresh.joints))
    assert map_["activation"] == pytest.approx(off.mean(), rel=0.6)
    formed = table["connections"]
    assert isinstance(formed, float)
    assert 1000.0 < formed < 200 * 25 * 25


def test_cells_are_medians_ranges_and_shares():
    records = made_up(
        (0.03, 0.015, 0.009, 0.009), (0.03, 0.03, 0.015, 0.02), (0.03, 0.03, 0.015, 0.011)
    )
    heads, rows = earlier_table(records)
    assert len(rows) == len(EARLIER.settings)
    assert {len(row) for row in rows} == {len(heads)}
    assert rows[0][:2] == ("Kuperstein-type map", "with")
    assert rows[-1][:2] == ("Combined", "without")
    assert rows[0][2:5] == ("0", "100 (10–100)", "100, in 1 of 3")
    assert rows[0][5] == "1 ± 1 cm"
    assert rows[0][6] == "1,000"


def test_what_no_replicate_reaches_is_a_dash_and_one_replicate_has_no_interval():
    _, rows = earlier_table(made_up((0.3, 0.2, 0.1, 0.06)))
    assert rows[0][2:] == ("–", "–", "–", "6.00 cm", "1,000")


def test_markdown_has_as_many_cells_in_every_line():
    text = earlier_markdown(made_up((0.03, 0.015, 0.009, 0.009)))
    lines = [line for line in text.splitlines() if line.startswith("|")]
    assert len(lines) == 2 + len(EARLIER.settings)
    assert {line.count("|") for line in lines} == {len(LEVELS) + 5}
    assert CAPTION in text


def test_records_of_something_else_are_refused():
    with pytest.raises(InvalidInput, match="no records of earlier/"):
        earlier_table(Records([Record("other", "a", 0, "error", 0.0, 1.0)]))
