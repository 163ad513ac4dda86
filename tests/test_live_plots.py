"""The live plots of the documentation: the same networks as the package's, and pages that work."""

import re
from pathlib import Path

import numpy as np
import pytest
from playwright.sync_api import Page

from handeye.networks import Constant, InputSpace, ResourceAllocatingNetwork
from handeye.networks.layered import LayeredNetwork
from handeye.networks.memories import AlbusCMAC, HopfieldMemory

ROOT = Path(__file__).resolve().parents[1]
LIVE = ROOT / "docs" / "live"
PAGE = ROOT / "docs" / "theory" / "networks-as-functions.md"
UNIT = InputSpace.box([-1.0], [1.0])


def scripts() -> list[str]:
    """In the order in which the site loads them."""
    return re.findall(r"^  - (live/\S+\.js)$", (ROOT / "mkdocs.yml").read_text(), re.MULTILINE)


@pytest.fixture
def live(watched_page):
    """A page with the boxes of the documentation's page in it."""
    boxes = re.findall(r"<div data-live=.*?</div>", PAGE.read_text(encoding="utf-8"))
    watched_page.page.set_content(f"<!doctype html><title>live</title>{''.join(boxes)}")
    watched_page.page.add_style_tag(path=LIVE / "live.css")
    for script in scripts():
        watched_page.page.add_script_tag(path=ROOT / "docs" / script)
    yield watched_page.page
    assert watched_page.problems == []


def learned(page: Page, network: str, x, y) -> tuple[list[float], list[float]]:
    """Errors before each sample, and answers afterwards, of a network made by JavaScript."""
    return page.evaluate(
        f"""([x, y]) => {{
            const network = {network};
            const errors = x.map((v, i) => network.learn(v, y[i]));
            return [errors, x.map((v) => network.predict(v))];
        }}""",
        [x.tolist(), y.tolist()],
    )


def test_the_networks_of_the_page_learn_as_those_of_the_package(live):
    rng = np.random.default_rng(0)
    x = rng.uniform(-1.0, 1.0, 200)
    y = np.sin(3.0 * x) + 0.1 * rng.normal(size=200)
    layered = LayeredNetwork(1, 1, hidden=(12,), rate=0.03, largest_weight=2.0, rng=rng)
    hidden, out = (block.tolist() for block in layered.weights)
    pairs = {
        "new handeyeNetworks.Allocating()": ResourceAllocatingNetwork(
            1, 1, inputs=UNIT, schedule=Constant(0.1)
        ),
        "new handeyeNetworks.Table()": AlbusCMAC(1, 1, inputs=UNIT, field=0.4, layers=8, rate=0.5),
        f"new handeyeNetworks.Layered({hidden}, {out[0]})": layered,
    }
    for made, network in pairs.items():
        errors, answers = learned(live, made, x, y)
        ours = network.learn_many(x[:, np.newaxis], y[:, np.newaxis]).error[:, 0]
        np.testing.assert_allclose(errors, ours, atol=1e-9, err_msg=made)
        after = network.predict_many(x[:, np.newaxis])[:, 0]
        np.testing.assert_allclose(answers, after, atol=1e-9, err_msg=made)


def test_the_memory_of_the_page_is_the_one_of_the_package(live):
    rng = np.random.default_rng(1)
    patterns = rng.choice([-1.0, 1.0], (2, 30))
    state = patterns[0].copy()
    state[:5] *= -1.0
    memory = HopfieldMemory(30)
    memory.store(patterns)
    before, changed, after, energy = live.evaluate(
        """([patterns, state]) => {
            const memory = new handeyeNetworks.Memory(patterns);
            const before = memory.energy(state);
            const changed = memory.sweep(state, state.map((_, i) => i));
            return [before, changed, state, memory.energy(state)];
        }""",
        [patterns.tolist(), state.tolist()],
    )
    assert before == pytest.approx(memory.energy(state))
    assert energy == pytest.approx(memory.energy(after))
    assert energy < before
    assert changed == 5
    np.testing.assert_array_equal(after, patterns[0])


def test_sliders_move_the_pair_and_say_how_near_it_is_to_a_sinusoid(live):
    box = live.locator("[data-live=sigmoids]")
    said = box.locator(".said")
    assert "at most 0.17" in said.inner_text()  # 2 - 2 tanh(pi / 2), at the top
    drawn = box.locator("path.main").get_attribute("d")
    box.get_by_label("gain").fill("8")
    assert box.locator("path.main").get_attribute("d") != drawn
    assert "at most 0.17" not in said.inner_text()


@pytest.mark.parametrize("kind", ["Neurons in layers", "Gaussian neurons", "Albus's table"])
def test_a_click_teaches_a_sample_and_only_layers_change_far_away(live, kind):
    box = live.locator("[data-live=teaching]")
    box.get_by_label(kind).check()
    before = box.locator("path.main").get_attribute("d")
    picture = box.locator("svg").bounding_box()
    assert picture is not None
    box.locator("svg").click(position={"x": 0.5 * picture["width"], "y": 0.2 * picture["height"]})
    assert box.locator("circle").count() == 1
    assert box.locator("path.main").get_attribute("d") != before
    assert box.locator("path.other").get_attribute("d") == before
    found = re.search(r"changed by up to ([0-9.]+)", box.locator(".said").inner_text())
    assert found is not None
    far = float(found[1].rstrip("."))
    assert far > 0.01 if kind == "Neurons in layers" else far < 0.005
    box.get_by_role("button", name="Begin anew").click()
    assert box.locator("circle").count() == 0


def test_without_a_pointer_a_sample_is_chosen_by_sliders_and_taught_by_a_button(live):
    box = live.locator("[data-live=teaching]")
    box.get_by_label("input").fill("-0.5")
    box.get_by_label("target").fill("0.5")
    box.get_by_role("button", name="Teach").press("Enter")
    first = box.locator(".said").inner_text()
    found = re.search(r"The error was ([0-9.]+) before", first)
    assert found is not None
    assert float(found[1]) == pytest.approx(1.5, abs=0.1)  # the sine is -1 there
    box.get_by_role("button", name="All of them ten times").click()
    assert box.locator(".said").inner_text() != first


def test_every_picture_is_remembered_when_it_is_damaged(live):
    box = live.locator("[data-live=memory]")
    for picture in (1, 2, 3):
        box.get_by_role("button", name=f"Picture {picture}").click()
        box.get_by_role("button", name="Recall").click()
        assert "after 0 changes" in box.locator(".said").inner_text()
        box.get_by_role("button", name="Damage").click()
        assert "none of the pictures" in box.locator(".said").inner_text()
        box.get_by_role("button", name="Recall").click()
        assert f"It is picture {picture}." in box.locator(".said").inner_text()
