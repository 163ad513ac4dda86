"""MCAP files, with or without ROS, read with Foxglove's own library."""

from collections import Counter
from collections.abc import Collection, Generator, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any, BinaryIO

from handeye.errors import LogError
from handeye.io.bags.decoding import UNREADABLE, Decoder, library, ros_type
from handeye.io.bags.messages import LAST_STAMP
from handeye.io.bags.recording import Message, Topic

_LANGUAGES = {"ros2msg": "msg", "ros1msg": "msg", "ros2idl": "idl", "omgidl": "idl"}
_ENCODINGS = ("cdr", "ros1", "json")
_MAGIC = b"\x89MCAP0\r\n"


class McapFile:
    """An open MCAP file; implements `Recording`.

    A whole file has an index at its end and only what is asked for is read. One without, such as
    a recording that was cut off, is read from the beginning as far as it goes.
    """

    def __init__(self, path: Path, stream: BinaryIO, *, skip_bad: bool) -> None:
        self.damage = ""
        self._path, self._stream, self._skip_bad = path, stream, skip_bad
        self._decoder = Decoder()
        self._errors = (*UNREADABLE, library("mcap.exceptions").McapError, _zstd_error())
        counts = self._indexed()
        self._has_index = counts is not None
        if counts is None:
            counts = Counter[tuple[str, str]]()
            for schema, channel, _ in self._scanned():
                counts[channel.topic, self._learned(schema, channel)] += 1
        self.topics = tuple(Topic(*key, count) for key, count in sorted(counts.items()))

    def messages(self, topics: Collection[str]) -> Iterator[Message]:
        """All messages of the named topics, in the order of the file or of their receipt."""
        for schema, channel, message in self._scanned(topics):
            received = min(message.log_time, LAST_STAMP)
            if channel.message_encoding not in _ENCODINGS:
                yield Message(channel.topic, received, None)
                continue
            kind = self._learned(schema, channel)
            content = self._decoder.decode(channel.message_encoding, kind, message.data)
            yield Message(channel.topic, received, content)

    def _indexed(self) -> Counter[tuple[str, str]] | None:
        """Messages by topic and type from the index; None where the file has none."""
        try:
            summary = library("mcap.reader").make_reader(self._stream).get_summary()
        except self._errors:
            return None
        if summary is None or summary.statistics is None or not summary.chunk_indexes:
            return None
        counts = Counter[tuple[str, str]]()
        for channel in summary.channels.values():
            kind = self._learned(summary.schemas.get(channel.schema_id), channel)
            count = summary.statistics.channel_message_counts.get(channel.id, 0)
            counts[channel.topic, kind] += count
        return counts

    def _learned(self, schema: Any, channel: Any) -> str:
        """The type of a channel's messages; tells the decoder its definition."""
        if schema is None:
            return f"without a type, {channel.message_encoding}"
        kind = ros_type(schema.name)
        language = _LANGUAGES.get(schema.encoding)
        if language:
            self._decoder.learn(
                kind, schema.data.decode(errors="replace"), "idl" if language == "idl" else "msg"
            )
        return kind

    def _scanned(self, topics: Collection[str] | None = None) -> Iterator[tuple[Any, Any, Any]]:
        self._stream.seek(0)
        module = library("mcap.reader")
        kind = module.SeekingReader if self._has_index else module.NonSeekingReader
        reader = kind(self._stream, validate_crcs=True)
        # By index, the order of time needs one chunk at a time; otherwise the whole file at once.
        found = reader.iter_messages(topics=topics, log_time_order=self._has_index)
        while True:
            try:
                item = next(found)
            except StopIteration:
                return
            except self._errors as error:
                self._stop(error)
                return
            yield item

    def _stop(self, error: Exception) -> None:
        """Note where the file ends or goes wrong; raise unless that is to be skipped."""
        said = str(error).rstrip(".") or "it ends within a record"
        self.damage = f"{self._path}: is cut off or damaged ({said})"
        if not self._skip_bad:
            raise LogError(
                f"{self.damage}: mend it with `mcap recover {self._path.name}`, or use what comes "
                "before with --skip-bad (in Python: skip_bad=True)"
            ) from error


@contextmanager
def open_mcap(path: Path, *, skip_bad: bool) -> Generator[McapFile]:
    """An MCAP file.

    Raises:
        LogError: for a file that cannot be read, is none, or is cut off without `skip_bad`.
        MissingExtra: without mcap or rosbags.
    """
    try:
        stream = path.open("rb")
    except OSError as error:
        raise LogError(f"{path}: cannot be read ({error.strerror}): check the path") from error
    with stream:
        if stream.read(len(_MAGIC)) != _MAGIC:
            raise LogError(f"{path}: is no MCAP file: give a recording with its own suffix")
        stream.seek(0)
        yield McapFile(path, stream, skip_bad=skip_bad)


def _zstd_error() -> type[Exception]:
    return library("zstandard").ZstdError
