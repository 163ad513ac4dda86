"""What every learner promises: one suite over the table of tests/networks/learners.py."""

from functools import cache

import numpy as np
import pytest
from safetensors.numpy import save_file
from tests.networks.learners import EVERY, Case, samples, state

from handeye.errors import FileFormatError, InvalidInput

N = 40


@pytest.fixture(params=EVERY, ids=[case.name for case in EVERY])
def case(request):
    return request.param


@cache
def taught(case: Case):
    learner = case.make(0)
    learner.learn_many(*samples(learner, 0, N))
    return learner


@pytest.fixture
def learned(case: Case):
    return taught(case).copy()


def test_names_are_different():
    assert len({case.name for case in EVERY}) == len(EVERY)


def test_learn_returns_the_error_made_before_learning(learned):
    for x, target in zip(*samples(learned, 1, 12), strict=True):
        expected = target - learned.predict(x)
        result = learned.learn(x, target)
        assert result.error.shape == (learned.n_outputs,)
        np.testing.assert_allclose(result.error, expected, rtol=1e-11, atol=1e-12)


def test_learning_changes_the_output_there(learned):
    x, targets = samples(learned, 2, 1)
    target = targets[0] + 1.0
    before = np.linalg.norm(target - learned.predict(x[0]))
    for _ in range(10):
        learned.learn(x[0], target)
    assert np.linalg.norm(target - learned.predict(x[0])) < before


def test_learning_many_is_learning_one_by_one(case, tmp_path):
    many, one = case.make(0), case.make(0)
    x, targets = samples(many, 3, N)
    together = many.learn_many(x, targets)
    results = [one.learn(x_i, t) for x_i, t in zip(x, targets, strict=True)]
    assert type(together)._fields == type(results[0])._fields
    for field in type(together)._fields:
        np.testing.assert_array_equal(
            [getattr(result, field) for result in results], getattr(together, field)
        )
    assert state(one, tmp_path) == state(many, tmp_path)


def test_chunks_do_not_matter(case, tmp_path):
    whole, pieces = case.make(0), case.make(0)
    x, targets = samples(whole, 4, N)
    whole.learn_many(x, targets)
    for rows in (slice(0, 0), slice(0, 1), slice(1, 17), slice(17, N), slice(N, N)):
        pieces.learn_many(x[rows], targets[rows])
    assert state(pieces, tmp_path) == state(whole, tmp_path)


def test_prediction_is_pure_and_gives_new_arrays(learned, tmp_path):
    before = state(learned, tmp_path)
    x = samples(learned, 5, 20)[0]
    kept = x.copy()
    many = learned.predict_many(x)
    assert many.shape == (20, learned.n_outputs)
    assert many.dtype == np.float64
    np.testing.assert_array_equal([learned.predict(x_i) for x_i in x], many)
    first = learned.predict(x[0])
    first[:] = np.nan
    np.testing.assert_array_equal(learned.predict_many(x), many)
    np.testing.assert_array_equal(x, kept)
    assert learned.predict_many(np.zeros((0, learned.n_inputs))).shape == (0, learned.n_outputs)
    assert state(learned, tmp_path) == before


def test_learning_leaves_its_arguments_alone(case):
    learner = case.make(0)
    x, targets = samples(learner, 6, 10)
    kept = x.copy(), targets.copy()
    error = learner.learn_many(x, targets).error
    learner.learn(x[0], targets[0])
    np.testing.assert_array_equal(x, kept[0])
    np.testing.assert_array_equal(targets, kept[1])
    assert not np.shares_memory(error, targets)


@pytest.mark.parametrize("bad", [np.nan, np.inf, -np.inf, 1e200, "1", None, 1j])
def test_what_cannot_be_used_is_refused_and_changes_nothing(learned, bad, tmp_path):
    before = state(learned, tmp_path)
    x, targets = (array[:3].tolist() for array in samples(learned, 7, 3))
    for batch in (x, targets):
        good, batch[1] = batch[1], [bad, *batch[1][1:]]
        with pytest.raises(InvalidInput):
            learned.learn(x[1], targets[1])
        with pytest.raises(InvalidInput):
            learned.learn_many(x, targets)
        if batch is x:
            with pytest.raises(InvalidInput):
                learned.predict(x[1])
            with pytest.raises(InvalidInput):
                learned.predict_many(x)
        batch[1] = good
    assert state(learned, tmp_path) == before


