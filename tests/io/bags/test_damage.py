"""Recordings that are damaged, cut off, foreign or cannot be read at all."""

import sys
from contextlib import suppress
from pathlib import Path

import numpy as np
import pytest
from mcap.reader import make_reader
from mcap.writer import IndexType, Writer
from rosbags.rosbag1 import Writer as Writer1
from tests.io.bags.recordings import JOINTS, POINT, Bag, Motion, header, message, store
from tests.io.bags.test_reading import NO_DELAY, error_of, two_joints

from handeye.errors import LogError, MissingExtra
from handeye.io.bags import is_bag, read_bag
from handeye.io.logs import read_log


def written(tmp_path: Path, form: str) -> Path:
    tmp_path.mkdir(exist_ok=True)
    path = Motion(seconds=3.0).record(kind="pose").write(tmp_path, form)
    return path if path.is_file() else next(path.glob("*.db3"))


@pytest.mark.parametrize(
    ("form", "said"),
    [
        ("ros1", "`rosbag reindex run.bag`"),
        ("sqlite3", "`ros2 bag reindex`"),
        ("mcap", "`mcap recover run.mcap`"),
        ("json", "`mcap recover run.mcap`"),
    ],
)
def test_a_recording_that_was_cut_off_names_the_tool_that_mends_it(tmp_path, form, said):
    path = written(tmp_path, form)
    whole = path.read_bytes()
    path.write_bytes(whole[: len(whole) // 2])
    assert said in error_of(path)
    path.write_bytes(b"")
    assert "empty" in error_of(path)
    path.write_bytes(b"something else altogether")
    assert str(path) in error_of(path)


def long_mcap(path: Path) -> Path:
    """Several chunks, so that the first ones survive the loss of the last."""
    bag = Motion(seconds=3.0).record(kind="pose")
    made = bag.write(path.parent, "json", "made")
    with made.open("rb") as source, path.open("wb") as target:
        writer = Writer(target, chunk_size=4096)
        writer.start()
        channels = {}
        for schema, channel, message in make_reader(source).iter_messages():
            assert schema is not None
            if channel.topic not in channels:
                number = writer.register_schema(schema.name, schema.encoding, schema.data)
                channels[channel.topic] = writer.register_channel(channel.topic, "json", number)
            writer.add_message(
                channels[channel.topic], message.log_time, message.data, message.log_time
            )
        writer.finish()
    return path


def test_the_whole_part_of_an_mcap_file_is_read_with_skip_bad(tmp_path):
    path = long_mcap(tmp_path / "run.mcap")
    raw = path.read_bytes()
    n = len(read_bag(path, options=NO_DELAY).log)
    path.write_bytes(raw[: len(raw) // 2])
    assert "--skip-bad" in error_of(path)
    reading = read_bag(path, options=NO_DELAY, skip_bad=True)
    assert 0 < len(reading.log) < n
    assert reading.report.damage.startswith(f"{path}: is cut off or damaged")
    assert reading.report.lines()[-1] == reading.report.damage
    spoilt = bytearray(raw)
    for at in range(len(raw) // 3, len(raw) // 2):
        spoilt[at] ^= 0xFF
    path.write_bytes(spoilt)
    assert "is cut off or damaged" in error_of(path, options=NO_DELAY)
    assert 0 < len(read_bag(path, options=NO_DELAY, skip_bad=True).log) < n


def test_nothing_but_a_deliberate_error_comes_out_of_a_spoilt_file(tmp_path):
    rng = np.random.default_rng(0)
    for form in ("ros1", "mcap", "sqlite3"):
        path = written(tmp_path / form, form)
        raw = path.read_bytes()
        for i in range(6):
            spoilt = bytearray(raw)
            where = rng.integers(0, len(raw) if i % 2 else 2000, 4)
            spoilt[where[0]] = spoilt[where[1]] = rng.integers(256)
            path.write_bytes(spoilt[: -int(where[2])] if i % 3 == 0 else spoilt)
            with suppress(LogError):
                read_bag(path, options=NO_DELAY, skip_bad=bool(i % 2))


def test_a_folder_without_its_metadata_says_how_to_restore_it(tmp_path):
    bag = two_joints()
    bag.point(0.5, [1, 2, 3])
    folder = bag.write(tmp_path, "sqlite3")
    (folder / "metadata.yaml").unlink()
    assert is_bag(folder)
    message = error_of(folder)
    assert f"`ros2 bag reindex {folder}`" in message
    assert "run.db3" in message
    assert len(read_bag(folder / "run.db3", options=NO_DELAY).log) == 1
    assert "No such file" in error_of(tmp_path / "absent.mcap")
    (folder / "metadata.yaml").write_text("{}")
    assert "ros2 bag" in error_of(folder)


def test_a_bag_that_was_not_closed_is_not_indexed(tmp_path):
    path = tmp_path / "open.bag"
    writer = Writer1(path)
    writer.open()
    writer.add_connection("/joint_states", JOINTS, typestore=store(ros1=True))
    assert writer.bio is not None
    writer.bio.flush()
    assert "`rosbag reindex open.bag`" in error_of(path)
    writer.close()


def test_messages_that_cannot_be_decoded_are_counted(tmp_path):
    path = tmp_path / "run.mcap"
    good = two_joints()
    good.point(0.5, [1, 2, 3])
    made = good.write(tmp_path, "json", "made")
    assert len(read_bag(made, options=NO_DELAY).log) == 1
    with path.open("wb") as stream:
        writer = Writer(stream)
        writer.start()
        joints = writer.register_schema("sensor_msgs/JointState", "ros2msg", b"float64 nonsense")
        point = writer.register_schema("geometry_msgs/PointStamped", "protobuf", b"?")
        for topic, schema, encoding in (("/a", joints, "cdr"), ("/b", point, "protobuf")):
            channel = writer.register_channel(topic, encoding, schema)
            for i in range(3):
                writer.add_message(channel, i, b"\x00\x01\x00\x00garbage!", i)
        writer.finish()
    message = error_of(path)
    assert "no joint state of /a can be used: they cannot be decoded" in message


def test_ros1_messages_in_mcap_without_an_index_are_read(tmp_path):
    types = store(ros1=True)
    bag = two_joints()
    bag.point(0.5, [1, 2, 3])
    path = tmp_path / "run.mcap"
    with path.open("wb") as stream:
        writer = Writer(
            stream, index_types=IndexType.NONE, use_statistics=False, use_summary_offsets=False
        )
        writer.start(profile="ros1")
        channels = {}
        for topic, kind, when, content in bag.messages:
            if topic not in channels:
                text = types.generate_msgdef(kind)[0].encode()
                schema = writer.register_schema(kind.replace("/msg/", "/"), "ros1msg", text)
                channels[topic] = writer.register_channel(topic, "ros1", schema)
            data = bytes(types.serialize_ros1(message(types, kind, content), kind))
            writer.add_message(channels[topic], when, data, when)
        writer.finish()
    reading = read_bag(path, options=NO_DELAY)
    assert len(reading.log) == 1
    assert reading.report.joints_topic == "/joint_states"
    assert reading.report.points_topic == "/marker"


def test_json_without_the_fields_of_its_type_is_counted(tmp_path):
    bag = two_joints()
    bag.point(0.5, [1, 2, 3])
    bag.add("/marker", POINT, 0.6, {"header": header(0.6)})
    [unused] = read_bag(bag.write(tmp_path, "json"), options=NO_DELAY).report.unused
    assert (unused.topic, unused.count, unused.reason) == ("/marker", 1, "they cannot be decoded")


@pytest.mark.parametrize(("form", "module"), [("ros1", "rosbags.rosbag1"), ("json", "mcap.reader")])
def test_without_the_extra_its_name_is_told(tmp_path, monkeypatch, form, module):
    path = Bag().write(tmp_path, form)
    monkeypatch.setitem(sys.modules, module, None)
    with pytest.raises(MissingExtra, match=r"handeye\[bags\]"):
        read_log(path)
