"""Figures as text: inline SVG for a page, PNG for a still.

Words stay text, so they are small, can be searched and take the page's own typeface. Palette
colours become CSS variables, so that one drawing serves light and dark ground.
"""

# matplotlib leaves the types of its keyword arguments open.
# pyright: reportUnknownMemberType=false

import re
import warnings
from collections.abc import Generator
from contextlib import contextmanager
from io import BytesIO, StringIO
from pathlib import Path
from xml.etree import ElementTree

from matplotlib.figure import Figure

from handeye.reports.files import write_file
from handeye.reports.style import PALETTE, color, rc

_NUMBER = re.compile(r"-?\d+\.\d{3,}")
_HEX = re.compile("|".join(re.escape(light) for light, _ in PALETTE.values()))
_VARIABLE = {light: f"var(--{name}, {light})" for name, (light, _) in PALETTE.items()}
_REFERENCE = re.compile(r"#([\w.-]+)")
_FAMILY = re.compile(r"'DejaVu Sans'[^;]*")


def inline_svg(figure: Figure, name: str, alt: str) -> str:
    """The figure as an `<svg>` element for an HTML page, the same text on every run.

    `name` goes before every id, so it must differ between the figures of one page.
    `alt` says what the picture shows to those who cannot see it.
    """
    text = StringIO()
    with rc(), _quiet():
        figure.savefig(text, format="svg", metadata={"Date": None, "Creator": None})
    root = ElementTree.fromstring(text.getvalue())
    for element in root.iter():
        element.tag = element.tag.rpartition("}")[2]
    for unwanted in ("metadata", "style"):
        for parent in root.iter():
            for child in parent.findall(unwanted):
                parent.remove(child)
    targets = (target for element in root.iter() for target in _targets(element))
    ids = {old: f"{name}-{i}" for i, old in enumerate(dict.fromkeys(targets))}
    for element in root.iter():
        _rewrite(element, ids)
    for group in root.iter("g"):
        _hoist_style(group)
    width = str(root.get("viewBox")).split()[2]
    root.attrib = {
        "viewBox": str(root.get("viewBox")),
        "role": "img",
        "aria-label": alt,
        "stroke-linejoin": "round",
        "style": f"max-width: {float(width):g}px",
    }
    return ElementTree.tostring(root, encoding="unicode").strip()


def write_png(figure: Figure, path: Path, scale: float = 1.2) -> None:
    """Write the figure on light ground, `scale` image pixels for each of its own pixels.

    Raises InvalidInput with the reason when the place cannot be written to.
    """
    write_file(path, png(figure, scale))


def png(figure: Figure, scale: float = 1.2) -> bytes:
    """The figure on light ground as the bytes of a PNG image, the same on every run."""
    image = BytesIO()
    with rc(), _quiet():
        figure.savefig(
            image,
            format="png",
            dpi=72 * scale,
            facecolor=color("card"),
            metadata={"Software": None},
            pil_kwargs={"optimize": True},
        )
    return image.getvalue()


@contextmanager
def _quiet() -> Generator[None]:
    """A joint's name in a script that the measuring font lacks is still drawn by the browser."""
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="Glyph .* missing from")
        yield


def _targets(element: ElementTree.Element) -> list[str]:
    return [
        target
        for key, value in element.items()
        if key.endswith("href") or "url(" in value
        for target in _REFERENCE.findall(value)
    ]


def _rewrite(element: ElementTree.Element, ids: dict[str, str]) -> None:
    old = dict(element.attrib)
    element.attrib.clear()
    for key, value in old.items():
        if key == "id":
            if value in ids:
                element.set("id", ids[value])
        elif key.endswith("href"):
            element.set("href", f"#{ids[value[1:]]}")
        elif "url(#" in value:
            element.set(key, _REFERENCE.sub(lambda match: f"#{ids[match[1]]}", value))
        elif key == "style":
            style = _HEX.sub(lambda match: _VARIABLE[match[0]], value)
            element.set(key, _FAMILY.sub("var(--font, sans-serif)", style))
        else:
            element.set(key, _NUMBER.sub(_shorter, value))
        if element.tag == "use" and key in ("x", "y"):
            element.set(key, f"{float(value):.1f}")
    if element.text is not None and not element.text.strip():
        element.text = None
    if element.tail is not None and not element.tail.strip():
        element.tail = "\n" if element.tag == "g" else None


def _shorter(number: re.Match[str]) -> str:
    return f"{float(number[0]):.2f}".rstrip("0").rstrip(".")


def _hoist_style(group: ElementTree.Element) -> None:
    """Say once on the group what all of its markers repeat."""
    styles = {child.get("style") for child in group}
    if len(group) > 1 and len(styles) == 1 and all(child.tag == "use" for child in group):
        group.set("style", str(styles.pop()))
        for child in group:
            child.attrib.pop("style", None)
