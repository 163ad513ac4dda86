"""The page of a described set-up, and its picture of a camera's errors."""

from pathlib import Path

import numpy as np
import pytest
from matplotlib.quiver import Quiver
from tests.calibration.setups.setups import described

from handeye.calibration.setups.description import load_description
from handeye.calibration.setups.run import SetupResult, calibrate_setup
from handeye.errors import InvalidInput
from handeye.reports.figures import errors_in_picture
from handeye.reports.setup import setup_page


@pytest.fixture(scope="module")
def result(tmp_path_factory: pytest.TempPathFactory) -> SetupResult:
    folder = tmp_path_factory.mktemp("page")
    described("poses, eye to hand", folder, 1)
    return calibrate_setup(load_description(folder / "setup.yaml"))


def test_a_page_tells_every_channel_in_its_unit(result: SetupResult):
    page = setup_page(result, "setup.yaml", date="today").html()
    for words in (
        "Position: the middle error is now", "Median error: orientation", "Which part of the arm",
        "What is not determined", "Rows to look at first", "poses.csv", "probe", "tag",
        "turn about z [°]", "Error lines in space", "orientation [°], as found",
    ):  # fmt: skip
        assert words in page, words
    assert page == setup_page(result, "setup.yaml", date="today").html()


def test_a_page_says_when_rows_were_fitted(result: SetupResult):
    quick = calibrate_setup(result.described, validate=False)
    page = setup_page(quick, "setup.yaml").html()
    assert "These rows were fitted, which flatters" in page
    assert "rows that were fitted" in page


def test_arrows_end_where_points_were_seen():
    rng = np.random.default_rng(0)
    seen = rng.uniform(100.0, 500.0, (40, 2))
    before, after = rng.normal(0.0, 5.0, (40, 2)), rng.normal(0.0, 0.1, (40, 2))
    figure = errors_in_picture(seen, before, after, size=(640, 480))
    assert [axes.get_title(loc="left").split(":")[0] for axes in figure.axes] == ["Before", "After"]
    for axes, errors in zip(figure.axes, (before, after), strict=True):
        (arrows,) = [one for one in axes.collections if isinstance(one, Quiver)]
        drawn = np.column_stack([arrows.U, arrows.V])
        starts = np.asarray(arrows.get_offsets(), np.float64)
        np.testing.assert_allclose(starts + drawn, seen)
        times = drawn / errors
        np.testing.assert_allclose(times, times[0, 0])
        assert f"drawn {times[0, 0]:,g}×" in axes.get_title(loc="left")
        assert axes.get_xlim() == (-0.5, 639.5)
        assert axes.get_ylim() == (479.5, -0.5)


def test_pictures_without_points_are_refused():
    with pytest.raises(InvalidInput, match="pixels is empty"):
        errors_in_picture(np.zeros((0, 2)), np.zeros((0, 2)), np.zeros((0, 2)))
    with pytest.raises(InvalidInput, match="after must have shape"):
        errors_in_picture(np.zeros((2, 2)), np.zeros((2, 2)), np.zeros((3, 2)))


def test_pages_are_written(result: SetupResult, tmp_path: Path):
    assert setup_page(result, "setup.yaml").write(tmp_path / "a.html").is_file()
