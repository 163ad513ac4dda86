"""Robots that example-robot-data ships."""

from functools import cache
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path

from handeye.errors import MissingExtra


@cache
def shipped_robots() -> dict[str, Path]:
    """The URDF files of example-robot-data by name.

    The name is the file's, without `_robot` at its end (which wins over a file without); where
    two robots share one, the folder goes before it (`anymal_b_simple/anymal`).

    Raises:
        MissingExtra: when example-robot-data is not installed.
    """
    try:
        files = distribution("example-robot-data").files or []
    except PackageNotFoundError as error:
        raise MissingExtra("a robot known by name", "robots") from error
    paths = [Path(str(file.locate())) for file in files if file.suffix == ".urdf"]
    paths = [path for path in paths if path.with_name(f"{path.stem}_robot.urdf") not in paths]
    short = [path.stem.removesuffix("_robot") for path in paths]
    return {
        name if short.count(name) == 1 else f"{_package(path)}/{name}": path
        for name, path in zip(short, paths, strict=True)
    }


def _package(path: Path) -> str:
    return path.parents[1].name.removesuffix("_description")
