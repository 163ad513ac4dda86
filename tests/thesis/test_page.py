import re
from dataclasses import replace
from pathlib import Path
from xml.etree import ElementTree

import pytest

from handeye.errors import InvalidInput
from handeye.thesis.claims import load_claims
from handeye.thesis.docs import SHOWN, write_docs
from handeye.thesis.experiments import EXPERIMENTS
from handeye.thesis.figures import FIGURES, Drawn, drawable
from handeye.thesis.judge import Row
from handeye.thesis.manifest import Manifest
from handeye.thesis.page import figures_of, headline, reproduction_page
from handeye.thesis.reproduce import choose, verdicts
from handeye.thesis.storage import Stored
from handeye.thesis.wording import measured_text, stated_text, tally

CAN_RUN = [name for name, experiment in EXPERIMENTS.items() if experiment.can_run]
N_DRAWN = len(drawable(CAN_RUN))


def row(verdict: str = "reproduced", **changes: object) -> Row:
    made = Row("preferred-200-noisy", 0.013, "m", 0.0128, 0.0126, 0.013, 20, "reproduced", "Why.")
    return replace(made, verdict=verdict, **changes)


@pytest.fixture(scope="module")
def whole(smoke_run: Stored, tmp_path_factory) -> Path:
    chosen = choose((), smoke_run)
    page = reproduction_page(verdicts(chosen.claims, smoke_run), smoke_run, chosen)
    return page.write(tmp_path_factory.mktemp("page") / "index.html")


def test_page_has_every_claim_and_every_figure(whole: Path):
    text = whole.read_text(encoding="utf-8")
    assert text.count("<figure>") == N_DRAWN
    for claim in load_claims():
        if claim.measure:
            assert claim.where in text
    for figure in FIGURES.values():
        assert f"Figure {figure.number}. {figure.title}" in text.replace("&#39;", "'")
    assert "Network or estimator?" in text
    assert "mean nothing" in text, "a trial run must not pass for a real one"


def test_page_works_offline_in_a_browser(whole: Path, watched_page):
    page = watched_page.page
    for width in (1280, 400):
        page.set_viewport_size({"width": width, "height": 900})
        page.goto(whole.as_uri())
        assert watched_page.problems == []
        assert page.evaluate("document.documentElement.scrollWidth") <= width
    assert page.locator("figure svg[role=img]").count() == N_DRAWN
    cut_off = page.evaluate(
        """() => [...document.querySelectorAll('figure svg')].flatMap(svg => {
            const frame = svg.getBoundingClientRect();
            return [...svg.querySelectorAll('text')].filter(text => {
                const box = text.getBoundingClientRect();
                return box.left < frame.left - 1 || box.right > frame.right + 1;
            }).map(text => text.textContent);
        })"""
    )
    assert cut_off == []


def test_page_is_the_same_each_time(smoke_run: Stored):
    chosen = choose(["figure-3.28"], smoke_run)
    rows = verdicts(chosen.claims, smoke_run)
    first, again = (reproduction_page(rows, smoke_run, chosen).html() for _ in range(2))
    assert first == again


def test_a_figure_comes_with_the_claims_that_it_shows(smoke_run: Stored):
    chosen = choose(["3.28"], smoke_run)
    assert [claim.id for claim in chosen.claims] == ["plant-noise-floor"]
    assert chosen.experiments == ("noise-floor",)
    assert [f.number for f in figures_of(chosen, smoke_run.manifest)] == ["3.28"]


def test_a_claim_comes_with_the_figures_that_show_it(smoke_run: Stored):
    chosen = choose(["preferred-200-noisy"], smoke_run)
    assert [f.number for f in figures_of(chosen, smoke_run.manifest)] == ["3.22", "3.32"]


def test_a_figure_without_claims_is_drawn_alone(smoke_run: Stored):
    chosen = choose(["fig 3.47"], smoke_run)
    assert chosen.claims == []
    text = reproduction_page([], smoke_run, chosen).html()
    assert text.count("<figure>") == 1
    assert "drawn again" in text


def test_figures_and_claims_can_be_named_together():
    chosen = choose(["3.8", "preferred-200-noisy"])
    assert [claim.id for claim in chosen.claims] == [
        "plant-perturbation-size", "preferred-200-noisy",
    ]  # fmt: skip
    assert chosen.experiments == ("perturbations", "distortions", "preferred")


