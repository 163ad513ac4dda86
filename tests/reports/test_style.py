"""Colours that can be read and lengths in words."""

import importlib
import re
import sys

import numpy as np
import pytest

import handeye.reports
from handeye.errors import InvalidInput, MissingExtra
from handeye.reports.figures import running_error
from handeye.reports.style import (
    PALETTE,
    length,
    length_unit,
    new_figure,
    nice_above,
    nice_below,
    significant,
)
from handeye.reports.svg import inline_svg, png, write_png

NBSP = "\N{NO-BREAK SPACE}"


def luminance(shade):
    """Relative luminance of WCAG 2."""
    parts = np.array([int(shade[i : i + 2], 16) / 255 for i in (1, 3, 5)])
    linear = np.where(parts <= 0.04045, parts / 12.92, ((parts + 0.055) / 1.055) ** 2.4)
    return float(linear @ (0.2126, 0.7152, 0.0722))


@pytest.mark.parametrize("scheme", [0, 1], ids=["light", "dark"])
@pytest.mark.parametrize("name", ["ink", "soft", "before", "after", "third", "fourth"])
@pytest.mark.parametrize("ground", ["paper", "card"])
def test_words_and_lines_stand_out_from_the_ground(scheme, name, ground):
    bright, dim = sorted(
        (luminance(PALETTE[which][scheme]) for which in (name, ground)), reverse=True
    )
    assert (bright + 0.05) / (dim + 0.05) >= 4.5


@pytest.mark.parametrize("scheme", [0, 1], ids=["light", "dark"])
def test_the_error_scale_moves_steadily_away_from_the_card(scheme):
    shades = [luminance(PALETTE[f"error{i}"][scheme]) for i in range(6)]
    away = [abs(shade - luminance(PALETTE["card"][scheme])) for shade in shades]
    assert away == sorted(away)


def test_no_two_names_share_a_light_colour():
    lights = [light for light, _ in PALETTE.values()]
    assert len(set(lights)) == len(lights)


@pytest.mark.parametrize(
    ("value", "words"),
    [
        (0.045, "4.5 cm"),
        (0.0125, "12 mm"),
        (0.000385, "0.38 mm"),
        (0.00104, "1.0 mm"),
        (2e-6, "2.0 µm"),
        (0.41, "41 cm"),
        (0.0, "0 mm"),
        (12.3, "1,200 cm"),
    ],
)
def test_lengths_are_written_with_few_digits(value, words):
    assert length(value) == words.replace(" ", NBSP)


def test_a_length_takes_the_unit_of_the_one_beside_it():
    assert length(0.0125, beside=0.045) == f"1.2{NBSP}cm"


def test_units_and_round_numbers():
    assert length_unit(0.03).name == "cm"
    assert significant(0.04567, 3) == "0.0457"
    assert nice_below(79.0) == 60.0
    assert nice_below(80.0) == 80.0
    assert nice_above(0.21) == 0.25
    assert nice_above(5.0) == 5.0


def test_a_drawing_follows_the_scheme_and_carries_no_foreign_ids_or_dates():
    svg = inline_svg(running_error([0.1, 0.2], [0.1, 0.1]), "figure7", 'says "what" <it> shows')
    assert "var(--before, " in svg
    assert "DejaVu" not in svg
    assert "http" not in svg
    assert 'aria-label="says &quot;what&quot; &lt;it&gt; shows"' in svg
    ids = re.findall(r'\bid="([^"]+)"', svg)
    assert ids
    assert len(ids) == len(set(ids))
    assert all(one.startswith("figure7-") for one in ids)
    targets = re.findall(r'(?:url\(|href=")#([^")]+)', svg)
    assert set(targets) == set(ids)


def test_names_in_any_script_and_with_markup_are_drawn_as_written():
    figure = running_error([0.1], [0.1], names=("<b>$x$</b>", "関節"))
    svg = inline_svg(figure, "a", "x")
    assert "&lt;b&gt;$x$&lt;/b&gt;" in svg
    assert "関節" in svg
    assert png(figure).startswith(b"\x89PNG")


def test_a_still_that_cannot_be_written_says_where_and_why(tmp_path):
    (tmp_path / "file").write_text("in the way")
    with pytest.raises(InvalidInput, match=r"still\.png: cannot be written"):
        write_png(new_figure(50, 50), tmp_path / "file" / "still.png")


@pytest.mark.parametrize("absent", ["matplotlib", "jinja2"])
def test_without_the_extra_the_error_says_what_to_install(monkeypatch, absent):
    monkeypatch.setitem(sys.modules, absent, None)
    with pytest.raises(MissingExtra, match=r"pip install 'handeye\[report\]'"):
        importlib.reload(handeye.reports)
