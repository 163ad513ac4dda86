"""Show the aligned lists of fields in docstrings as lists."""

import re
from typing import Any

import griffe

# "pixel_pitch, focal_length  rho and f [m]": a term, at least two spaces, what it means.
ENTRY = re.compile(r"^(\S.{0,38}?) {2,}(\S.*)$")


def as_lists(docstring: str) -> str:
    """The docstring with every paragraph that is a table of terms turned into a list."""
    return "\n\n".join(_as_list(part) for part in docstring.split("\n\n"))


def _as_list(paragraph: str) -> str:
    if not ENTRY.match(paragraph.split("\n", maxsplit=1)[0]):
        return paragraph
    items: list[str] = []
    for line in paragraph.split("\n"):
        entry = ENTRY.match(line)
        if entry:
            items.append(f"- `{entry[1]}`: {entry[2]}")
        elif line.startswith("  ") and items:
            items[-1] += " " + line.strip()
        else:
            return paragraph
    return "\n".join(items)


class Fields(griffe.Extension):
    """Applies `as_lists` to every docstring of the reference."""

    def on_object(self, *, obj: griffe.Object, **_: Any) -> None:
        """Called by griffe for every module, class, function and attribute."""
        if obj.docstring:
            obj.docstring.value = as_lists(obj.docstring.value)
