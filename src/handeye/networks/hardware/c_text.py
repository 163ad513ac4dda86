"""Templates of C files: `$name` is replaced; `@if flag`, `@else` and `@end` choose lines."""

from collections.abc import Iterable, Mapping
from importlib import resources
from string import Template
from textwrap import indent, wrap
from typing import Any

_COLUMNS = 100


def fill(template: str, values: Mapping[str, Any], flags: Mapping[str, bool]) -> str:
    """The text of a template of this package, with its parts chosen and its names replaced.

    Raises KeyError for a name or flag that the template has and the caller has not.
    """
    folder = resources.files("handeye.networks.hardware").joinpath("templates")
    text = folder.joinpath(f"{template}.txt").read_text(encoding="utf-8")
    return Template("\n".join(_chosen(text.splitlines(), flags)) + "\n").substitute(values)


def _chosen(lines: Iterable[str], flags: Mapping[str, bool]) -> list[str]:
    open_parts: list[bool] = []
    chosen: list[str] = []
    for line in lines:
        word, _, flag = line.partition(" ")
        if word == "@if":
            open_parts.append(flags[flag])
        elif word == "@else":
            open_parts[-1] = not open_parts[-1]
        elif word == "@end":
            open_parts.pop()
        elif all(open_parts):
            chosen.append(line)
    return chosen


def numbers(values: Any) -> str:
    """The initializer of an array (N,) or the rows of one (N, M), without the outer braces.

    Doubles are written with all their digits.
    """
    if values.ndim == 2:
        return "\n".join(_braced(row) for row in values.tolist())
    return _wrapped(values.tolist())


def _braced(row: list[Any]) -> str:
    body = _wrapped(row)
    if "\n" in body:
        return f"    {{\n{indent(body, '    ')}\n    }},"
    return f"    {{{body.strip()}}},"


def _wrapped(row: list[Any]) -> str:
    return "\n".join(
        wrap(
            ", ".join(map(repr, row)),
            _COLUMNS,
            initial_indent="    ",
            subsequent_indent="    ",
            break_on_hyphens=False,
        )
    )
