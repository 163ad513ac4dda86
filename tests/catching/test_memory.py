import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from handeye.catching.memory import ShortTermMemory
from handeye.errors import InvalidInput


@given(
    pushed=st.lists(st.floats(-10.0, 10.0), max_size=12),
    depth=st.integers(1, 6),
    delay=st.integers(0, 4),
)
def test_what_was_recorded_so_many_ticks_ago_comes_back(pushed, depth, delay):
    memory = ShortTermMemory(["prompt", "late"], depth, 1, {"late": delay})
    for value in pushed:
        memory.tick()
        memory.record("prompt", [value])
        memory.record("late", [value])
    for ago in range(depth):
        for stream, lag in (("prompt", 0), ("late", delay)):
            before = len(pushed) - 1 - ago - lag
            expected = pushed[before] if before >= 0 else np.nan
            np.testing.assert_array_equal(memory.at(stream, ago), [expected])
            np.testing.assert_array_equal(memory.latest(stream, depth)[ago], [expected])


def test_trials_and_streams_are_kept_apart():
    memory = ShortTermMemory(["a", "b"], 2, 3)
    memory.tick()
    memory.record("a", [1.0, 2.0, 3.0])
    np.testing.assert_array_equal(memory.at("a"), [1.0, 2.0, 3.0])
    assert np.isnan(memory.at("b")).all()


def test_a_tick_opens_an_empty_place():
    memory = ShortTermMemory(["a"], 2, 1)
    memory.tick()
    memory.record("a", [5.0])
    memory.tick()
    assert np.isnan(memory.at("a")[0])
    assert memory.at("a", 1)[0] == 5.0


def test_forgetting_empties_one_stream_of_some_trials():
    memory = ShortTermMemory(["a", "b"], 2, 2)
    for value in (1.0, 2.0):
        memory.tick()
        for stream in "ab":
            memory.record(stream, [value, value])
    memory.forget("a", np.array([True, False]))
    np.testing.assert_array_equal(memory.latest("a", 2), [[np.nan, 2.0], [np.nan, 1.0]])
    np.testing.assert_array_equal(memory.latest("b", 2), [[2.0, 2.0], [1.0, 1.0]])


def test_impossible_memories_are_refused():
    with pytest.raises(InvalidInput, match="no stream 'c'"):
        ShortTermMemory(["a"], 2, 1, {"c": 1})
    with pytest.raises(InvalidInput, match="delay of a"):
        ShortTermMemory(["a"], 2, 1, {"a": -1})
    with pytest.raises(InvalidInput, match="depth"):
        ShortTermMemory(["a"], 0, 1)
