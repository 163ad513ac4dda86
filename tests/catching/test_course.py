"""A course ends the same however often it was left, saved and gone on with."""

from dataclasses import replace

import numpy as np
import pytest

from handeye.catching.course import MARKS, Course, Exam, Plan, Practice, steps
from handeye.catching.course_file import load_course, save_course
from handeye.catching.learner import Learner
from handeye.catching.settings import IMPROVED, THESIS
from handeye.catching.world import World
from handeye.errors import FileFormatError, InvalidInput
from handeye.io.tensors import read_tensors, write_tensors

PLAN = Plan(pursuits=12, tosses=4, mentored=2, mark_throws=2)
WORLD = World()


def finished(plan=PLAN):
    course = Course(Learner(THESIS), WORLD, plan)
    assert course.run()
    return course


@pytest.fixture(scope="module")
def whole():
    """A course that was never left."""
    return finished()


def learned(course):
    """Everything a learner knows."""
    return {
        f"{name}/{part}": array
        for name, skill in course.learner.repertoire.skills()
        for part, array in (("centers", skill.network.centers), ("weights", skill.network.weights))
    }


def assert_same(one, other):
    assert one.marks == other.marks
    assert one.learner.neurons == other.learner.neurons
    first, second = learned(one), learned(other)
    for name, array in first.items():
        np.testing.assert_array_equal(second[name], array, err_msg=name)
    assert [take.title for take in one.takes] == [take.title for take in other.takes]
    for mine, theirs in zip(one.takes, other.takes, strict=True):
        np.testing.assert_array_equal(mine.recording.voltage, theirs.recording.voltage)
        np.testing.assert_array_equal(mine.recording.sensed, theirs.recording.sensed)
        np.testing.assert_array_equal(mine.recording.final, theirs.recording.final)
        np.testing.assert_array_equal(mine.recording.caught, theirs.recording.caught)
        np.testing.assert_array_equal(mine.recording.throws.vx, theirs.recording.throws.vx)


def test_a_course_saved_and_loaded_before_every_step_ends_the_same(whole, tmp_path):
    path = tmp_path / "learner.safetensors"
    course = Course(Learner(THESIS), WORLD, PLAN)
    for _ in steps(PLAN):
        assert course.trials_left > 0 or len(course.marks) < len(whole.marks)
        allowed = [True, False]
        course.run(lambda _, left=allowed: left.pop(0))
        save_course(path, course)
        course = load_course(path, WORLD)
    assert course.run(lambda _: pytest.fail("something remains to be done"))
    assert_same(course, whole)
    assert course.plan == PLAN
    assert course.cpu_seconds > 0.0


def test_what_is_learned_does_not_depend_on_the_tests(whole):
    other = finished(replace(PLAN, mark_throws=1))
    for name, array in learned(whole).items():
        np.testing.assert_array_equal(learned(other)[name], array)


def test_another_replicate_meets_other_movements_and_throws(whole):
    other = finished(replace(PLAN, replicate=1))
    assert other.marks != whole.marks
    watched, moved = "ball_states.0/centers", "arm_states.0/centers"
    for name in (watched, moved):
        first, second = (set(learned(course)[name].ravel().tolist()) for course in (whole, other))
        assert len(first & second) < 0.5 * len(first)
    assert not np.array_equal(
        other.takes[0].recording.throws.vx, whole.takes[0].recording.throws.vx
    )


def test_a_course_does_what_the_plan_says(whole):
    learner = whole.learner
    assert (learner.tosses, learner.pursuits, learner.mentored) == ([4, 4], [12, 12], 2)
    assert whole.trials_left == 0
    tested = [(mark.pursuits, mark.mentored) for mark in whole.marks]
    assert tested == [(0, 0), (10, 0), (12, 0), (12, 2)]
    titles = ["no pursuit", "10 pursuits", "12 pursuits", "12 pursuits + mentor"]
    assert [take.title for take in whole.takes] == titles
    assert all(score.n == 2 for mark in whole.marks for score in mark.scores)
    assert len(whole.marks[0].scores) == 4


def test_who_takes_no_advice_has_no_mentor():
    course = Course(Learner(IMPROVED), WORLD, replace(PLAN, pursuits=2))
    assert course.trials_left == 4 + 4 + 2 + 2
    assert course.run()
    assert course.learner.mentored == course.trials_left == 0
    assert [mark.mentored for mark in course.marks] == [0, 0]