def test_wrong_shapes_are_refused_and_change_nothing(learned, tmp_path):
    before = state(learned, tmp_path)
    x, targets = samples(learned, 8, 4)
    wide, deep = np.column_stack([x, x[:, 0]]), x[np.newaxis]
    for call in (
        lambda: learned.predict(x),
        lambda: learned.predict(wide[0]),
        lambda: learned.predict_many(x[0]),
        lambda: learned.predict_many(wide),
        lambda: learned.predict_many(deep),
        lambda: learned.learn(wide[0], targets[0]),
        lambda: learned.learn(x[0], [*targets[0], 0.0]),
        lambda: learned.learn(x, targets),
        lambda: learned.learn_many(wide, targets),
        lambda: learned.learn_many(x, targets[:3]),
        lambda: learned.learn_many(x[0], targets[0]),
    ):
        with pytest.raises(InvalidInput):
            call()
    assert state(learned, tmp_path) == before


def test_a_stored_learner_goes_on_alike(case, learned, tmp_path):
    path = tmp_path / "deep" / "er" / "learner.safetensors"
    learned.save(path)
    again = case.load(path)
    assert type(again) is type(learned)
    assert repr(again) == repr(learned)
    assert state(again, tmp_path) == state(learned, tmp_path)
    x, targets = samples(learned, 9, 20)
    np.testing.assert_array_equal(again.predict_many(x), learned.predict_many(x))
    for one, other in zip(
        again.learn_many(x, targets), learned.learn_many(x, targets), strict=True
    ):
        np.testing.assert_array_equal(one, other)
    assert state(again, tmp_path) == state(learned, tmp_path)


def test_a_fresh_learner_is_stored_too(case, tmp_path):
    fresh = case.make(3)
    fresh.save(tmp_path / "fresh")
    assert state(case.load(tmp_path / "fresh"), tmp_path) == state(fresh, tmp_path)


def test_damaged_foreign_and_missing_files_are_told_apart(case, learned, tmp_path):
    path = tmp_path / "learner"
    learned.save(path)
    whole = path.read_bytes()
    rng = np.random.default_rng(0)
    for length in rng.integers(0, len(whole), 10):
        path.write_bytes(whole[:length])
        with pytest.raises(FileFormatError, match=str(path)):
            case.load(path)
    # Behind the header lie the numbers; no change to them may go unnoticed.
    for position in rng.integers(len(whole) // 2, len(whole), 10):
        path.write_bytes(whole[:position] + bytes([whole[position] ^ 4]) + whole[position + 1 :])
        with pytest.raises(FileFormatError, match=str(path)):
            case.load(path)
    save_file({"weight": np.ones((2, 2))}, path)
    with pytest.raises(FileFormatError, match=str(path)):
        case.load(path)
    with pytest.raises(FileFormatError, match="no such file"):
        case.load(tmp_path / "nowhere")


def test_a_copy_is_independent(learned, tmp_path):
    copy, before = learned.copy(), state(learned, tmp_path)
    assert state(copy, tmp_path) == before
    copy.learn_many(*samples(learned, 10, 10))
    assert state(copy, tmp_path) != before
    assert state(learned, tmp_path) == before


def test_the_seed_decides_and_nothing_else(case, tmp_path):
    one, same, other = case.make(0), case.make(0), case.make(1)
    stream = samples(one, 11, 20)
    for learner in (one, same, other):
        learner.learn_many(*stream)
    assert state(one, tmp_path) == state(same, tmp_path)
    assert (state(one, tmp_path) != state(other, tmp_path)) == case.random


def test_outputs_stay_finite(learned):
    x, targets = samples(learned, 12, 20)
    x[::2] = x[0]
    error = learned.learn_many(np.repeat(x, 2, axis=0), np.repeat(targets, 2, axis=0)).error
    assert np.isfinite(error).all()
    everywhere = np.concatenate([x, 1e3 * x, np.zeros_like(x[:1]), 1e9 * x])
    assert np.isfinite(learned.predict_many(everywhere)).all()
