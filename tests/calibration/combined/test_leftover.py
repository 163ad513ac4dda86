"""What the model leaves is learned by a network, which is used once it has proved itself."""

import numpy as np
import pytest
from tests.calibration.arm import arms
from tests.calibration.combined import robots
from tests.calibration.combined.robots import MODEL, mean_error, stream, taught

from handeye.calibration.combined import Combined
from handeye.calibration.combined.leftover import Leftover
from handeye.calibration.storage import load_model, save_model
from handeye.networks.inputs import InputSpace
from handeye.thesis.misfits import Misfit
from handeye.thesis.plants import NORMAL

BENT = Misfit.of(NORMAL, sag=0.02)


def test_a_network_must_prove_itself_and_loses_its_place_when_it_hurts():
    rng = np.random.default_rng(2)
    leftover = Leftover(InputSpace.box([0.0], [1.0]), 1, 50, 3.0)
    x = 6.0 * rng.random((200, 1))
    for one in x:
        assert not leftover.used(one[np.newaxis]).any()
        leftover.learn(one, np.sin(one))
        if leftover.proved:
            break
    assert leftover.proved
    assert leftover.comparison.n == 100
    np.testing.assert_allclose(leftover.used(x[:5]), np.sin(x[:5]), atol=0.1)
    # Away from all it has seen it says nothing.
    assert np.abs(leftover.used(np.array([[20.0]]))).max() < 1e-9
    for one in x:  # what it knows is no longer true
        leftover.learn(one, -np.sin(one))
        if not leftover.proved:
            break
    assert not leftover.proved
    assert not leftover.used(x[:5]).any()


def test_without_noise_worth_learning_a_network_is_never_used():
    assert not taught(400).leftover.proved
    none = Leftover(InputSpace.box([0.0], [1.0]), 1, 0, 3.0)
    assert not none.learn(np.zeros(1), np.ones(1))
    assert not none.used(np.zeros((2, 1))).any()


@pytest.mark.parametrize("kind", ["planar", "arm"])
def test_an_explained_observation_is_missed_by_so_much_less(kind):
    combined, seen = {
        "planar": lambda: (robots.taught(), stream(20, 5)),
        "arm": lambda: (
            arms.taught(),
            arms.sightings(arms.model(), arms.errors_of(arms.model()), 20, seed=5),
        ),
    }[kind]()
    robot, x, envelope = combined.robot, combined.engine.x, combined.settings.envelope
    shift = np.linspace(-1e-3, 2e-3, robot.n_outputs)
    for row in robot.seen_rows(seen):
        missed = robot.judge(x, row, envelope).misses[1]
        left = robot.judge(x, robot.explained(row, shift), envelope).misses[1]
        np.testing.assert_allclose(left, missed - shift, atol=1e-9)


def test_commands_count_with_what_the_network_says():
    """Told that the hand falls everywhere, they put it as much higher."""
    combined = robots.taught()
    fall = np.array([0.0, -0.002])
    acting = combined._corrected()._replace(correct=lambda inputs: np.tile(fall, (len(inputs), 1)))
    rows = combined.robot.seen_rows(stream(50, 5))
    before = combined.robot.errors(combined._corrected(), rows)
    after = combined.robot.errors(acting, rows)
    np.testing.assert_allclose(np.median(after - before, axis=0), -fall, atol=2e-4)


def test_a_bent_link_is_left_to_the_network_which_goes_on_after_a_restart(tmp_path):
    combined = Combined(MODEL)
    combined.observe_many(stream(1000, 100, BENT))
    assert combined.leftover.proved
    assert mean_error(combined, BENT) < 0.0105  # 13 mm without the network
    save_model(tmp_path / "model", combined, 1000)
    again = load_model(tmp_path / "model").calibrator
    more = stream(20, 7, BENT)
    for one in (combined, again):
        one.observe_many(more)
    np.testing.assert_array_equal(combined.command(more.target), again.command(more.target))
