"""The reproduction as a page of the documentation: Markdown, with a few small figures."""

import os
from collections.abc import Sequence
from pathlib import Path
from statistics import mode

from handeye.io.files import replace_file
from handeye.reports.style import color
from handeye.reports.svg import inline_svg
from handeye.thesis.comparison import comparison_markdown
from handeye.thesis.earlier import earlier_markdown
from handeye.thesis.figures import FIGURES, Drawn, NotDrawn, drawable
from handeye.thesis.judge import Row
from handeye.thesis.manifest import Manifest
from handeye.thesis.page import headline
from handeye.thesis.storage import Stored
from handeye.thesis.tables import claim_cells, later
from handeye.thesis.wording import TARGETS, apart, kept, sentence

SHOWN = (
    "3.10", "3.15", "3.21", "3.22", "3.31", "3.34", "3.37", "3.38", "3.40", "3.45", "3.51",
    "4.1", "4.7", "4.11", "4.12", "4.14", "4.16", "A.6", "A.7", "A.8",
    "6.1", "6.3", "6.4", "6.5", "6.6", "6.8", "6.9", "6.10", "6.11", "6.12", "6.13",
    "6.14",
)  # fmt: skip
"""Figures that the page shows; all others are on the page that the command writes."""

_PICTURES = "reproduction"
_AGAIN = """\
```sh
handeye reproduce
```

makes all of it again, with every figure of chapters 3 and 4, and writes one page,
`out/reproduction/index.html`. `handeye reproduce 3.22` makes one figure and judges the claims that
it shows.
"""


def write_docs(folder: str | os.PathLike[str], rows: Sequence[Row], stored: Stored) -> Path:
    """Write `reproduction.md` and its pictures into a folder, and return the page's path."""
    place, pictures = Path(folder), Path(folder) / _PICTURES
    shown = [figure for figure in drawable(stored.manifest.experiments) if figure.number in SHOWN]
    for figure in shown:
        drawn = inline_svg(figure.draw(stored.records), "figure", figure.title)
        replace_file(pictures / f"figure-{figure.number}.svg", _standing_alone(drawn).encode())
    page = place / "reproduction.md"
    replace_file(page, _markdown(rows, stored, shown).encode())
    return page


def _markdown(rows: Sequence[Row], stored: Stored, shown: Sequence[Drawn]) -> str:
    claims, targets = apart(rows)
    parts = [
        "# Reproduction\n",
        "<!-- Written by `handeye reproduce`; do not edit. -->\n",
        f"**{headline(rows)}** (chapters 3 and 4). {_how(stored.manifest)}\n",
        _AGAIN,
        "## Claims\n",
        _claims(claims),
        "## Not reproduced: what was found and tried\n",
        _failed(claims),
        f"## {TARGETS}\n",
        _targets(targets),
    ]
    if "comparison" in stored.manifest.experiments:
        parts += ["## Network or estimator?\n", comparison_markdown(stored.records)]
    if "earlier" in stored.manifest.experiments:
        parts += ["## Trials that learners need\n", earlier_markdown(stored.records)]
    parts.append("## Figures\n")
    parts += [_picture(figure) for figure in shown]
    return "\n".join([*parts, "## All figures\n", _all_figures()])


def _how(manifest: Manifest) -> str:
    trial = "" if manifest.effort == 1.0 else " This was a trial run: its verdicts mean nothing."
    versions = ", ".join(f"{name} {number}" for name, number in manifest.versions.items())
    return (
        f"{_replicates(manifest)} with other random numbers; ± is the 95 % interval of their "
        "mean. An "
        f"ordering or shape is checked in each replicate. {sentence(versions)}.{trial}"
    )


def _replicates(manifest: Manifest) -> str:
    """How many there are of most experiments, and of which more or fewer; one if none is random."""
    counts = {n: ran.replicates for n, ran in manifest.experiments.items() if not ran.deterministic}
    if not counts:
        return "1 replicate"
    usual = mode(counts.values())
    others = [f"{count} of {name}" for name, count in counts.items() if count != usual]
    return f"{usual} replicates" + (f" ({', '.join(others)})" if others else "")


def _claims(rows: Sequence[Row]) -> str:
    lines = [("Claim", "Thesis", "Stated", "Measured", "Verdict"), ("---",) * 5]
    lines += [(*claim_cells(row), _verdict(row)) for row in rows]
    return _table(lines)


def _targets(rows: Sequence[Row]) -> str:
    """What is aimed at, with a note on each, and what no experiment measures yet."""
    lines = [("Target", "Asked for", "Measured", "Verdict"), ("---",) * 4]
    for row in rows:
        said, _, asked, measured = claim_cells(row)
        lines.append((said, asked, measured, _verdict(row)))
    noted = "\n".join(f"- `{row.id}`: {row.note}" for row in rows if row.note)
    parts = [_table(lines) if rows else "", f"{noted}\n" if noted else "", later()]
    return "\n".join(part for part in parts if part) + "\n"


def _table(lines: Sequence[Sequence[str]]) -> str:
    cells = [[cell.replace("|", "\\|") for cell in line] for line in lines]
    return "\n".join(f"| {' | '.join(line)} |" for line in cells) + "\n"


def _verdict(row: Row) -> str:
    return row.verdict if kept(row) else f"**{row.verdict}**"


def _failed(rows: Sequence[Row]) -> str:
    lines = [f"- `{row.id}`: {claim_cells(row)[0]}. {row.note}" for row in rows if not kept(row)]
    return "\n".join(lines or ["None."]) + "\n"


def _picture(figure: Drawn) -> str:
    picture = f"{_PICTURES}/figure-{figure.number}.svg"
    return (
        f"![{figure.title}]({picture})\n\n*Figure {figure.number}. {figure.title}. "
        f"{figure.caption}*\n"
    )


def _all_figures() -> str:
    reasons = {
        f.number: f"not drawn: {f.reason}" for f in FIGURES.values() if isinstance(f, NotDrawn)
    }
    lines = [("Figure", "What it shows", ""), ("---",) * 3]
    lines += [(f.number, f.title, reasons.get(f.number, "")) for f in FIGURES.values()]
    return _table(lines)


def _standing_alone(svg: str) -> str:
    """An inline drawing as a file: with its namespace, on light ground."""
    return svg.replace("<svg ", '<svg xmlns="http://www.w3.org/2000/svg" ', 1).replace(
        'style="max-width', f'style="background: {color("card")}; max-width', 1
    )
