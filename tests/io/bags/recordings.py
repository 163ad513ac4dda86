"""Recordings to read and to spoil, written with the writers of rosbags and mcap."""

import json
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path

import numpy as np
from mcap.writer import Writer as McapWriter
from rosbags.rosbag1 import Writer as Writer1
from rosbags.rosbag2 import StoragePlugin
from rosbags.rosbag2 import Writer as Writer2
from rosbags.typesys import Stores, get_types_from_msg, get_typestore
from scipy.spatial.transform import Rotation

from handeye.geometry import make_pose
from handeye.robots.urdf import load_arm

FORMATS = ("ros1", "sqlite3", "mcap", "json")
START = 1_700_000_000_000_000_000  # [ns], as clocks of today show it

JOINTS = "sensor_msgs/msg/JointState"
POINT = "geometry_msgs/msg/PointStamped"
POSE = "geometry_msgs/msg/PoseStamped"
TF = "tf2_msgs/msg/TFMessage"
TAGS = "apriltag_msgs/msg/AprilTagDetectionArray"
BARE_TAGS = "other_msgs/msg/AprilTagDetectionArray"

_DEFINITIONS = {
    TF: "geometry_msgs/TransformStamped[] transforms",
    TAGS: "std_msgs/Header header\napriltag_msgs/AprilTagDetection[] detections",
    "apriltag_msgs/msg/AprilTagDetection": (
        "string family\nint32 id\ngeometry_msgs/PoseWithCovarianceStamped pose"
    ),
    BARE_TAGS: "std_msgs/Header header\nother_msgs/AprilTagDetection[] detections",
    "other_msgs/msg/AprilTagDetection": "string family\nint32 id",
}


@cache
def store(ros1: bool):
    made = get_typestore(Stores.ROS1_NOETIC if ros1 else Stores.ROS2_HUMBLE)
    for kind, text in _DEFINITIONS.items():
        if kind not in made.fielddefs:
            made.register(get_types_from_msg(text, kind))
    return made


@dataclass
class Bag:
    """Messages to be written: (topic, type, time of receipt [ns], content as nested dicts)."""

    messages: list = field(default_factory=list)

    def add(self, topic, kind, stamp, content, received=None):
        when = int(stamp * 1e9) + START if received is None else received
        self.messages.append((topic, kind, when, content))

    def joints(self, stamp, names, positions, topic="/joint_states", **options):
        content = {
            "header": header(stamp),
            "name": list(names),
            "position": np.asarray(positions, dtype=np.float64),
            "velocity": np.zeros(0),
            "effort": np.zeros(0),
        }
        self.add(topic, JOINTS, stamp, content, **options)

    def point(self, stamp, xyz, frame="tracker", topic="/marker", **options):
        self.add(
            topic, POINT, stamp, {"header": header(stamp, frame), "point": vector(xyz)}, **options
        )

    def pose(self, stamp, xyz, wxyz, frame="camera", topic="/tag_pose", **options):
        content = {"header": header(stamp, frame), "pose": pose(xyz, wxyz)}
        self.add(topic, POSE, stamp, content, **options)

    def transforms(self, stamp, *steps, topic="/tf", **options):
        """Steps (parent, child, xyz, wxyz)."""
        found = [
            {
                "header": header(stamp, parent),
                "child_frame_id": child,
                "transform": {"translation": vector(xyz), "rotation": quaternion(wxyz)},
            }
            for parent, child, xyz, wxyz in steps
        ]
        self.add(topic, TF, stamp, {"transforms": found}, **options)

    def tags(self, stamp, *found, topic="/detections", frame="camera"):
        """Tags (id, xyz, wxyz)."""
        top = header(stamp, frame)
        detections = [
            {
                "family": "36h11",
                "id": number,
                "pose": {
                    "header": top,
                    "pose": {"pose": pose(xyz, wxyz), "covariance": np.zeros(36)},
                },
            }
            for number, xyz, wxyz in found
        ]
        self.add(topic, TAGS, stamp, {"header": top, "detections": detections})

    def write(self, folder: Path, form: str, name="run") -> Path:
        return _WRITERS[form](self, folder / name)


