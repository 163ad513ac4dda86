"""Streams: independent by name, equal for who asks for the same, the same for ever."""

import numpy as np

from handeye.randomness import stream


def test_a_name_and_a_replicate_always_give_the_same_numbers():
    np.testing.assert_array_equal(stream("noise", 3).random(5), stream("noise", 3).random(5))


def test_names_and_replicates_are_independent():
    kinds = [("noise", 0), ("noise", 1), ("poses", 0), ("poses", 1)]
    drawn = np.stack([stream(*kind).standard_normal(4000) for kind in kinds])
    apart = np.corrcoef(drawn) - np.eye(len(kinds))
    assert np.abs(apart).max() < 0.06


def test_the_first_numbers_never_change():
    # Published results name a replicate; a newer version must meet the same world.
    np.testing.assert_array_equal(
        stream("world: train poses", 7).random(2), [0.5904321017277824, 0.8566880587041853]
    )
    np.testing.assert_array_equal(
        stream("world: train noise", 7).standard_normal(2),
        [-0.18997254498128266, 0.29617372507354206],
    )
