"""The page of a reproduction: every claim with its verdict, and every figure."""

from collections.abc import Sequence

from handeye.reports.page import (
    FigureBlock,
    Notes,
    Page,
    Prose,
    Section,
    StatTiles,
    Table,
    Tile,
)
from handeye.thesis.comparison import CAPTION, comparison_table
from handeye.thesis.earlier import CAPTION as EARLIER_CAPTION
from handeye.thesis.earlier import earlier_table
from handeye.thesis.figures import FIGURES, TOPICS, Drawn, NotDrawn, drawable
from handeye.thesis.judge import Row
from handeye.thesis.manifest import Manifest
from handeye.thesis.records import Records
from handeye.thesis.reproduce import Selection
from handeye.thesis.storage import Stored, digest
from handeye.thesis.tables import claims_table, notes_on, targets_blocks
from handeye.thesis.wording import (
    TARGETS,
    apart,
    kept,
    sentence,
    tally,
)

TITLE = "Robotic Hand-Eye Motor Learning (Ruoff 1993), chapters 3 and 4, reproduced"


def reproduction_page(
    rows: Sequence[Row], stored: Stored, chosen: Selection, *, date: str = ""
) -> Page:
    """Headline, claims, targets, figures, the comparison and how it was run, from records only."""
    records, manifest = stored
    figures = figures_of(chosen, manifest)
    claims, targets = apart(rows)
    whole = chosen.figures is None
    sections = [
        Section("", [_tiles(rows, manifest), *_caution(manifest)]),
        Section("Claims", [claims_table(claims), *notes_on(claims)]) if claims else None,
        Section(TARGETS, targets_blocks(targets, whole=whole)) if targets else None,
        *(_topic(name, topic, figures, records) for name, topic in TOPICS.items()),
        _comparison(records) if whole and "comparison" in manifest.experiments else None,
        _earlier(records) if whole and "earlier" in manifest.experiments else None,
        _not_drawn() if whole else None,
    ]
    return Page(
        title=TITLE,
        headline=headline(rows),
        subtitle="Every claim is measured again in simulation, over replicates with other random "
        "numbers, and judged by the rule and tolerance stored with it. Where the text says "
        '"about", the limit is ours, set after a look at two or three replicates unless a note '
        "says otherwise. Diamonds, and lines that say so, are what the thesis states.",
        sections=[section for section in sections if section is not None],
        settings=_settings(records, manifest),
        date=date,
    )


def headline(rows: Sequence[Row]) -> str:
    """How many claims are reproduced, and how many targets met."""
    claims, targets = apart(rows)
    parts = [
        _how_many(claims, "claim", "reproduced") if claims else "",
        _how_many(targets, "target", "met") if targets else "",
    ]
    said = ", ".join(part[0].lower() + part[1:] for part in parts if part)
    return sentence(said) or "Figures of the thesis, drawn again"


def _how_many(rows: Sequence[Row], noun: str, verdict: str) -> str:
    n, good = len(rows), sum(map(kept, rows))
    if good == n:
        return f"The {noun} is {verdict}" if n == 1 else f"All {n} {noun}s are {verdict}"
    return f"{good} of {n} {noun if n == 1 else noun + 's'} {verdict}"


def figures_of(chosen: Selection, manifest: Manifest) -> list[Drawn]:
    """The figures of a selection that its records suffice for: named, or showing its claims."""
    possible = drawable(manifest.experiments)
    if chosen.figures is None:
        return possible
    claims = {claim.id for claim in chosen.claims}
    named = chosen.figures or [f.number for f in possible if not claims.isdisjoint(f.shows)]
    return [figure for figure in possible if figure.number in named]


def _tiles(rows: Sequence[Row], manifest: Manifest) -> StatTiles:
    claims, targets = apart(rows)
    counts = tally(rows)
    most = max((ran.replicates for ran in manifest.experiments.values()), default=1)
    tiles = [
        Tile("Reproduced", str(counts["reproduced"]), note=f"of {len(claims)} claims", tone="good"),
        Tile("Not reproduced", str(counts["not reproduced"]), note="what was tried stands below"),
    ]
    if targets:
        tiles.append(
            Tile("Targets met", str(counts["met"]), note=f"of {len(targets)} beyond the thesis")
        )
    run = [
        Tile("Replicates", str(most), note="intervals are 95 % of their mean"),
        Tile("Experiments", str(len(manifest.experiments)), note=_effort(manifest)),
    ]
    return StatTiles([*tiles, *run] if rows else run)


def _effort(manifest: Manifest) -> str:
    return "run in full" if manifest.effort == 1.0 else f"{manifest.effort:.0%} of the trials"


def _caution(manifest: Manifest) -> list[Prose]:
    if manifest.effort == 1.0:
        return []
    return [
        Prose(
            f"This was a trial run with {manifest.effort:.0%} of the trials: its verdicts mean "
            "nothing."
        )
    ]


def _topic(
    name: str, topic: Sequence[Drawn], figures: Sequence[Drawn], records: Records
) -> Section | None:
    blocks = [
        FigureBlock(
            figure.draw(records),
            f"Figure {figure.number}. {figure.title}. {figure.caption}",
            f"Figure {figure.number}: {figure.title}",
        )
        for figure in topic
        if figure in figures
    ]
    return Section(name, blocks) if blocks else None


def _comparison(records: Records) -> Section:
    """One table for networks and one for estimators, so that both fit a page."""
    table = comparison_table(records)

    def part(*first: str) -> Table:
        picked = [i for i, (method, _) in enumerate(table.columns) if method.startswith(first)]
        heads = [_head(*table.columns[i]) for i in picked]
        rows = [[sentence(name), *(cells[i] for i in picked)] for name, cells in table.rows]
        return Table(("Scenario", *heads), rows)

    network, estimator = part("Uncorrected", "Network"), part("Estimator")
    return Section("Network or estimator?", [Prose(CAPTION), network, estimator])


def _earlier(records: Records) -> Section:
    heads, rows = earlier_table(records)
    return Section("Trials that learners need", [Prose(EARLIER_CAPTION), Table(heads, rows)])


def _head(method: str, moment: str) -> str:
    return f"{method}, {f'trial {moment}' if moment.isdigit() else moment}" if moment else method


def _not_drawn() -> Section:
    listed = [
        f"Figure {figure.number}. {figure.title}: {figure.reason.replace('`', '')}."
        for figure in FIGURES.values()
        if isinstance(figure, NotDrawn)
    ]
    return Section(
        "Figures that show no result", [Notes("Drawings and diagrams of the thesis", listed)]
    )


def _settings(records: Records, manifest: Manifest) -> dict[str, str]:
    return {
        "Command": _command(manifest),
        "Versions": ", ".join(f"{name} {number}" for name, number in manifest.versions.items()),
        "Random numbers": manifest.streams,
        "Effort": _effort(manifest),
        "Experiments": ", ".join(
            f"{name} ({ran.replicates} x {len(ran.settings)})"
            for name, ran in manifest.experiments.items()
        ),
        "Records": f"{len(records.rows):,}, SHA-256 {digest(records)[:16]}…; settings in full in "
        "manifest.json beside this page",
    }


def _command(manifest: Manifest) -> str:
    asked = "" if manifest.replicates is None else f" --replicates {manifest.replicates}"
    return f"handeye reproduce{asked}"
