"""Which encoder tells where a joint is: mimic joints follow the reading of another."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple, Self
from xml.etree import ElementTree

import numpy as np
from numpy.typing import ArrayLike

from handeye.arrays import Array, Integers, shaped
from handeye.errors import FileFormatError


class Follower(NamedTuple):
    """Of a mimic joint: it stands at gain q + offset, with q where the joint `leader` stands."""

    leader: str
    gain: float
    offset: float


@dataclass(frozen=True, eq=False)
class Readings:
    """A chain of n joints and the m encoders that are read: joint j stands at g_j q[of_j] + o_j.

    names    of the m joints that are read, in the order of every joint array
    of       (n,) number of the reading of each joint
    gains    g (n,), 1 of a joint that is read itself
    offsets  o (n,) [rad] or [m]
    """

    names: tuple[str, ...]
    of: Integers
    gains: Array
    offsets: Array

    @classmethod
    def of_chain(cls, joints: Sequence[str], followers: Mapping[str, Follower]) -> Self:
        """Of the joints of a chain; a follower's leader need not be among them.

        Raises:
            FileFormatError: for followers that follow each other in a circle.
        """
        led = [_leader(joint, followers) for joint in joints]
        names = tuple(dict.fromkeys(one.leader for one in led))
        return cls(
            names,
            np.array([names.index(one.leader) for one in led], np.int64),
            np.array([one.gain for one in led], np.float64),
            np.array([one.offset for one in led], np.float64),
        )

    def positions(self, readings: ArrayLike) -> Array:
        """Where the joints are, (N, n) [rad] or [m], at readings (N, m).

        Raises InvalidInput for readings of another shape.
        """
        q = shaped(readings, (None, len(self.names)), "joints")
        return q[:, self.of] * self.gains + self.offsets

    def ends(self, low: Array, high: Array) -> Array:
        """Where the joints are (2, n) when the readings are at low (m,) and at high (m,)."""
        return np.stack([low, high])[:, self.of] * self.gains + self.offsets

    def slopes(self, by_joints: Array) -> Array:
        """Derivatives (..., m) by readings of what changes by_joints (..., n) with each joint."""
        out = np.zeros((*by_joints.shape[:-1], len(self.names)))
        for j, (of, gain) in enumerate(zip(self.of.tolist(), self.gains.tolist(), strict=True)):
            out[..., of] += gain * by_joints[..., j]
        return out


def followers(urdf: str) -> dict[str, Follower]:
    """The mimic joints in the text of a URDF file that could be read, by name.

    Raises:
        FileFormatError: for a multiplier of 0.
    """
    return dict(map(_follower, ElementTree.fromstring(urdf).iterfind("joint[mimic]")))


def _follower(joint: ElementTree.Element) -> tuple[str, Follower]:
    name, mimic = joint.get("name", ""), joint.find("mimic")
    assert mimic is not None
    gain, offset = float(mimic.get("multiplier", "1")), float(mimic.get("offset", "0"))
    if gain == 0.0:
        raise FileFormatError(
            f"is not a usable URDF file (mimic joint {name} has the multiplier 0: a joint that "
            'never moves has the type "fixed")'
        )
    return name, Follower(mimic.get("joint", ""), gain, offset)


def _leader(joint: str, followers: Mapping[str, Follower]) -> Follower:
    """What is read of a joint, through followers of followers."""
    found, passed = Follower(joint, 1.0, 0.0), {joint}
    while found.leader in followers:
        leader, gain, offset = followers[found.leader]
        if leader in passed:
            raise FileFormatError(
                "is not a usable URDF file (mimic joints follow each other in a circle: "
                f"{', '.join(sorted(passed))})"
            )
        passed.add(leader)
        found = Follower(leader, found.gain * gain, found.gain * offset + found.offset)
    return found
