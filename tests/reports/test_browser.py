"""The pages in a real browser, on wide and narrow screens, in both colour schemes."""

import pytest
from tests.reports.made_up import demo_run, ur_run

from handeye.reports.calibration import calibration_page
from handeye.reports.demo import demo_page


@pytest.fixture(scope="module")
def pages(tmp_path_factory):
    """Both kinds of page on disk."""
    folder = tmp_path_factory.mktemp("pages")
    rejected = ["a_rather_long_name_without_any_space_in_it_" * 4 + ".csv row 7: <NaN>"] * 3
    calibration_page(ur_run(n=300, rejected=rejected)).write(folder / "calibration.html")
    demo_page(demo_run(), settings={"seed": "0"}).write(folder / "demo.html")
    return folder


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("width", [400, 1280])
@pytest.mark.parametrize("name", ["calibration", "demo"])
def test_a_page_works_offline_and_fits_the_screen(pages, watched_page, name, width, scheme):
    page = watched_page.page
    page.set_viewport_size({"width": width, "height": 900})
    page.emulate_media(color_scheme=scheme)
    page.goto((pages / f"{name}.html").as_uri())
    assert watched_page.problems == []
    assert page.evaluate("document.documentElement.scrollWidth") <= width
    drawings = page.locator("figure svg[role=img]")
    assert drawings.count() == {"calibration": 6, "demo": 2}[name]
    for drawing in drawings.all():
        assert drawing.is_visible()
        assert drawing.bounding_box()["height"] > 100
        assert drawing.get_attribute("aria-label")
    smallest = page.evaluate(
        """() => Math.min(...[...document.querySelectorAll('svg text')].map(t => {
            const {a, b} = t.getScreenCTM();  // turned text has its size in both
            return parseFloat(getComputedStyle(t).fontSize) * Math.hypot(a, b);
        }))"""
    )
    assert smallest > 8
    cut_off = page.evaluate(
        """() => [...document.querySelectorAll('figure svg')].flatMap(svg => {
            const frame = svg.getBoundingClientRect();
            return [...svg.querySelectorAll('text')].filter(text => {
                const box = text.getBoundingClientRect();
                return box.left < frame.left - 1 || box.right > frame.right + 1
                    || box.top < frame.top - 1 || box.bottom > frame.bottom + 1;
            }).map(text => text.textContent);
        })"""
    )
    assert cut_off == []


def test_drawings_follow_the_colour_scheme(pages, watched_page):
    page = watched_page.page
    page.goto((pages / "demo.html").as_uri())
    colours = {}
    for scheme in ("light", "dark"):
        page.emulate_media(color_scheme=scheme)
        colours[scheme] = page.evaluate(
            "() => ['svg text', 'body'].map(s => getComputedStyle(document.querySelector(s)))"
            ".map((style, i) => i ? style.backgroundColor : style.fill)"
        )
    assert colours["light"][0] != colours["dark"][0]
    assert colours["light"][1] != colours["dark"][1]


def test_a_printed_page_is_on_white_even_for_readers_of_dark_screens(pages, watched_page):
    page = watched_page.page
    page.emulate_media(media="print", color_scheme="dark")
    page.goto((pages / "demo.html").as_uri())
    ink, ground, scheme = page.evaluate(
        "() => [getComputedStyle(document.body).color, getComputedStyle(document.body)"
        ".backgroundColor, getComputedStyle(document.documentElement).colorScheme]"
    )
    assert sum(int(part) for part in ink[4:-1].split(",")) < 200
    assert (ground, scheme) == ("rgb(255, 255, 255)", "light")
