"""Verdicts as tables and notes of a page."""

from collections.abc import Sequence

from handeye.reports.page import Badge, Notes, Prose, Table, Tone
from handeye.thesis.claims import claims_by_id, load_targets
from handeye.thesis.judge import Row
from handeye.thesis.wording import apart, kept, measured_text, sentence, stated_text

_TONES: dict[str, Tone] = {
    "reproduced": "good",
    "not reproduced": "bad",
    "met": "good",
    "not met": "bad",
}


def claim_cells(row: Row) -> tuple[str, str, str, str]:
    """What is stated, where, the figure, and what was measured."""
    claim = claims_by_id()[row.id]
    return sentence(claim.says), claim.where, stated_text(row), measured_text(row)


def claims_table(rows: Sequence[Row]) -> Table:
    """What the thesis states, what was measured, and the verdict."""
    return Table(
        columns=("Claim", "Thesis", "Stated", "Measured", "Verdict"),
        rows=[[*claim_cells(row), _badge(row)] for row in rows],
        caption="± is the 95 % interval of the mean over replicates. Orderings and shapes hold or "
        "do not, in each replicate.",
        words=frozenset({0, 1}),
    )


def targets_blocks(rows: Sequence[Row], *, whole: bool) -> list[Table | Notes | Prose]:
    """What is aimed at beyond the thesis; with everything that was run, also what comes later."""
    cells = [claim_cells(row) for row in rows]
    table = Table(
        columns=("Target", "Asked for", "Measured", "Verdict"),
        rows=[
            [said, asked, measured, _badge(row)]
            for row, (said, _, asked, measured) in zip(rows, cells, strict=True)
        ],
        caption="Where this package has to be better than the thesis. ± as above.",
    )
    open_ones = later() if whole else ""
    return [table, *notes_on(rows), *([Prose(open_ones)] if open_ones else [])]


def later() -> str:
    """Names the targets that no experiment measures yet; empty if there are none."""
    names = [target.id for target in load_targets() if target.measure is None]
    return f"No experiment yet for: {', '.join(names)}." if names else ""


def _badge(row: Row) -> Badge:
    return Badge(row.verdict, _TONES.get(row.verdict, "neutral"))


def notes_on(rows: Sequence[Row]) -> list[Notes]:
    """What there is to know about claims, those with a bad verdict first."""
    failed = [_note(row) for row in rows if row.note and not kept(row)]
    others = [_note(row) for row in rows if row.note and kept(row)]
    bad, good = (
        ("Not met", "targets that are met")
        if apart(rows)[1]
        else ("Not reproduced", "claims that are reproduced")
    )
    notes = [
        Notes(f"{bad}: what was found and tried", failed),
        Notes(f"Notes on the {good}", others, folded=True),
    ]
    return [note for note in notes if note.items]


def _note(row: Row) -> str:
    claim = claims_by_id()[row.id]
    where = "; ".join(part for part in (claim.where, row.id) if part)
    return f"{sentence(claim.says)} ({where}). {row.note}"
