"""`handeye catch` as a user meets it: train, leave, go on, and what goes wrong."""

import json
import signal
import sys
from pathlib import Path

import pytest
from tests.cli.running import done, refused, run

from handeye.catching.course import Course
from handeye.catching.course_file import load_course
from handeye.catching.learner import Learner
from handeye.catching.world import World
from handeye.cli.catch import INTERRUPTED

LITTLE = ("--pursuits", 12, "--tosses", 4, "--mentored", 2, "--test", 2)
ONE_PAIR = (*LITTLE, "--arm", "light", "--ball", "heavy")


@pytest.fixture
def no_drawing(monkeypatch: pytest.MonkeyPatch):
    """As if the extra for pages were not installed; saves the time of drawing."""
    for module in [name for name in sys.modules if name.startswith("handeye.reports")]:
        monkeypatch.delitem(sys.modules, module)
    monkeypatch.setitem(sys.modules, "matplotlib", None)


@pytest.fixture
def interrupted(monkeypatch: pytest.MonkeyPatch):
    """Presses Ctrl-C during the third portion of practice, once."""
    practise, portions = Course._practise, []

    def pressed(course: Course, step):
        portions.append(step)
        if len(portions) == 3:
            signal.raise_signal(signal.SIGINT)
        practise(course, step)

    monkeypatch.setattr(Course, "_practise", pressed)


def data_of(*arguments: object) -> dict:
    """What `--json -` prints, without what differs from run to run."""
    data = json.loads(done(*arguments, "--json", "-").stdout)
    assert data.pop("cpu_seconds") > 0.0
    data.pop("files")
    return data


def test_catch_prints_tables_and_writes_page_animation_and_learner(tmp_path: Path):
    learner = tmp_path / "learner.safetensors"
    result = done("catch", *LITTLE, "--out", tmp_path / "out", "--save", learner)
    for expected in ("of 8 test throws", "light ball, heavy arm", "95 % interval", "rms error",
                     "motor command, heavy arm", "of processor time"):  # fmt: skip
        assert expected in result.stdout
    page, moving = tmp_path / "out" / "catch.html", tmp_path / "out" / "catch.gif"
    for path in (page, moving, learner):
        assert str(path) in result.stdout
    assert moving.read_bytes().startswith(b"GIF89a")
    html = page.read_text("utf-8")
    assert "data:image/gif" in html
    assert "improved" in html
    assert Learner.load(learner).pursuits == [12, 12]


@pytest.mark.usefixtures("no_drawing")
def test_the_json_has_every_number(tmp_path: Path):
    target = tmp_path / "results.json"
    printed = done("catch", *ONE_PAIR, "--settings", "thesis", "--json", target, "--out", tmp_path)
    assert "test throws" in printed.stdout
    data = json.loads(target.read_text())
    assert data["settings"]["settings"] == "thesis"
    assert data["settings"]["pursuits with each arm"] == "12"
    assert data["settings"]["throws with the mentor"] == "2"
    (score,) = data["scores"]
    assert (score["ball"], score["arm"], score["n"]) == ("heavy", "light", 2)
    assert 0.0 <= score["low"] <= score["share"] <= score["high"] <= 1.0
    assert data["total"]["caught"] == score["caught"]
    assert [mark["pursuits"] for mark in data["marks"]] == [0, 10, 12, 12]
    assert data["neurons"]["motors.0"] > 0
    assert data["neurons"]["motors.1"] == 0


@pytest.mark.usefixtures("no_drawing")
def test_a_saved_learner_is_tested_again_with_the_same_result(tmp_path: Path):
    learner = tmp_path / "learner.safetensors"
    out = ("--out", tmp_path)
    first = data_of("catch", *ONE_PAIR, "--save", learner, *out)
    kept = load_course(learner, World())
    assert len(kept.marks) == len(kept.takes) == len(first["marks"])
    assert data_of("catch", "--learner", learner, "--test", 2, *out) == first
    again = data_of("catch", "--learner", learner, "--test", 2, "--identities", "wrong", *out)
    assert again["neurons"] == first["neurons"]
    assert again["settings"]["ball and arm at the start of a test throw"] == "wrong"


