"""A robot that sees and reaches learns, while it works, where its hand really goes."""

from importlib.metadata import version

__version__ = version("handeye")
