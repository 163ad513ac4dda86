"""Bytes of a message to an object with the fields of its type."""

import json
import struct
from importlib import import_module
from types import SimpleNamespace
from typing import Any, Literal

from handeye.errors import MissingExtra

Encoding = Literal["cdr", "ros1", "json"]
"""How the bytes of a message were made: by ROS 2, by ROS 1, or without ROS."""

UNREADABLE = (
    ArithmeticError,
    AssertionError,
    AttributeError,
    EOFError,
    LookupError,
    MemoryError,
    OSError,
    RuntimeError,
    TypeError,
    ValueError,
    struct.error,
)
"""What the libraries raise, besides their own errors, for bytes that make no sense."""


def ros_type(name: str) -> str:
    """The ROS 2 spelling of a message type: `sensor_msgs/JointState` has `/msg/` inserted."""
    package, slash, kind = name.rpartition("/")
    return name if not slash or package.endswith("/msg") else f"{package}/msg/{kind}"


class Decoder:
    """Messages of the types whose definitions it has been told, or that ROS itself defines.

    Every type has a store of its own, so that one bad definition spoils no other topic.
    """

    def __init__(self) -> None:
        self._typing = library("rosbags.typesys")
        serde = library("rosbags.serde")
        self._errors = (*UNREADABLE, serde.SerdeError, self._typing.TypesysError)
        self._definitions: dict[str, tuple[str, str]] = {}
        self._stores: dict[tuple[Encoding, str], Any] = {}

    def learn(self, kind: str, definition: str, language: Literal["msg", "idl"]) -> None:
        """Take the definition of message type `kind` from the file."""
        if definition:
            self._definitions[kind] = (definition, language)

    def decode(self, encoding: Encoding, kind: str, data: bytes) -> Any | None:
        """The message, or None where its bytes or its type make no sense."""
        try:
            if encoding == "json":
                return json.loads(data, object_hook=lambda fields: SimpleNamespace(**fields))
            store = self._store(encoding, kind)
            if encoding == "cdr":
                return store.deserialize_cdr(data, kind)
            return store.deserialize_ros1(data, kind)
        except self._errors:
            return None

    def _store(self, encoding: Encoding, kind: str) -> Any:
        key = (encoding, kind)
        if key not in self._stores:
            self._stores[key] = self._made(encoding, kind)
        return self._stores[key]

    def _made(self, encoding: Encoding, kind: str) -> Any:
        stores = self._typing.Stores
        if kind not in self._definitions:
            usual = stores.ROS2_HUMBLE if encoding == "cdr" else stores.ROS1_NOETIC
            return self._typing.get_typestore(usual)
        text, language = self._definitions[kind]
        store = self._typing.get_typestore(stores.EMPTY)
        if language == "msg":
            store.register(self._typing.get_types_from_msg(text, kind))
        else:
            for part in _idl_files(text):
                store.register(self._typing.get_types_from_idl(part))
        return store


def _idl_files(text: str) -> list[str]:
    """The IDL files of a definition, each headed by a line of `=` and its name, or the only one."""
    rule = "=" * 80 + "\n"
    if not text.startswith(f"{rule}IDL: "):
        return [text]
    return [part.split("\n", 1)[1] for part in text.split(rule)[1:]]


def library(name: str) -> Any:
    """A module of the extra `bags`.

    Raises:
        MissingExtra: when it is not installed.
    """
    try:
        return import_module(name)
    except ImportError as error:
        raise MissingExtra("a bag or MCAP file", "bags") from error
