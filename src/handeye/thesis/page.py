"""The page of a reproduction: every claim with its verdict, and every figure."""

from collections.abc import Sequence

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
    Tone,
)
from handeye.thesis.claims import claims_by_id
from handeye.thesis.comparison import CAPTION, comparison_table
from handeye.thesis.figures import FIGURES, TOPICS, Drawn, NotDrawn, drawable
from handeye.thesis.judge import Row
from handeye.thesis.manifest import Manifest
from handeye.thesis.records import Records
from handeye.thesis.reproduce import Selection
from handeye.thesis.storage import Stored, digest
from handeye.thesis.wording import measured_text, sentence, stated_text, tally

TITLE = "Robotic Hand-Eye Motor Learning (Ruoff 1993), chapter 3, reproduced"
_TONES: dict[str, Tone] = {"reproduced": "good", "not reproduced": "bad"}


def reproduction_page(
    rows: Sequence[Row], stored: Stored, chosen: Selection, *, date: str = ""
) -> Page:
    """Headline, claims, figures, the comparison and how it was run, from records only."""
    records, manifest = stored
    figures = figures_of(chosen, manifest)
    sections = [
        Section("", [_tiles(rows, manifest), *_caution(manifest)]),
        Section("Claims", [_claims(rows), *_notes(rows)]) if rows else None,
        *(_topic(name, topic, figures, records) for name, topic in TOPICS.items()),
        _comparison(records)
        if chosen.figures is None and "comparison" in manifest.experiments
        else None,
        _not_drawn() if chosen.figures is None else None,
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
    """How many claims are reproduced."""
    counts, n = tally(rows), len(rows)
    if not n:
        return "Figures of chapter 3, drawn again"
    if counts["reproduced"] == n:
        return "The claim is reproduced" if n == 1 else f"All {n} claims are reproduced"
    return f"{counts['reproduced']} of {n} {'claim' if n == 1 else 'claims'} reproduced"


def figures_of(chosen: Selection, manifest: Manifest) -> list[Drawn]:
    """The figures of a selection that its records suffice for: named, or showing its claims."""
    possible = drawable(manifest.experiments)
    if chosen.figures is None:
        return possible
    claims = {claim.id for claim in chosen.claims}
    named = chosen.figures or [f.number for f in possible if not claims.isdisjoint(f.shows)]
    return [figure for figure in possible if figure.number in named]


def claim_cells(row: Row) -> tuple[str, str, str, str]:
    """What is stated, where, the figure, and what was measured."""
    claim = claims_by_id()[row.id]
    return sentence(claim.says), claim.where, stated_text(row), measured_text(row)


def _tiles(rows: Sequence[Row], manifest: Manifest) -> StatTiles:
    counts = tally(rows)
    most = max((ran.replicates for ran in manifest.experiments.values()), default=1)
    tiles = [
        Tile("Reproduced", str(counts["reproduced"]), note=f"of {len(rows)} claims", tone="good"),
        Tile("Not reproduced", str(counts["not reproduced"]), note="what was tried stands below"),
        Tile("Replicates", str(most), note="intervals are 95 % of their mean"),
        Tile("Experiments", str(len(manifest.experiments)), note=_effort(manifest)),
    ]
    return StatTiles(tiles if rows else tiles[2:])


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


def _claims(rows: Sequence[Row]) -> Table:
    return Table(
        columns=("Claim", "Thesis", "Stated", "Measured", "Verdict"),
        rows=[
            [*claim_cells(row), Badge(row.verdict, _TONES.get(row.verdict, "neutral"))]
            for row in rows
        ],
        caption="± is the 95 % interval of the mean over replicates. Orderings and shapes hold or "
        "do not, in each replicate.",
        words=frozenset({0, 1}),
    )


def _notes(rows: Sequence[Row]) -> list[Notes]:
    """What there is to know about claims, those not reproduced first."""
    failed = [_note(row) for row in rows if row.note and row.verdict != "reproduced"]
    others = [_note(row) for row in rows if row.note and row.verdict == "reproduced"]
    notes = [
        Notes("Not reproduced: what was found and tried", failed),
        Notes("Notes on the claims that are reproduced", others, folded=True),
    ]
    return [note for note in notes if note.items]


def _note(row: Row) -> str:
    claim = claims_by_id()[row.id]
    return f"{sentence(claim.says)} ({claim.where}; {row.id}). {row.note}"


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


def _head(method: str, moment: str) -> str:
    return f"{method}, {f'trial {moment}' if moment.isdigit() else moment}" if moment else method


def _not_drawn() -> Section:
    listed = [
        f"Figure {figure.number}. {figure.title}: {figure.reason.replace('`', '')}."
        for figure in FIGURES.values()
        if isinstance(figure, NotDrawn)
    ]
    return Section(
        "Figures that show no result", [Notes("Drawings and diagrams of chapter 3", listed)]
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
