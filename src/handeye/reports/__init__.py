"""Self-contained HTML pages with figures; needs the extra "report"."""

from handeye.errors import MissingExtra

try:
    import jinja2 as _jinja2  # noqa: F401  # pyright: ignore[reportUnusedImport]
    import matplotlib as _matplotlib  # noqa: F401  # pyright: ignore[reportUnusedImport]
except ImportError as absent:
    raise MissingExtra("A report page", "report") from absent