def test_before_its_first_pursuit_the_arm_does_not_move(whole):
    first = whole.takes[0].recording
    assert not np.nan_to_num(first.voltage).any()
    places = first.sensed.arm_x
    assert (np.nanmax(places, axis=0) == np.nanmin(places, axis=0)).all()


def test_one_arm_and_one_ball_can_be_trained_alone():
    course = finished(Plan(pursuits=2, tosses=2, mentored=3, arms=(1,), balls=(0,), mark_throws=2))
    assert (course.learner.pursuits, course.learner.tosses) == ([0, 2], [2, 0])
    assert set(course.takes[-1].recording.throws.ball) == {0}
    assert course.learner.neurons["corrections.0"] == 0 < course.learner.neurons["corrections.1"]
    assert [(s.ball, s.arm) for s in course.marks[-1].scores] == [(0, 1)]


def test_a_longer_plan_goes_on_where_the_shorter_one_ended(whole, tmp_path):
    save_course(tmp_path / "a", whole)
    course = load_course(tmp_path / "a", WORLD)
    course.plan = replace(PLAN, pursuits=14, mentored=3)
    assert course.trials_left == 5
    seen = []
    assert course.run(lambda step: seen.append(step) or True)
    assert seen == [Practice("pursuits", 0, 14), Practice("pursuits", 1, 14),
                    Practice("mentored", -1, 3), Exam(14, 3)]  # fmt: skip
    assert course.marks[: len(whole.marks)] == whole.marks


def test_test_throws_begin_with_the_beliefs_asked_for(whole):
    beliefs = {"known": 0, "wrong": 1}
    for beginning, off in beliefs.items():
        recording = whole.test(1, beginning)
        np.testing.assert_array_equal(
            recording.traces["ball"][0], np.abs(recording.throws.ball - off)
        )
    assert (whole.test(1, "unknown").traces["ball"][0] == -1).all()
    np.testing.assert_array_equal(
        whole.test(1, "known").throws.vx, whole.test(1, "wrong").throws.vx
    )
    surprised = whole.surprise()
    np.testing.assert_array_equal(surprised.traces["arm"][0], 1 - surprised.throws.arm)


def test_the_file_of_a_course_is_the_file_of_a_learner(whole, tmp_path):
    save_course(tmp_path / "course", whole)
    assert Learner.load(tmp_path / "course").neurons == whole.learner.neurons


def test_a_learner_saved_alone_is_a_course_at_its_end(whole, tmp_path):
    whole.learner.save(tmp_path / "learner")
    course = load_course(tmp_path / "learner", WORLD)
    assert course.trials_left == 0
    assert course.marks == []
    assert course.run()
    assert [(mark.pursuits, mark.mentored) for mark in course.marks] == [(12, 2)]


def test_a_file_whose_course_does_not_fit_is_refused(whole, tmp_path):
    path = tmp_path / "course"
    save_course(path, whole)
    arrays, header = read_tensors(path, "handeye.catcher", 1, "a learner")
    del arrays["course/0/voltage"]
    write_tensors(path, "handeye.catcher", 1, arrays, header)
    with pytest.raises(FileFormatError, match="its course does not fit together"):
        load_course(path, WORLD)


def test_portions_end_at_round_numbers_and_at_marks_whatever_the_total():
    short, long = (
        [step for step in steps(Plan(pursuits=n)) if isinstance(step, Practice)] for n in (200, 350)
    )
    both = [step for step in short if step.kind != "mentored"]
    assert long[: len(both)] == both
    for plan in (Plan(pursuits=250, tosses=130, mentored=35), Plan(0, 0, 0)):
        done = list(steps(plan))
        last = {(s.kind, s.identity): s.upto for s in done if isinstance(s, Practice)}
        assert all(upto == getattr(plan, kind) for (kind, _), upto in last.items())
        assert done[-1] == Exam(plan.pursuits, plan.mentored)
    assert set(MARKS) > {0, 10, 100}


@pytest.mark.parametrize(
    ("wrong", "complaint"),
    [
        ({"pursuits": -1}, "pursuits must be a whole number"),
        ({"mark_throws": 0}, "mark_throws must be"),
        ({"arms": ()}, "arms must be one or more identities"),
        ({"balls": (1, 1)}, "balls must be one or more identities"),
    ],
)
def test_an_impossible_plan_is_refused(wrong, complaint):
    with pytest.raises(InvalidInput, match=complaint):
        Plan(**wrong)
