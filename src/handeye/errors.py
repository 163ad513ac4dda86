"""Errors written for the person who has to act on them."""


class HandeyeError(Exception):
    """Base of every error that this package raises on purpose."""


class InvalidInput(HandeyeError, ValueError):
    """A value, array or setting that cannot be used; nothing was changed."""


class LogError(HandeyeError):
    """A log that cannot be used as it is: says which file and row, and the remedy."""


class FileFormatError(HandeyeError):
    """A stored network or model that is damaged, foreign or newer than this package."""


class MissingExtra(HandeyeError, ImportError):
    """A feature whose optional dependency is not installed; says what to install."""

    def __init__(self, feature: str, extra: str) -> None:
        super().__init__(f"{feature} needs an optional dependency: pip install 'handeye[{extra}]'")
