"""Pages: escaped, the same every time, whole or not at all, and their words fit the numbers."""

import re
from dataclasses import replace
from html.parser import HTMLParser

import numpy as np
import pytest
from tests.reports.made_up import demo_run, planar_run, ur_run

from handeye.calibration.results import ErrorSummary
from handeye.errors import InvalidInput
from handeye.reports.calibration import calibration_page
from handeye.reports.demo import demo_page, demo_still
from handeye.reports.page import (
    Badge,
    FigureBlock,
    Notes,
    Page,
    Prose,
    Section,
    StatTiles,
    Table,
    Tile,
)
from handeye.reports.style import new_figure
from handeye.reports.svg import png

EVIL = "<script>alert('x')</script>&\"$"


class Outline(HTMLParser):
    """The tags, ids and texts of a page."""

    def __init__(self, html):
        super().__init__()
        self.tags, self.ids, self.texts = [], [], []
        self.feed(html)

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        self.ids += [value for key, value in attrs if key == "id"]

    def handle_data(self, data):
        self.texts.append(data)


def everything(text):
    """A page with every kind of block, all of whose words are `text`."""
    return Page(
        title=text,
        headline=text,
        subtitle=text,
        sections=[
            Section(text, [StatTiles([Tile(text, text, text, text, "good")]), Prose(text)]),
            Section(text, [Table([text, text], [[text, Badge(text, "bad")]], text)]),
            Section(text, [FigureBlock(new_figure(80, 40), text, text)]),
            Section(text, [Notes(text, [text]), Notes(text, [text], folded=True)]),
        ],
        settings={text: text},
        date=text,
    )


def test_whatever_a_block_says_is_escaped():
    outline = Outline(everything(EVIL).html())
    assert "script" not in outline.tags
    assert outline.texts.count(EVIL) == 24
    log = Outline(calibration_page(ur_run(n=30, log="logs/<script>.csv", rejected=[EVIL])).html())
    assert "script" not in log.tags
    assert any("ur10, from <script>.csv" in text for text in log.texts)
    assert EVIL in log.texts


def test_headings_go_in_order_and_the_page_is_in_a_language():
    html = everything("word").html()
    headings = [tag for tag in Outline(html).tags if re.fullmatch(r"h\d", tag)]
    assert headings == ["h1"] + ["h2"] * 5
    assert '<html lang="en">' in html


@pytest.mark.parametrize(
    "make",
    [
        lambda: calibration_page(ur_run(n=120)),
        lambda: demo_page(demo_run(), settings={"seed": "0"}),
    ],
    ids=["calibration", "demo"],
)
def test_a_page_is_the_same_every_time_with_ids_that_never_clash(make):
    first = make().html()
    assert first == make().html()
    ids = Outline(first).ids
    assert len(ids) == len(set(ids)) > 0
    assert "http://" not in first
    assert "https://" not in first


def test_the_date_appears_only_when_given():
    assert " on 2026" not in calibration_page(planar_run(9)).html()
    assert "on 2026-11-22" in calibration_page(planar_run(9), date="2026-11-22").html()


def test_writing_makes_folders_replaces_the_old_page_and_leaves_nothing_beside_it(tmp_path):
    target = tmp_path / "new" / "folder" / "page.html"
    everything("first").write(target)
    assert everything("second").write(target) == target
    assert "second" in target.read_text("utf-8")
    assert [path.name for path in target.parent.iterdir()] == ["page.html"]


def test_a_place_that_cannot_be_written_to_is_named_and_stays_as_it_was(tmp_path):
    (tmp_path / "file").write_text("in the way")
    with pytest.raises(InvalidInput, match=r"page\.html: cannot be written \(.+\); choose"):
        everything("word").write(tmp_path / "file" / "page.html")
    (tmp_path / "taken.html").mkdir()
    with pytest.raises(InvalidInput, match=r"taken\.html: cannot be written"):
        everything("word").write(tmp_path / "taken.html")
    assert sorted(path.name for path in tmp_path.iterdir()) == ["file", "taken.html"]


def test_a_table_row_with_a_missing_cell_is_refused():
    with pytest.raises(InvalidInput, match="1 cells for 2 columns"):
        Table(["a", "b"], [["only one"]])


