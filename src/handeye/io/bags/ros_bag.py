"""Bags of ROS 1 (.bag) and ROS 2 (folder or .db3), read with rosbags."""

from collections import Counter
from collections.abc import Collection, Generator, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from handeye.errors import LogError
from handeye.io.bags.decoding import UNREADABLE, Decoder, Encoding, library, ros_type
from handeye.io.bags.recording import Message, Topic


class RosBag:
    """An open bag; implements `Recording`."""

    def __init__(self, path: Path, reader: Any, encoding: Encoding, *, skip_bad: bool) -> None:
        self.damage = ""
        self._path, self._reader = path, reader
        self._encoding: Encoding = encoding
        self._skip_bad = skip_bad
        self._decoder = Decoder()
        counts: Counter[tuple[str, str]] = Counter()
        for connection in reader.connections:
            kind = ros_type(connection.msgtype)
            counts[connection.topic, kind] += connection.msgcount
            language = connection.msgdef.format.name.lower()
            if language != "none":
                self._decoder.learn(kind, connection.msgdef.data, language)
        self.topics = tuple(Topic(*key, count) for key, count in sorted(counts.items()))

    def messages(self, topics: Collection[str]) -> Iterator[Message]:
        """All messages of the named topics, in the order of the file or of their receipt."""
        wanted = [c for c in self._reader.connections if c.topic in topics]
        if not wanted:
            return
        found = self._reader.messages(connections=wanted)
        while True:
            try:
                connection, received, data = next(found)
            except StopIteration:
                return
            except _errors() as error:
                self.damage = f"{self._path}: {_damaged(self._path, error)}"
                if self._skip_bad:
                    return
                raise LogError(
                    f"{self.damage}, or use what comes before with --skip-bad (in Python: "
                    "skip_bad=True)"
                ) from error
            kind = ros_type(connection.msgtype)
            content = self._decoder.decode(self._encoding, kind, bytes(data))
            yield Message(connection.topic, received, content)


@contextmanager
def open_ros_bag(path: Path, *, skip_bad: bool) -> Generator[RosBag]:
    """A .bag or .db3 file, or the folder of a ROS 2 bag.

    Raises:
        LogError: for a file that is no such bag, damaged, or not indexed.
        MissingExtra: without rosbags.
    """
    first = path.suffix == ".bag" and path.is_file()
    encoding: Encoding = "ros1" if first else "cdr"
    try:
        reader = library("rosbags.rosbag1" if first else "rosbags.rosbag2").Reader(path)
        reader.open()
    except _errors() as error:
        raise LogError(f"{path}: {_damaged(path, error)}") from error
    try:
        yield RosBag(path, reader, encoding, skip_bad=skip_bad)
    finally:
        reader.close()


def _errors() -> tuple[type[Exception], ...]:
    return (
        *UNREADABLE,
        library("rosbags.rosbag1").ReaderError,
        library("rosbags.rosbag2").ReaderError,
        library("apsw").Error,
        library("rosbags.rosbag2.reader").zstd.ZstdError,
    )


def _damaged(path: Path, error: Exception) -> str:
    """What is wrong with a bag, and the tool that mends it."""
    said = str(error).rstrip(".") or type(error).__name__
    if isinstance(error, PermissionError):
        return "cannot be read (Permission denied): check who may read it"
    if path.suffix == ".bag":
        return (
            f"is no whole ROS 1 bag ({said}): a recording that was cut off is mended with "
            f"`rosbag reindex {path.name}`, a damaged one with `rosbag fix`"
        )
    return (
        f"is no whole ROS 2 bag ({said}): a recording that was cut off is mended with "
        f"`ros2 bag reindex`; other damage, by copying what is whole with `ros2 bag convert`"
    )
