"""What the calibration page says of expected misses: in numbers, and in a map."""

import re
from dataclasses import replace

import numpy as np
import pytest
from tests.reports.made_up import planar_run, ur_run, ur_workspace

from handeye.calibration.results import PartChange
from handeye.errors import InvalidInput
from handeye.reports.calibration import calibration_page
from handeye.reports.calibration_parts import rows_section, surprises
from handeye.reports.figures import expected_map
from handeye.reports.page import Table
from handeye.reports.style import significant
from handeye.reports.svg import inline_svg

HEADING = "How far to trust it anywhere"
SPACE = ur_workspace(np.random.default_rng(1).uniform(-1.0, 1.0, (50, 3)))


def words(figure):
    return re.findall(r"<text[^>]*>([^<]*)</text>", inline_svg(figure, "a", "x"))


def drawn(**changes):
    space = replace(SPACE, **changes)
    return expected_map(space.positions, space.expected, space.worked, space.seen)


def page_of(result):
    return re.sub(r"\s+", " ", calibration_page(result).html().replace("\N{NO-BREAK SPACE}", " "))


def test_each_kind_of_posture_has_a_map_from_both_sides():
    said = words(drawn())
    assert said.count("Postures like those of the log") == 1
    assert said.count("Other postures") == 1
    assert said.count("Height [m]") == 2
    assert "Expected miss, root mean square [mm]" in said
    alone = words(drawn(worked=np.ones(600, np.bool_)))
    assert "Other postures" not in alone


def test_colours_begin_at_the_least_that_is_expected():
    said = words(drawn(expected=np.linspace(1.6e-4, 3.9e-4, 600)))
    steps = said[said.index("0.15") :][:6]
    assert steps == ["0.15", "0.2", "0.25", "0.3", "0.35", "0.4"]


def test_a_cell_has_the_colour_of_its_median():
    """Small and large misses in two places far apart, seen from the top."""
    places = np.zeros((40, 3))
    places[20:] = [1.0, 0.5, 0.2]
    sizes = np.r_[np.full(20, 1e-4), np.full(19, 1e-3), 9e-3]
    figure = expected_map(places, sizes, np.ones(40, np.bool_), places[:1])
    top = figure.axes[1].collections[0].get_array()
    assert top is not None
    np.testing.assert_allclose(np.sort(np.ma.compressed(top)), [0.1, 1.0])


@pytest.mark.parametrize(
    ("changes", "said"),
    [
        ({"positions": np.zeros((0, 3))}, "positions is empty"),
        ({"expected": np.full(3, 1e-3)}, "expected must have shape"),
        ({"expected": np.full(600, np.nan)}, "expected must be finite"),
        ({"worked": np.ones(3, np.bool_)}, "worked must have shape"),
    ],
)
def test_a_map_that_does_not_fit_together_is_refused(changes, said):
    with pytest.raises(InvalidInput, match=said):
        drawn(**changes)


def test_the_page_sets_what_was_expected_beside_what_came():
    result = ur_run(n=300)
    assert result.held_out is not None
    after = result.held_out.after
    sizes = np.linalg.norm(after, axis=1)
    expected = np.full(len(sizes), np.sqrt(np.mean(sizes**2)))
    right = replace(result.held_out, expected=expected)
    low = replace(right, expected=0.3 * expected)
    html = page_of(replace(result, held_out=right))
    assert HEADING in html
    rms = 1e3 * np.sqrt(np.mean(sizes**2))
    assert f"expected to miss by {rms:.2f} mm" in html
    assert f"and missed by {rms:.2f} mm" in html
    assert "too low" not in html
    assert "expected here is too low; count on more" in page_of(replace(result, held_out=low))
    assert "In other postures within the limits" in html


def test_who_does_not_know_has_no_such_part():
    for result in (planar_run(60), ur_run(n=60, expected=False)):
        html = page_of(result)
        assert HEADING not in html
        assert "Times the expected" not in html


def test_rows_to_look_at_state_their_surprise():
    result = ur_run(n=60)
    pulled = result.influence
    assert pulled is not None
    surprise, table = surprises(pulled), rows_section(result)[0].blocks[0]
    assert surprise is not None
    assert isinstance(table, Table)
    column = list(table.columns).index("Times the expected")
    assert pulled.expected is not None
    for i, row in zip(pulled.worst(8), table.rows, strict=True):
        assert row[column] == significant(float(pulled.residual[i] / pulled.expected[i]), 2)


def test_parts_change_by_thousandths():
    parts = (
        PartChange("a", 1e-3, "turn z", -1.1e-3, 4e-5, "rad", 0.9),
        PartChange("b", 1e-3, "shift x", 2.9e-4, 6e-5, "m", 0.9),
        PartChange("c", 1e-3, "scale", 2e-4, 6e-5, "", 0.9),
    )
    html = page_of(replace(ur_run(n=60), parts=parts))
    assert "\N{MINUS SIGN}1.1 ± 0.04 mrad" in html
    assert "+0.29 ± 0.06 mm" in html
    assert "+0.0002 ± 6e-05" in html