def part_of(stored: Stored, *names: str) -> Stored:
    kept = {name: stored.manifest.experiments[name] for name in names}
    return Stored(stored.records, replace(stored.manifest, experiments=kept))


def test_records_of_a_part_give_what_they_suffice_for(smoke_run: Stored):
    part = part_of(smoke_run, "preferred")
    chosen = choose((), part)
    assert {claim.experiments for claim in chosen.claims} == {("preferred",)}
    assert "3.22" in [figure.number for figure in figures_of(chosen, part.manifest)]


def test_records_that_lack_what_a_claim_needs_say_so(smoke_run: Stored):
    part = part_of(smoke_run, "preferred")
    with pytest.raises(InvalidInput, match="hold nothing of uncorrected, which plant-uncorrected"):
        verdicts(choose(["plant-uncorrected"], part).claims, part)


def test_headlines():
    assert headline([row()] * 3) == "All 3 claims are reproduced"
    assert headline([row()]) == "The claim is reproduced"
    assert headline([row(), row("not reproduced")]) == "1 of 2 claims reproduced"
    assert headline([row("not testable")]) == "0 of 1 claim reproduced"
    assert tally([row(), row("not testable")]) == {
        "reproduced": 1, "not reproduced": 0, "met": 0, "not met": 0, "not testable": 1,
        "not run": 0,
    }  # fmt: skip


def target(verdict: str = "met", **changes: object) -> Row:
    return row(verdict, id="catch-improved", stated=0.99, unit="fraction", measured=0.992, low=0.99,
               high=0.994, **changes)  # fmt: skip


def test_targets_are_counted_by_themselves():
    assert headline([target()]) == "The target is met"
    assert headline([row(), row(), target()]) == "All 2 claims are reproduced, the target is met"
    assert headline([row(), target(), target("not met")]) == (
        "The claim is reproduced, 1 of 2 targets met"
    )


def test_what_a_target_asks_for_has_its_direction():
    assert stated_text(target()) == "at least 99 %"
    asked = {"combined-normal-noisy-50": 1.06, "combined-calibrated-uncertainty": 1.0}
    texts = [stated_text(replace(target(), id=i, stated=v, unit="ratio")) for i, v in asked.items()]
    assert texts == ["at most 1.06", "within 15 % of 1"]


def test_rows_in_words():
    assert (stated_text(row()), measured_text(row())) == ("1.3 cm", "1.28 ± 0.02 cm")
    share = row(stated=None, unit="fraction of replicates", measured=0.75)
    assert (stated_text(share), measured_text(share)) == ("-", "holds in 15 of 20")
    once = row(stated=None, unit="fraction of replicates", measured=0.0, replicates=1)
    assert measured_text(once) == "does not hold"
    assert measured_text(row(measured=None)) == "-"


def test_page_of_the_documentation(smoke_run: Stored, tmp_path: Path):
    rows = verdicts(choose((), smoke_run).claims, smoke_run)
    page = write_docs(tmp_path, rows, smoke_run)
    text = page.read_text(encoding="utf-8")
    for made in rows:
        assert made.verdict in text
    assert r"\|beta\|" in text, "a bar in a cell would end it"
    pictures = re.findall(r"!\[[^]]+\]\(([^)]+)\)", text)
    assert len(pictures) == sum(figure.number in SHOWN for figure in drawable(CAN_RUN))
    for picture in pictures:
        root = ElementTree.parse(tmp_path / picture).getroot()
        assert root.tag == "{http://www.w3.org/2000/svg}svg"
        assert "background" in root.attrib["style"]
    for figure in FIGURES:
        assert f"| {figure} |" in text


def test_shown_figures_are_drawn_ones():
    assert all(isinstance(FIGURES[number], Drawn) for number in SHOWN)


def test_full_runs_are_not_called_trial_runs(smoke_run: Stored):
    manifest = replace(smoke_run.manifest, effort=1.0, replicates=5)
    assert isinstance(manifest, Manifest)
    stored = Stored(smoke_run.records, manifest)
    text = reproduction_page([row("not reproduced")], stored, choose(["3.28"], stored)).html()
    assert "mean nothing" not in text
    assert "handeye reproduce --replicates 5" in text
    assert "what was found and tried" in text
