"""Recordings made without ROS: MCAP files with JSON messages that have the fields of ROS types."""

import json
from collections.abc import Sequence
from importlib import import_module
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np

from handeye.arrays import Array, shaped
from handeye.errors import MissingExtra
from handeye.io.files import replace_file


def write_recording(
    path: Path | str,
    joint_names: Sequence[str],
    joints: tuple[Array, Array],
    points: tuple[Array, Array],
    *,
    delay: float = 0.0,
    frame: str = "camera",
) -> None:
    """Write joint states and points, each as times (N,) [s] and values (N, n) or (N, 3).

    Topics /joint_states (sensor_msgs/JointState) and /marker (geometry_msgs/PointStamped). Points
    are stamped `delay` s late, as many cameras do.

    Raises:
        InvalidInput: arrays that do not fit each other.
        MissingExtra: without mcap.
    """
    times, states = joints
    states = shaped(states, (len(times), len(joint_names)), "joints")
    seen, places = points
    places = shaped(places, (len(seen), 3), "points")
    content = BytesIO()
    writer = _writer(content)
    writer.start()

    def topic(name: str, kind: str) -> Any:
        schema = writer.register_schema(kind, "jsonschema", b"")
        return writer.register_channel(name, "json", schema)

    def write(channel: Any, received: float, message: dict[str, Any]) -> None:
        stamp = round(received * 1e9)
        writer.add_message(channel, stamp, json.dumps(message).encode(), stamp)

    state_topic = topic("/joint_states", "sensor_msgs/JointState")
    point_topic = topic("/marker", "geometry_msgs/PointStamped")
    events = [(time, 0, i) for i, time in enumerate(np.asarray(times).tolist())]
    events += [(time, 1, i) for i, time in enumerate(np.asarray(seen).tolist())]
    for time, what, i in sorted(events):
        if what == 0:
            body = {"name": list(joint_names), "position": states[i].tolist()}
            write(state_topic, time, {"header": _header(time, ""), **body})
        else:
            point = dict(zip("xyz", places[i].tolist(), strict=True))
            header = _header(time + delay, frame)
            write(point_topic, time + delay, {"header": header, "point": point})
    writer.finish()
    replace_file(path, content.getvalue())


def _header(time: float, frame: str) -> dict[str, Any]:
    second, nanosecond = divmod(round(time * 1e9), 1_000_000_000)
    return {"stamp": {"sec": second, "nanosec": nanosecond}, "frame_id": frame}


def _writer(content: BytesIO) -> Any:
    try:
        return import_module("mcap.writer").Writer(content)
    except ImportError as error:
        raise MissingExtra("a recording", "bags") from error