def header(stamp, frame=""):
    when = 0 if stamp is None else START + round(stamp * 1e9)
    return {
        "seq": 0,
        "stamp": {"sec": when // 10**9, "nanosec": when % 10**9},
        "frame_id": frame,
    }


def vector(xyz):
    return dict(zip("xyz", map(float, xyz), strict=True))


def quaternion(wxyz):
    return dict(zip("wxyz", map(float, wxyz), strict=True))


def pose(xyz, wxyz):
    return {"position": vector(xyz), "orientation": quaternion(wxyz)}


def message(types, kind, content):
    """An object of rosbags' class for a type from nested dicts."""
    made = {}
    for name, (number, argument) in types.fielddefs[kind][1]:
        value = content[name]
        if number.name == "NAME":
            value = message(types, argument, value)
        elif number.name == "SEQUENCE" and argument[0][0].name == "NAME":
            value = [message(types, argument[0][1], item) for item in value]
        made[name] = value
    return types.types[kind](**made)


def _write1(bag, base):
    path = base.with_suffix(".bag")
    types = store(ros1=True)
    with Writer1(path) as writer:
        connections = {}
        for topic, kind, when, content in bag.messages:
            if topic not in connections:
                connections[topic] = writer.add_connection(topic, kind, typestore=types)
            data = types.serialize_ros1(message(types, kind, content), kind)
            writer.write(connections[topic], when, data)
    return path


def _write2(bag, base, storage):
    types = store(ros1=False)
    with Writer2(base, version=9, storage_plugin=storage) as writer:
        connections = {}
        for topic, kind, when, content in bag.messages:
            if topic not in connections:
                connections[topic] = writer.add_connection(topic, kind, typestore=types)
            data = types.serialize_cdr(message(types, kind, content), kind)
            writer.write(connections[topic], when, data)
    return base


def _write_json(bag, base):
    path = base.with_suffix(".mcap")
    with path.open("wb") as stream:
        writer = McapWriter(stream)
        writer.start(profile="", library="tests")
        channels = {}
        for topic, kind, when, content in bag.messages:
            if topic not in channels:
                schema = writer.register_schema(kind.replace("/msg/", "/"), "jsonschema", b"{}")
                channels[topic] = writer.register_channel(topic, "json", schema)
            data = json.dumps(content, default=lambda array: array.tolist()).encode()
            writer.add_message(channels[topic], when, data, when)
        writer.finish()
    return path


def _write_mcap(bag, base):
    folder = _write2(bag, base, StoragePlugin.MCAP)
    return next(folder.glob("*.mcap"))


_WRITERS = {
    "ros1": _write1,
    "sqlite3": lambda bag, base: _write2(bag, base, StoragePlugin.SQLITE3),
    "mcap folder": lambda bag, base: _write2(bag, base, StoragePlugin.MCAP),
    "mcap": _write_mcap,
    "json": _write_json,
}


@cache
def ur10():
    return load_arm("ur10")


@dataclass(frozen=True)
class Motion:
    """A UR10 that swings all its joints, seen by a tracker that stands beside it."""

    seconds: float = 20.0
    speed: float = 1.0
    marker: tuple = (0.03, -0.05, 0.12)

    def joints(self, times):
        rng = np.random.default_rng(3)
        t = self.speed * np.atleast_1d(times)[:, None, None]
        size, rate, phase = (
            rng.uniform(*low_high, (6, 3)) for low_high in ((0.1, 0.4), (0.3, 1.5), (0, 6))
        )
        middle = np.array([0.3, -1.2, 1.4, 0.2, 0.9, -0.4])
        return middle + np.sum(size * np.sin(rate * t + phase), axis=2)

    def poses(self, times):
        """T_tracker_marker (N, 4, 4)."""
        T = make_pose(Rotation.from_euler("xyz", [0.2, -0.4, 2.0]).as_matrix(), [1.5, 0.3, 0.8])
        Z = make_pose(Rotation.from_euler("xyz", [0.1, 0.5, 0.3]).as_matrix(), self.marker)
        return T @ ur10().poses(self.joints(times)) @ Z

    def positions(self, times):
        return self.poses(times)[:, :3, 3]

    def record(self, *, delay=0.0, rate=125.0, every=0.1, noise=1e-4, kind="point"):
        """A bag in which the sensor's stamps are `delay` late."""
        bag, rng = Bag(), np.random.default_rng(1)
        names = ur10().joint_names
        times = np.arange(0.0, self.seconds, 1.0 / rate)
        for time, angles in zip(times, self.joints(times), strict=True):
            bag.joints(time, names, angles)
        seen = np.arange(0.6, self.seconds - 0.6, every) + rng.uniform(0, 0.03, 1)
        for time, T in zip(seen, self.poses(seen), strict=True):
            xyz = T[:3, 3] + rng.normal(0.0, noise, 3)
            wxyz = Rotation.from_matrix(T[:3, :3]).as_quat(scalar_first=True)
            if kind == "point":
                bag.point(time + delay, xyz)
            elif kind == "pose":
                bag.pose(time + delay, xyz, wxyz)
            elif kind == "tags":
                bag.tags(time + delay, (7, xyz, wxyz))
            else:
                bag.transforms(time + delay, ("camera", "tag", xyz, wxyz))
        return bag
