"""Files of recorded messages, whatever their format."""

from collections.abc import Callable, Collection, Generator, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple, Protocol

from handeye.errors import LogError

SUFFIXES = (".bag", ".mcap", ".db3")
_METADATA = "metadata.yaml"

Progress = Callable[[int, int], None]
"""Told how many of how many messages are read."""


def unwatched(done: int, total: int) -> None:
    """Progress that nobody watches."""


@dataclass(frozen=True)
class Topic:
    """A named stream of `count` messages of one type, such as `sensor_msgs/msg/JointState`."""

    name: str
    type: str
    count: int


class Message(NamedTuple):
    """A message of `topic`, recorded at `received` [ns]; None is one that cannot be decoded."""

    topic: str
    received: int
    content: Any | None


class Recording(Protocol):
    """An open file of messages.

    damage   what kept the rest of the file from being read; empty while all is well
    """

    @property
    def topics(self) -> tuple[Topic, ...]:
        """Every topic, in the order of their names."""
        ...

    @property
    def damage(self) -> str:
        """Empty, or what is wrong with the file."""
        ...

    def messages(self, topics: Collection[str]) -> Iterator[Message]:
        """All messages of the named topics, in the order of the file or of their receipt."""
        ...


def is_bag(path: Path | str) -> bool:
    """Whether a path is that of recorded messages: .bag, .mcap, .db3, or a folder of them."""
    place = Path(path)
    if place.is_dir():
        return (place / _METADATA).exists() or bool(_storages(place))
    return place.suffix in SUFFIXES


@contextmanager
def open_recording(path: Path, *, skip_bad: bool) -> Generator[Recording]:
    """The messages of a ROS 1 bag, a ROS 2 bag (its folder or its file), or an MCAP file.

    With `skip_bad` a file that ends early or is damaged further on is read up to there.

    Raises:
        LogError: for a file that is absent, of another kind, damaged or not indexed.
        MissingExtra: without the extra `bags`.
    """
    # Each pulls in its library, which only this kind of file needs.
    from handeye.io.bags.mcap_file import open_mcap  # noqa: PLC0415
    from handeye.io.bags.ros_bag import open_ros_bag  # noqa: PLC0415

    if not path.exists():
        raise LogError(f"{path}: cannot be read (No such file or directory): check the path")
    if path.is_file() and not path.stat().st_size:
        raise LogError(f"{path}: the file is empty: record it again")
    if path.is_dir() and not (path / _METADATA).exists():
        found = ", ".join(str(p) for p in _storages(path)) or "no .mcap or .db3 file"
        raise LogError(
            f"{path}: is a folder without {_METADATA}, so its recording was cut off: restore the "
            f"file with `ros2 bag reindex {path}`, or give the recorded file itself ({found})"
        )
    opened = open_mcap if path.suffix == ".mcap" and path.is_file() else open_ros_bag
    with opened(path, skip_bad=skip_bad) as recording:
        yield recording


def _storages(folder: Path) -> list[Path]:
    return sorted(p for p in folder.iterdir() if p.suffix in {".mcap", ".db3"})
