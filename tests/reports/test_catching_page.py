"""The page and the animation of catching: true to the numbers, small, and for every reader."""

from dataclasses import replace

import pytest
from tests.reports.made_up_catching import LAYOUT, made_up_recording, made_up_result
from tests.reports.test_pages import Outline

from handeye.catching.results import Mark, Score, Take
from handeye.reports.animation import catching_animation
from handeye.reports.catching import catching_page, moving_takes
from handeye.reports.figures.catching_parts import percent

SMALLEST = """() => Math.min(...[...document.querySelectorAll('svg text')].map(t =>
    parseFloat(getComputedStyle(t).fontSize) * t.getScreenCTM().a).filter(s => s > 0))"""
CUT_OFF = """() => [...document.querySelectorAll('figure svg')].flatMap(svg => {
    const frame = svg.getBoundingClientRect();
    return [...svg.querySelectorAll('text')].filter(text => {
        const box = text.getBoundingClientRect();
        return box.left < frame.left - 1 || box.right > frame.right + 1
            || box.top < frame.top - 1 || box.bottom > frame.bottom + 1;
    }).map(text => text.textContent);
})"""
NBSP = "\N{NO-BREAK SPACE}"
RESULT = made_up_result(40)
TAKES = [Take(title, made_up_recording(2, skill)) for title, skill in (("10", 0.0), ("all", 1.0))]


@pytest.fixture(scope="module")
def animation():
    return catching_animation(TAKES, LAYOUT)


@pytest.fixture(scope="module")
def page(animation):
    return catching_page(RESULT, animation, layout=LAYOUT)


@pytest.fixture(scope="module")
def html(page):
    return page.html()


@pytest.fixture(scope="module")
def written(html, tmp_path_factory):
    target = tmp_path_factory.mktemp("catching") / "catch.html"
    target.write_text(html, encoding="utf-8")
    return target.as_uri()


def test_the_page_says_what_was_measured(page, html):
    caught = int(RESULT.test.caught.sum())
    assert page.headline == (
        f"The robot learned to catch: it catches {caught} of 40 throws; before practice it caught "
        "0 of 200."
    )
    texts = " ".join(Outline(html).texts)
    for score in RESULT.scores:
        assert score.name in texts
        assert f"{score.caught} of {score.n}" in texts
        assert " to ".join(map(percent, score.interval)) in texts
    assert "motor command, heavy arm" in texts
    assert "4,300" in texts
    assert "improved" in texts


def test_the_page_is_the_same_every_time_and_asks_nothing_from_the_network(html, animation):
    assert html == catching_page(RESULT, animation, layout=LAYOUT).html()
    assert "https://" not in html
    outline = Outline(html)
    assert len(outline.ids) == len(set(outline.ids)) > 0
    assert outline.tags.count("img") == 1
    assert outline.tags.count("source") == 2
    assert html.count("data:image/gif;base64,") == 2


def test_a_robot_that_was_not_seen_before_practice_or_does_no_better_is_not_praised(animation):
    def headline(marks):
        return catching_page(replace(RESULT, marks=marks), animation, layout=LAYOUT).headline

    assert "learned" not in headline([])
    assert "learned" not in headline(RESULT.marks[2:])
    perfect = Mark(0, 0, (Score(0, 0, 10, 10, 0.0),))
    assert "practice has not helped" in headline([perfect])


def test_a_mentor_is_named_only_where_one_advised(animation):
    alone = replace(RESULT, marks=[mark for mark in RESULT.marks if not mark.mentored])
    for result, advised in ((RESULT, True), (alone, False)):
        subtitle = catching_page(result, animation, layout=LAYOUT).subtitle
        assert ("mentor" in subtitle) == advised


def test_without_training_there_is_no_early_and_late(animation):
    result = replace(RESULT, marks=RESULT.marks[:1], takes=RESULT.takes[-1:])
    headings = [
        section.heading for section in catching_page(result, animation, layout=LAYOUT).sections
    ]
    assert "Early and late" not in headings
    assert "In numbers" in headings


def test_the_animation_leaves_out_the_arm_that_cannot_move_yet():
    still = replace(RESULT.takes[0].recording, voltage=0.0 * RESULT.takes[0].recording.voltage)
    takes = [Take("nothing", still), *RESULT.takes[1:]]
    titles = [take.title for take in moving_takes(replace(RESULT, takes=takes))]
    assert titles == ["10 pursuits", "100 pursuits", "300 pursuits"]
    only = replace(RESULT, takes=takes[:1])
    assert [take.title for take in moving_takes(only)] == ["nothing"]


@pytest.mark.parametrize(
    ("share", "words"),
    [(0.0, "0 %"), (1.0, "100 %"), (0.995, "99.5 %"), (0.9996, "99.96 %"), (0.5, "50 %"),
     (0.0004, "0.04 %"), (0.99999, "more than 99.99 %"), (1e-6, "less than 0.01 %")],
)  # fmt: skip
def test_only_what_is_exactly_so_is_called_all_or_nothing(share, words):
    assert percent(share) == words[:-2] + NBSP + "%"


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("width", [400, 1280])
def test_the_page_of_catching_fits_the_screen(page, written, watched_page, width, scheme):
    browser = watched_page.page
    browser.set_viewport_size({"width": width, "height": 900})
    browser.emulate_media(color_scheme=scheme)
    browser.goto(written)
    assert watched_page.problems == []
    assert browser.evaluate("document.documentElement.scrollWidth") <= width
    assert browser.locator("figure svg[role=img]").count() == 7
    assert browser.evaluate(CUT_OFF) == []
    assert browser.evaluate(SMALLEST) > 8
    shown = browser.evaluate(
        "() => { const i = document.querySelector('img'); return [i.currentSrc, i.naturalWidth]; }"
    )
    assert shown[0] == dict(zip(("light", "dark"), _urls(page), strict=True))[scheme]
    assert shown[1] > 0


def test_readers_who_want_no_motion_get_a_still(written, watched_page):
    browser = watched_page.page
    browser.emulate_media(reduced_motion="reduce", color_scheme="dark")
    browser.goto(written)
    source = browser.evaluate("document.querySelector('img').currentSrc")
    assert source.startswith("data:image/png")


def _urls(page):
    block = page.sections[0].blocks[1]
    return block.urls["light"], block.urls["dark"]
