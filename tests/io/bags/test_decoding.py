"""Bytes of messages, with definitions in either language or with ROS's own."""

import pytest
from tests.io.bags.recordings import JOINTS, POINT, header, message, store, vector

from handeye.io.bags.decoding import Decoder, ros_type
from handeye.io.bags.messages import JointReading, joint_reading, sightings

IDL = """module odd_msgs { module msg { struct Spot { double x; long number; }; }; };"""


@pytest.mark.parametrize("ros1", [True, False])
def test_types_of_ros_need_no_definition_in_the_file(ros1):
    types = store(ros1)
    content = {"header": header(1.5, "/eye"), "point": vector([1, 2, 3])}
    made = message(types, POINT, content)
    write = types.serialize_ros1 if ros1 else types.serialize_cdr
    encoding = "ros1" if ros1 else "cdr"
    decoded = Decoder().decode(encoding, POINT, bytes(write(made, POINT)))
    found = sightings(POINT, decoded)
    assert found is not None
    assert (found[0].frame, found[0].pose[:3]) == ("eye", (1.0, 2.0, 3.0))
    assert found[0].stamp % 10**9 == 500_000_000


@pytest.mark.parametrize("headed", [True, False])
def test_definitions_in_idl_are_understood(headed):
    decoder = Decoder()
    text = "=" * 80 + f"\nIDL: odd_msgs/msg/Spot\n{IDL}\n" if headed else IDL
    decoder.learn("odd_msgs/msg/Spot", text, "idl")
    data = b"\x00\x01\x00\x00" + bytes(6) + b"\xf8\x3f" + b"\x07\x00\x00\x00"
    spot = decoder.decode("cdr", "odd_msgs/msg/Spot", data)
    assert spot is not None
    assert (spot.x, spot.number) == (1.5, 7)


def test_what_cannot_be_decoded_is_none():
    decoder = Decoder()
    decoder.learn("odd_msgs/msg/Bad", "float64 ] nonsense", "msg")
    assert decoder.decode("cdr", "odd_msgs/msg/Bad", bytes(20)) is None
    assert decoder.decode("cdr", "odd_msgs/msg/Unheard", bytes(20)) is None
    assert decoder.decode("cdr", JOINTS, b"\x00\x01") is None
    assert decoder.decode("json", JOINTS, b"{") is None


def test_json_may_name_nanoseconds_as_either_ros_does():
    text = '{"header": {"stamp": {"sec": 1, "%s": 2}}, "name": ["a"], "position": [0.5]}'
    for name in ("nanosec", "nsec"):
        found = joint_reading(Decoder().decode("json", JOINTS, (text % name).encode()))
        assert found == JointReading(1_000_000_002, ("a",), (0.5,))
    late = text % "nsec"
    assert (
        joint_reading(Decoder().decode("json", JOINTS, late.replace("1", "1e30").encode())) is None
    )


def test_types_are_named_as_ros_2_does():
    assert ros_type("sensor_msgs/JointState") == "sensor_msgs/msg/JointState"
    assert ros_type("sensor_msgs/msg/JointState") == "sensor_msgs/msg/JointState"
    assert ros_type("Plain") == "Plain"
