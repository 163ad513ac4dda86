"""What the results of logs and of set-ups show alike: lines with a head, and parts of the arm."""

from collections.abc import Sequence

from rich.console import Console
from rich.markup import escape

from handeye.calibration.results import ErrorSummary, PartChange
from handeye.cli.console import table

WORST = 5
"""Rows to look at that are listed."""
_PARTS, _LISTED = 8, 5


def say(console: Console, head: str, lines: Sequence[str]) -> None:
    """Lines beside a head."""
    for i, line in enumerate(lines):
        console.print(f"{'' if i else head:<10}{escape(line)}", highlight=False, soft_wrap=True)


def print_open(console: Console, undetermined: Sequence[str]) -> None:
    """The directions that the poses do not determine."""
    say(console, "open", undetermined[:_LISTED])
    more = len(undetermined) - _LISTED
    if more > 0:
        say(console, "", [f"and {more} more that the poses leave to ordinary tolerances"])


def print_rejected(console: Console, rejected: Sequence[str]) -> None:
    """Rows that were not used."""
    if rejected:
        say(console, "rejected", [f"{len(rejected)} rows", *rejected[:_LISTED]])


def print_parts(console: Console, title: str, parts: Sequence[PartChange]) -> None:
    """Which part of the arm was off, most important first."""
    if not parts:
        return
    shown = table(title, "part", "its most changed number", "moves the hand [mm]", "known", left=2)
    for part in parts[:_PARTS]:
        number = f"{part.unknown} {part.change:+.3g} ± {part.std:.2g} {part.unit}".rstrip()
        shown.add_row(part.part, number, f"{1e3 * part.moves:#.3g}", f"{part.known:.0%}")
    console.print(shown)
    if len(parts) > _PARTS:
        say(console, "", [f"and {len(parts) - _PARTS} more parts, which move it less"])


def between(summary: ErrorSummary, scale: float) -> str:
    """The interval of the mean, in words."""
    if summary.interval is None:
        return ""
    return " to ".join(f"{scale * end:#.3g}" for end in summary.interval)