def test_the_calibration_page_judges_held_out_rows_when_there_are_any():
    result = ur_run()
    assert result.held_out is not None
    before = ErrorSummary.of(result.held_out.before).mean * 1e3
    after = ErrorSummary.of(result.held_out.after).mean * 1e3
    page = calibration_page(result)
    assert page.headline.replace("\N{NO-BREAK SPACE}", " ") == (
        f"The hand now lands {after:.2f} mm from where the eye sees it; it was {before:.2f} mm."
    )
    html = page.html()
    assert "498 observations held out" in html
    assert f"{1e3 * result.summary()['online']['rms']:.3f}" in html
    for stage in ("Held-out rows, after learning", "All rows, with learning"):
        assert stage in html


def test_without_held_out_rows_the_last_third_is_judged():
    page = calibration_page(planar_run())
    assert "last third of the run" in page.html()
    assert "Held-out rows" not in page.html()


@pytest.mark.parametrize(
    ("factor", "start"),
    [
        (0.4, "The hand now lands"),
        (1.0, "Learning changed little"),
        (1.5, "Learning did not help here"),
    ],
)
def test_the_headline_is_honest(factor, start):
    result = planar_run(60)
    page = calibration_page(replace(result, online=factor * result.before))
    assert page.headline.startswith(start)


def test_rejected_rows_are_listed_and_a_long_list_is_folded():
    few = calibration_page(ur_run(n=30, rejected=["log.csv row 7: NaN"])).html()
    assert "1 row was rejected" in few
    assert "log.csv row 7: NaN" in few
    assert "<details" not in few
    assert "<details" in calibration_page(ur_run(n=30, rejected=["row"] * 30)).html()
    assert "Rejected rows" not in calibration_page(ur_run(n=30)).html()


@pytest.mark.parametrize("n", [1, 2, 3])
def test_a_very_short_run_has_a_page(n):
    assert "<svg" in calibration_page(planar_run(n)).html()


def test_a_run_that_cannot_be_reported_is_refused():
    with pytest.raises(InvalidInput, match="errors before learning is empty"):
        calibration_page(planar_run(0))
    broken = planar_run(10)
    broken.online[3, 0] = np.nan
    with pytest.raises(InvalidInput, match="errors while learning must be finite"):
        calibration_page(broken)


def test_the_demo_page_tells_the_measured_story():
    run = demo_run()
    page = demo_page(run, settings={"seed": "0"})
    first, learned, _, _ = (f"{100 * mean:.1f}" for mean in run.means)
    headline = page.headline.replace("\N{NO-BREAK SPACE}", " ")
    assert f"{learned} cm off instead of {first} cm" in headline
    assert "Bent by 2 degrees, it learned again" in headline
    assert run.means[2] == run.corrected[run.trials == 5000][1]


def test_a_robot_that_did_not_learn_is_not_said_to_have_learned():
    run = demo_run()
    flat = replace(run, corrected=run.uncorrected)
    assert "learned" not in demo_page(flat, settings={}).headline


def test_a_bend_that_helps_by_chance_is_explained():
    run = demo_run()
    assert "happens to cancel" not in demo_page(run, settings={}).html()
    lucky = replace(run, uncorrected=run.uncorrected[::-1])
    assert "happens to cancel" in demo_page(lucky, settings={}).html()


def test_the_still_is_a_small_picture_twice_as_wide_as_high():
    image = png(demo_still(demo_run()))
    width, height = (int.from_bytes(image[i : i + 4], "big") for i in (16, 20))
    assert (width, height) == (1200, 600)
    assert len(image) < 200_000


@pytest.mark.parametrize(
    ("change", "complaint"),
    [
        ({"trials": np.zeros(0)}, "trials is empty"),
        ({"network": np.zeros(3)}, "network must have shape"),
        ({"corrected": np.full(52, np.nan)}, "corrected must be finite"),
        ({"bend_trial": 1}, "trial of the bend"),
    ],
)
def test_a_demonstration_that_does_not_fit_together_is_refused(change, complaint):
    with pytest.raises(InvalidInput, match=complaint):
        replace(demo_run(), **change)
