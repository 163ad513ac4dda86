from pathlib import Path

import numpy as np
import pytest

from handeye.thesis.claims import claims_by_id
from handeye.thesis.experiment import FULL
from handeye.thesis.experiments.real_sockets import REAL_SOCKETS
from handeye.thesis.manifest import Manifest
from handeye.thesis.real_data import ABSENT, real_data
from handeye.thesis.records import Record, Records
from handeye.thesis.reproduce import choose, measure, verdicts
from handeye.thesis.sockets import (
    APART,
    Held,
    Score,
    Sockets,
    fitted,
    left_out,
    score,
    sockets_data,
)
from handeye.thesis.storage import Stored

PANDA = REAL_SOCKETS.settings["panda-6"]


def test_measurements_are_where_the_variable_says(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    (tmp_path / "data" / "some").mkdir(parents=True)
    monkeypatch.setenv("HANDEYE_SHARED", str(tmp_path))
    assert real_data("some") == tmp_path / "data" / "some"
    assert real_data("other") is None
    assert not REAL_SOCKETS.can_run


def test_without_measurements_a_claim_is_not_run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    monkeypatch.setenv("HANDEYE_SHARED", str(tmp_path))
    chosen = choose(["sockets-panda6", "plant-uncorrected"])
    stored = measure(choose(["sockets-panda6"]), jobs=1)
    assert stored.manifest.experiments == {}
    (row,) = verdicts([claims_by_id()["sockets-panda6"]], stored)
    assert row.verdict == "not run"
    assert row.measured is None
    assert row.note.startswith(ABSENT)
    assert chosen.experiments[-1] == "real-sockets"


def test_stored_records_are_judged_without_measurements(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
):
    monkeypatch.setenv("HANDEYE_SHARED", str(tmp_path))
    claim = claims_by_id()["sockets-panda6"]
    paths = [claim.measure or "", *(other.measure for other in claim.also)]
    parts = [path.split("/") for path in paths]
    records = Records(Record(one, setting, 0, name, None, 2e-4) for one, setting, name in parts)
    (row,) = verdicts([claim], Stored(records, Manifest.of([REAL_SOCKETS])))
    assert (row.verdict, row.measured, row.low, row.high) == ("met", 2e-4, 2e-4, 2e-4)


def test_the_score_is_the_distance_from_the_mean_of_each_socket():
    held = Held(np.zeros((4, 7)), np.array([0, 0, 1, 1]))
    balls = np.array([[0, 0, 0], [0.002, 0, 0], [0.04, 0, 0], [0.04, 0.004, 0]], np.float64)
    away, distortion = score(balls, held)
    np.testing.assert_allclose(away, [0.001, 0.001, 0.002, 0.002])
    assert distortion == pytest.approx(APART - np.hypot(0.039, 0.002))


def test_an_arm_fitted_at_two_places_is_right_at_the_third(shared_data: Path):
    assert (shared_data / "ball_in_sockets").is_dir()
    arm, places = sockets_data(PANDA)
    at = places.pop("left")
    nominal = score(arm.poses(at.joints)[:, :3, 3], at)
    fit = fitted(arm, places, at, Sockets(PANDA.folder, PANDA.urdf))
    assert nominal.consistency.mean() > 8e-3
    assert nominal.distortion > 3e-3
    assert fit.consistency.mean() < 2.3e-4
    assert fit.distortion < 2e-4


def test_means_over_places_are_quoted(shared_data: Path, monkeypatch: pytest.MonkeyPatch):
    assert shared_data.is_dir()
    values = iter([1e-4, 3e-4, 8e-4])
    seen: list[tuple[set[str], Held]] = []

    def made_up(arm: object, others: dict[str, Held], at: Held, setting: object) -> Score:
        assert arm is not setting
        seen.append((set(others), at))
        return Score(np.full(5, next(values)), 2e-5)

    monkeypatch.setattr("handeye.thesis.sockets.fitted", made_up)
    found = left_out(PANDA, 0, FULL)
    _, places = sockets_data(PANDA)
    for (others, at), place in zip(seen, places, strict=True):
        assert others == set(places) - {place}
        np.testing.assert_array_equal(at.joints, places[place].joints)
    assert found["consistency"] == pytest.approx(4e-4)
    assert [found[place] for place in ("front", "left", "right")] == pytest.approx(
        [1e-4, 3e-4, 8e-4]
    )
    assert found["distortion"] == pytest.approx(2e-5)
