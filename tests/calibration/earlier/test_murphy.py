"""The MURPHY-type table against the slow and obvious way to keep such a table."""

from itertools import product

import numpy as np
import pytest
from tests.calibration.earlier.worlds import MAP, sightings

from handeye.calibration.earlier import MurphyTable
from handeye.errors import InvalidInput

SMALL = {"joint_units": 9, "image_step": 0.5, "width": 0.8, "on": 0.2, "share": 0.3}


class TableByHand:
    """Connections as a set of (conjunction, image unit)."""

    def __init__(self, table, width, on, share):
        codes = table.codes
        self.angles = codes.joint_first + codes.joint_step * np.arange(codes.joints)
        self.places = codes.image_first + codes.image_step * np.arange(codes.images)
        self.steps = codes.joint_step, codes.image_step
        self.width, self.on, self.share, self.connected = width, on, share, set()

    def active(self, centres, step, values):
        one, two = (
            np.exp(-(((value - centres) / step) ** 2) / (2.0 * self.width**2)) for value in values
        )
        units = product(range(len(centres)), repeat=2)
        return {(i, j): one[i] * two[j] for i, j in units if one[i] * two[j] > self.on}

    def see(self, joints, image):
        self.connected |= set(
            product(
                self.active(self.angles, self.steps[0], joints),
                self.active(self.places, self.steps[1], image),
            )
        )

    def envision(self, joints):
        active, sums = self.active(self.angles, self.steps[0], joints), {}
        for conjunction, unit in self.connected:
            if conjunction in active:
                sums[unit] = sums.get(unit, 0.0) + active[conjunction]
        if not sums:
            return np.full(2, np.nan)
        over = {u: s - self.share * max(sums.values()) for u, s in sums.items()}
        loud = {u: s for u, s in over.items() if s > 0.0}
        places = np.array([self.places[list(u)] for u in loud])
        return np.average(places, axis=0, weights=list(loud.values()))


def images(seen):
    direction = seen.pointing + seen.eccentricity
    return seen.range[:, None] * np.stack([np.cos(direction), np.sin(direction)], axis=-1)


def test_the_table_is_a_set_of_connections_read_out_by_their_sums():
    table, seen = MurphyTable(MAP, **SMALL), sightings(40)
    by_hand = TableByHand(table, 0.8, 0.2, 0.3)
    for one, image in zip(seen, images(seen), strict=True):
        known = len(by_hand.connected)
        by_hand.see(one.joints, image)
        assert table.observe(one).allocated == (len(by_hand.connected) > known)
        assert table.n_connections == len(by_hand.connected)
    asked = np.vstack([sightings(60, replicate=101).joints, [[2.5, 2.5], [-9.0, 0.5]]])
    np.testing.assert_allclose(
        table.envision(asked), [by_hand.envision(q) for q in asked], atol=1e-12
    )
    assert np.isnan(table.envision(asked)).any()


def test_one_sighting_is_learned_at_once_and_again_changes_nothing():
    table, (seen,) = MurphyTable(MAP), sightings(1)
    assert table.observe(seen).allocated
    near = table.envision(seen.joints[np.newaxis])[0]
    assert np.linalg.norm(near - images(seen[np.newaxis])[0]) < 0.05
    many = table.n_connections
    assert not table.observe(seen).allocated
    assert table.n_connections == many > 0


def test_what_is_commanded_looks_nearest_in_imagination_among_small_moves():
    table, fresh = MurphyTable(MAP, joint_units=32, image_step=0.2), sightings(40, replicate=101)
    table.observe_many(sightings(1500))
    joints, targets = table.command(fresh.target), images(fresh)

    def distance(q):
        far = np.linalg.norm(table.envision(q) - targets, axis=1)
        inside = (np.abs(q).max(axis=1) <= 0.8 * np.pi) & (q[:, 1] * fresh.target.elbow > 0.0)
        return np.where(np.isnan(far) | ~inside, np.inf, far)

    here = distance(joints)
    assert np.median(here) < 0.015
    finest = 0.5 * table.codes.joint_step
    while 0.5 * finest > 1e-4:
        finest *= 0.5
    for move in np.vstack([np.eye(2), -np.eye(2)]) * finest:
        assert np.all(here <= distance(joints + move) + 1e-9)


def test_the_elbow_is_as_wanted_and_joints_stay_within_their_travel():
    table, fresh = MurphyTable(MAP, joint_units=32, image_step=0.2), sightings(80, replicate=101)
    table.observe_many(sightings(400))
    joints = table.command(fresh.target)
    np.testing.assert_array_equal(np.sign(joints[:, 1]), fresh.target.elbow)
    assert np.abs(joints).max() <= 0.8 * np.pi + 1e-12


def test_with_nothing_known_of_an_elbow_the_arm_stays():
    table, seen = MurphyTable(MAP, **SMALL), sightings(50)
    up = seen.joints[:, 1] >= 0.3 * np.pi
    np.testing.assert_array_equal(table.command(seen.target), 0.0)
    table.observe_many(seen[up])
    np.testing.assert_array_equal(table.command(seen.target[seen.target.elbow < 0.0]), 0.0)
    assert np.all(table.command(seen.target[up])[:, 1] > 0.0)


def test_memory_is_bounded_by_the_number_of_pairs():
    table = MurphyTable(MAP, **SMALL)
    table.observe_many(sightings(3000))
    many = table.n_connections
    table.observe_many(sightings(3000, replicate=101))
    assert many < table.n_connections < 1.1 * many
    assert table.n_connections < table.codes.joints**2 * table.codes.images**2


@pytest.mark.parametrize(
    ("settings", "says"),
    [
        ({"joint_units": 1}, "joint_units"),
        ({"image_step": 0.0}, "image_step"),
        ({"travel": 0.0}, "travel"),
        ({"width": 1.1}, "width must be at most 1"),
        ({"width": 0.0}, "width"),
        ({"on": 0.01}, "on"),
        ({"share": 1.0}, "share below 1"),
        ({"share": -0.1}, "share"),
        ({"width": 0.4, "on": 0.3}, "there are gaps"),
    ],
)
def test_settings_out_of_range_are_refused(settings, says):
    with pytest.raises(InvalidInput, match=says):
        MurphyTable(MAP, **settings)