@pytest.mark.usefixtures("no_drawing")
def test_another_replicate_gives_another_learner(tmp_path: Path):
    first, second = (
        data_of("catch", *ONE_PAIR, "--replicate", i, "--out", tmp_path) for i in (0, 1)
    )
    assert first["neurons"] != second["neurons"]
    assert first["settings"]["throws with the mentor"] == "0"  # --mentored 2, but no advice taken


@pytest.mark.usefixtures("no_drawing")
def test_ctrl_c_keeps_what_is_learned_and_going_on_ends_the_same(
    tmp_path: Path, request: pytest.FixtureRequest
):
    learner, out = tmp_path / "learner.safetensors", ("--out", tmp_path)
    course = (*ONE_PAIR, "--settings", "thesis")
    whole = data_of("catch", *course, *out)
    request.getfixturevalue("interrupted")
    before = signal.getsignal(signal.SIGINT)
    stopped = run("catch", *course, "--save", learner, *out)
    assert stopped.exit_code == INTERRUPTED
    assert f"--learner {learner} --save {learner}" in " ".join(stopped.stderr.split())
    assert "2 trials left" in stopped.stderr
    assert signal.getsignal(signal.SIGINT) is before
    kept = Learner.load(learner)
    assert (kept.tosses, kept.pursuits, kept.mentored) == ([0, 4], [12, 0], 0)
    assert data_of("catch", "--learner", learner, "--test", 2, *out) == whole


@pytest.mark.usefixtures("no_drawing", "interrupted")
def test_ctrl_c_without_a_place_to_save_says_that_nothing_is_kept(tmp_path: Path):
    stopped = run("catch", *ONE_PAIR, "--out", tmp_path)
    assert stopped.exit_code == INTERRUPTED
    assert "nothing is kept without --save FILE" in stopped.stderr
    assert list(tmp_path.iterdir()) == []


def test_misuse_of_catch_is_explained(tmp_path: Path):
    out = ("--out", tmp_path / "out")
    learner = tmp_path / "learner.safetensors"
    Learner().save(learner)
    assert "no such file" in refused("catch", "--learner", tmp_path / "absent", *out)
    (tmp_path / "text").write_text("not a learner")
    assert "not a learner that catches" in refused("catch", "--learner", tmp_path / "text", *out)
    for option in ("--pursuits", "--tosses", "--mentored", "--replicate"):
        assert option in refused("catch", option, -1, *out)
    assert "--test" in refused("catch", "--test", 0, *out)
    assert "--settings" in refused("catch", "--settings", "best", *out)
    (tmp_path / "file").write_text("in the way")
    for option in ("--save", "--json"):
        message = refused("catch", *ONE_PAIR, option, tmp_path / "file" / "x", *out)
        assert "cannot be read or written" in message
    assert "is a folder" in refused("catch", *ONE_PAIR, "--json", tmp_path, *out)


@pytest.mark.usefixtures("no_drawing")
def test_a_learner_goes_on_as_it_began(tmp_path: Path):
    learner = tmp_path / "learner.safetensors"
    done("catch", *ONE_PAIR, "--settings", "thesis", "--save", learner, "--out", tmp_path)
    before = learner.read_bytes()
    common = ("catch", "--learner", learner, "--save", learner, "--out", tmp_path)
    assert "leave out --settings" in refused(*common, "--settings", "smooth")
    assert "leave out --replicate" in refused(*common, "--replicate", 3)
    assert learner.read_bytes() == before
    done(*common, "--settings", "thesis", "--replicate", 0, "--test", 2, "--mentored", 3)
    assert Learner.load(learner).mentored == 3


def test_catch_explains_itself():
    assert "catch" in done("--help").stdout
    shown = done("catch", "--help").stdout
    for option in ("--settings", "--pursuits", "--learner", "--save", "--identities", "--json"):
        assert option in shown
