"""A described set-up from its file to what is told of it."""

from pathlib import Path

import numpy as np
import pytest
from tests.calibration.setups.setups import described

from handeye.arrays import Array
from handeye.calibration.results import Parameter
from handeye.calibration.setups.description import load_description
from handeye.calibration.setups.fit import fit_measurements, residuals
from handeye.calibration.setups.left_out import fitted
from handeye.calibration.setups.run import SetupResult, calibrate_setup
from handeye.calibration.setups.words import found_words

CAMERAS = "pixels of one point in two cameras"
WRONG = 17


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two cameras beside an arm; one row of the left one is wrong."""
    place = tmp_path_factory.mktemp("cameras")
    described(CAMERAS, place, 3)
    lines = (place / "left.csv").read_text(encoding="utf-8").splitlines()
    head, u, v = lines[WRONG - 1].rsplit(",", 2)
    lines[WRONG - 1] = f"{head},{1919.0 - float(u)},{v}"
    (place / "left.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")
    return place


@pytest.fixture(scope="module")
def result(folder: Path) -> SetupResult:
    return calibrate_setup(load_description(folder / "setup.yaml"))


def test_held_out_rows_are_predicted_far_better_than_before(result: SetupResult):
    assert result.status == "improved"
    assert list(result.errors) == ["pixels of left", "pixels of right"]
    errors = result.errors["pixels of left"]
    assert errors.unit == "px"
    before, after = errors.summaries()
    assert before.n == len(result.described.sources[0].rows)
    assert result.n_rows == sum(len(one.row) for one in result.errors.values())
    assert np.median(np.linalg.norm(errors.after, axis=1)) < 0.3
    assert np.median(np.linalg.norm(errors.before, axis=1)) > 1.0
    assert before.interval is not None
    assert after.interval is not None
    assert sorted(set(errors.block.tolist())) == [0, 1, 2, 3, 4]


def test_the_wrong_row_is_named_first(result: SetupResult):
    (channel, k), *_ = result.worst(3)
    assert result.source(channel, k) == (result.described.sources[0].file, WRONG)
    assert result.doubts(channel)[k]
    assert result.doubts(channel).sum() <= 3
    assert result.errors[channel].times[k] > 20.0
    assert 0.7 < np.median(result.errors[channel].times) < 1.4


def test_errors_of_fitted_rows_are_residuals_of_the_fit(result: SetupResult):
    right = "pixels of right"
    errors, one = fitted(result.fit)[right], result.fit.measurements[1]
    own = residuals(one, result.fit.flanges(one.joints))
    np.testing.assert_array_equal(errors.after, own[right])
    quick = calibrate_setup(result.described, validate=False)
    assert not quick.held_out
    np.testing.assert_allclose(quick.errors[right].after, errors.after, atol=1e-9)
    assert quick.errors[right].summaries()[1].interval is None


def test_parameters_are_what_was_found(result: SetupResult):
    fit = result.fit
    named = {p.name: p for p in result.parameters}
    dot = [named[f"dot {axis}"].value for axis in "xyz"]
    np.testing.assert_array_equal(dot, fit.measurements[0].sight.points.reference[0])
    assert [named[f"dot {axis}"].std for axis in "xyz"] == fit.std("dot").tolist()
    assert all(named[f"dot {axis}"].nominal is None for axis in "xyz")
    left = fit.measurements[0].sight.sensor
    at = [named[f"frame of left {axis}"].value for axis in "xyz"]
    np.testing.assert_array_equal(at, left.reference[:3, 3])
    # Along axes of the base: a frame's own are turned against them.
    R, own = left.reference[:3, :3], fit.covariance[fit.problem.places[left.name]]
    C = own[:, fit.problem.places[left.name]][:3, :3]
    std = [named[f"frame of left {axis}"].std or 0.0 for axis in "xyz"]
    np.testing.assert_allclose(std, np.sqrt(np.diag(R @ C @ R.T)))
    zero = named["elbow_joint zero"]
    assert zero.nominal == 0.0
    assert zero.unit == "rad"
    assert not any("cos" in name for name in named)


def test_parts_move_what_the_flange_carries_as_far_as_differences_say(result: SetupResult):
    fit = result.fit
    names, _, _, groups = fit.of_arm()
    (group,) = [g for g in groups if g.words == "encoder offset of joint elbow_joint"]
    (part,) = [p for p in result.parts if p.part == group.words]
    x, without = fit.posterior.x, fit.posterior.x.copy()
    without[list(group.places)] = 0.0
    every = max(result.n_rows // 100, 1)
    moved: list[Array] = []
    for one in fit.measurements:
        q, c = one.joints[::every], [*one.sight.points.reference[0], 1.0]
        change = fit.problem.flanges(x, q) - fit.problem.flanges(without, q)
        moved.append((change @ c)[:, :3])
    size = np.sqrt(np.mean(np.sum(np.concatenate(moved) ** 2, axis=1)))
    assert part.moves == pytest.approx(size, rel=0.02)
    assert part.unknown == names[group.places[0]]
    assert [p.moves for p in result.parts] == sorted((p.moves for p in result.parts), reverse=True)


def test_what_turns_everything_alike_is_open(result: SetupResult):
    # Cameras that stand still cannot tell the first joint's zero from a turn of the whole set-up.
    named = {p.name: p for p in result.parameters}
    assert (named["shoulder_pan_joint zero"].std or 0.0) > 0.6 * 0.01
    assert any("shoulder_pan_joint zero" in line for line in result.undetermined)


@pytest.mark.parametrize("timed", [True, False])
def test_the_order_of_rows_does_not_matter(folder: Path, tmp_path: Path, timed: bool):
    """With times results are the same to the bit; without, to a small part of what is unknown."""
    rng = np.random.default_rng(8)
    for shuffled in (False, True):
        place = tmp_path / str(shuffled)
        place.mkdir()
        (place / "setup.yaml").write_bytes((folder / "setup.yaml").read_bytes())
        for name in ("left.csv", "right.csv"):
            header, *rows = (folder / name).read_text(encoding="utf-8").splitlines()
            if timed:
                header, rows = f"{header},time_s", [f"{row},{i}" for i, row in enumerate(rows)]
            if shuffled:
                rng.shuffle(rows)
            (place / name).write_text("\n".join([header, *rows]) + "\n", encoding="utf-8")
    both = [load_description(tmp_path / s / "setup.yaml") for s in ("False", "True")]
    fits = [fit_measurements(one.arm, one.measurements, one.sheet) for one in both]
    if timed:
        np.testing.assert_array_equal(fits[0].posterior.x, fits[1].posterior.x)
        rows = [one.sources[0].rows.tolist() for one in both]
        assert rows[0] != rows[1]
        assert sorted(rows[0]) == sorted(rows[1])
    for name in fits[0].unknowns:
        first, second = (_reference(fit.unknowns[name]) for fit in fits)
        near = 1e-9 if timed else 0.02 * fits[0].std(name).min()
        np.testing.assert_allclose(first, second, atol=near)


def _reference(unknown: object) -> Array:
    return unknown.reference  # pyright: ignore[reportAttributeAccessIssue]


def test_numbers_are_shown_as_far_as_they_are_known():
    one = Parameter("reel x", 1.400123456, 2.34e-3, "m", 1.4)
    assert found_words("reel", one) == ("x [mm]", "1400.1", "2.3", "1400.0")
    turn = Parameter("reel rz", np.radians(0.123456), np.radians(0.012), "rad")
    assert found_words("reel", turn) == ("turn about z [°]", "0.123", "0.012", "")
    assert found_words("eye", Parameter("eye k1", -0.1, 0.002, "", -0.1))[0] == "k1"
