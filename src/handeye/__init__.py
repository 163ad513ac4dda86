"""A robot that sees and reaches learns, while it works, where its hand really goes."""

from importlib.metadata import version
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from handeye.calibration.live import Session as Session

__all__ = ["Session", "__version__"]

__version__ = version("handeye")


def __getattr__(name: str) -> Any:
    """Load what stands in higher layers when it is asked for: `import handeye` stays quick."""
    if name == "Session":
        from handeye.calibration.live import Session  # noqa: PLC0415

        return Session
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
