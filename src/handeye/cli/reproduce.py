"""`handeye reproduce`: what the thesis states, measured again."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from time import monotonic
from typing import Annotated

import typer
from rich.console import Group, RenderableType
from rich.markup import escape
from rich.padding import Padding
from rich.text import Text

from handeye.cli.console import err, no_page, out, progress_bar, write_json
from handeye.errors import InvalidInput, MissingExtra
from handeye.thesis.claims import Claim, load_all
from handeye.thesis.judge import Row
from handeye.thesis.reproduce import Selection, choose, measure, verdicts
from handeye.thesis.storage import Stored, read_records, write_records
from handeye.thesis.wording import TARGETS, apart, measured_text, sentence, stated_text, tally

_GOOD, _BAD = "green", "bold red"
_STYLES = {"reproduced": _GOOD, "not reproduced": _BAD, "met": _GOOD, "not met": _BAD}
_STYLES["not testable"] = _STYLES["not run"] = "yellow"
_HEAD = ("claim", "stated", "measured", "verdict")
_TARGET_HEAD = ("target", "asked for", "measured", "verdict")
_WHOLE, _PART = Path("out/reproduction"), Path("out/reproduction-part")
_PAGE = "index.html"

Cells = tuple[str, str, str, str]


def reproduce(
    names: Annotated[
        list[str] | None,
        typer.Argument(
            metavar="CLAIM|FIGURE",
            help="Claims or targets (plant-uncorrected), beginnings of names (preferred), quoted "
            "patterns ('*-noisy'), or figures (3.22, figure-3.22). Without any, all that this "
            "version can measure and draw.",
            show_default=False,
        ),
    ] = None,
    replicates: Annotated[
        int | None,
        typer.Option(
            min=1, help="Repetitions with other random numbers; 20 by default, 10 for catching."
        ),
    ] = None,
    jobs: Annotated[
        int | None, typer.Option(min=1, help="Processes; one for each core by default.")
    ] = None,
    json_file: Annotated[
        str | None,
        typer.Option(
            "--json", metavar="FILE", help="Also write the rows as JSON; - prints only them."
        ),
    ] = None,
    folder: Annotated[
        Path | None,
        typer.Option(
            "--out",
            metavar="DIR",
            help=f"Folder for the records, their manifest and the page; by default {_WHOLE}, or "
            f"{_PART} for named claims and figures.",
            show_default=False,
        ),
    ] = None,
    records: Annotated[
        Path | None,
        typer.Option(
            metavar="DIR",
            help="Run nothing: judge and draw again from the records in this folder.",
            show_default=False,
        ),
    ] = None,
    docs: Annotated[
        Path | None,
        typer.Option(metavar="DIR", help="Also write the documentation's page.", hidden=True),
    ] = None,
) -> None:
    """Measure again what the thesis states, compare, and draw its figures.

    Each claim is measured in simulation over replicates, and judged by a rule that is part of its
    data. Targets beyond the thesis are judged in the same way and come in a table of their own.
    What was measured is stored; verdicts and a page with every figure are made from that. A
    verdict is a result like any other: the exit code is 0 whatever they are.
    """
    if json_file not in {None, "-"} and Path(str(json_file)).is_dir():
        raise InvalidInput(f"{json_file} is a folder: --json needs a file name, or - to print")
    if records is not None and (replicates or jobs):
        raise InvalidInput("--records runs nothing: leave out --replicates and --jobs")
    started = monotonic()
    if records is not None:
        stored = read_records(records)
        chosen = choose(names or (), stored)
        target = folder or records
    else:
        chosen = choose(names or ())
        stored = _measure(chosen, replicates, jobs)
        target = folder or (_PART if names else _WHOLE)
    rows = verdicts(chosen.claims, stored)
    if json_file != "-":
        claims = {claim.id: claim for claim in chosen.claims}
        if rows:
            out().print(as_table(rows, claims, monotonic() - started), highlight=False)
        pending = [] if names else [claim.id for claim in load_all() if claim.measure is None]
        if pending:
            out().print(f"No experiment yet for {', '.join(pending)}.", style="dim")
    if json_file is not None:
        write_json([row.to_json() for row in rows], json_file)
    if target != records:
        write_records(target, stored.records, stored.manifest)
    _write_page(target, docs, rows, stored, chosen)


def _measure(chosen: Selection, replicates: int | None, jobs: int | None) -> Stored:
    with progress_bar("measuring", 1) as (progress, task):
        return measure(
            chosen,
            replicates,
            jobs,
            lambda done, total: progress.update(task, completed=done, total=total),
        )


def _write_page(
    folder: Path, docs: Path | None, rows: Sequence[Row], stored: Stored, chosen: Selection
) -> None:
    """The page, and the documentation's if it is asked for; says where, or what is missing."""
    err().print(f"records  {escape(str(folder))}", soft_wrap=True, highlight=False)
    try:
        from handeye.thesis.docs import write_docs  # noqa: PLC0415 (needs an extra)
        from handeye.thesis.page import reproduction_page  # noqa: PLC0415 (needs an extra)
    except MissingExtra as absent:
        no_page(absent)
        return
    pages = [reproduction_page(rows, stored, chosen).write(folder / _PAGE)]
    if docs is not None:
        pages.append(write_docs(docs, rows, stored))
    for page in pages:
        err().print(f"page     {escape(str(page))}", soft_wrap=True, highlight=False)


def as_table(rows: Sequence[Row], claims: Mapping[str, Claim], seconds: float) -> RenderableType:
    """One line of figures for each claim, and below it what it says and what there is to know.

    Targets come in a table of their own.
    """
    stated, targets = apart(rows)
    parts: list[RenderableType] = []
    if stated:
        parts += _table(_HEAD, stated, claims)
    if targets:
        parts += [Text(f"{TARGETS}\n", "bold"), *_table(_TARGET_HEAD, targets, claims)]
    return Group(*parts, *_summary(rows, seconds))


def _table(head: Cells, rows: Sequence[Row], claims: Mapping[str, Claim]) -> list[RenderableType]:
    cells = [_cells(row) for row in rows]
    widths = [max(map(len, column)) for column in zip(head, *cells, strict=True)]
    parts: list[RenderableType] = [_line(head, widths, ("bold",) * 4)]
    for row, texts in zip(rows, cells, strict=True):
        claim = claims[row.id]
        parts.append(_line(texts, widths, ("bold cyan", "", "", _STYLES[row.verdict])))
        where = "" if claim.is_target else f" (thesis {claim.where})"
        said = Text.assemble(sentence(claim.says), (where, "dim"))
        notes = [said, Text(row.note, "dim")] if row.note else [said]
        parts += [Padding(note, (0, 0, 0, 2), expand=False) for note in notes]
        parts.append("")
    return parts


def _cells(row: Row) -> Cells:
    return row.id, stated_text(row), measured_text(row), row.verdict


def _line(cells: Sequence[str], widths: Sequence[int], styles: Sequence[str]) -> Text:
    columns = zip(cells, widths, styles, strict=True)
    return Text("  ").join(Text(f"{text:<{width}}", style) for text, width, style in columns)


def _summary(rows: Sequence[Row], seconds: float) -> list[RenderableType]:
    said = [Text(f"{n} {verdict}", _STYLES[verdict]) for verdict, n in tally(rows).items() if n]
    most = max(row.replicates for row in rows)
    explained = (
        f"{most} replicates; ± is the 95 % interval of the mean over them. " if most > 1 else ""
    )
    return [Text(", ").join(said), Text(f"{explained}{seconds:.0f} s.", "dim")]
