"""Arms described by URDF files, through pinocchio."""

from difflib import get_close_matches
from functools import cache
from importlib import import_module
from pathlib import Path
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from handeye.arrays import Array, Booleans
from handeye.errors import FileFormatError, InvalidInput, MissingExtra
from handeye.robots.moving import ends_in, limits, links_in, refuse_unless_single, unusable
from handeye.robots.readings import Readings, followers
from handeye.robots.shipped import shipped_robots
from handeye.robots.stages import Stages
from handeye.robots.ways import Way

FREE_TRAVEL = 1.0
"""Of a sliding joint without limits [m]."""


class UrdfArm:
    """The chain of joints from one link of a URDF to another; implements `Arm`.

    The base is the link `eye`, by default the root; the flange is `tip`. The eye is the link to
    which the sensor is fixed: a pan-tilt head that looks at a hand, a flange that carries a camera.
    The chain then leads from it through the tree, and joints on the eye's own side enter inverted.

    Without `tip` it is the end of the longest chain of moving joints: a link fixed there with a
    usual flange name (`flange`, `tool0`, `ee_link`, ...), or else the last moving link itself. If
    that is where the eye is, it is the root: the marker stands beside the robot.

    Every angle is in radians, also of continuous joints. A mimic joint stands where the joint that
    it follows says. Joints off the chain rest at zero. Meshes are not needed.
    """

    def __init__(self, model: Any, tip: str, name: str, urdf: str, eye: str | None = None) -> None:
        self.tip = tip
        self.eye = eye
        self.name = name
        self.urdf = urdf
        self._model = model
        self._data: Any = model.createData()
        # A joint may have the same name.
        body = _pinocchio().FrameType.BODY
        self.base = eye or next(iter(links_in(model)))
        self._tip = int(model.getFrameId(tip, body))
        self._eye = None if eye is None else int(model.getFrameId(eye, body))
        ends = (0 if i is None else model.frames[i].parentJoint for i in (self._eye, self._tip))
        self._way = Way.between(*(list(model.supports[joint]) for joint in ends))
        chain = self._way.joints
        self.stage_names = tuple(str(model.names[i]) for i in chain)
        self.readings = Readings.of_chain(self.stage_names, followers(urdf))
        for joint in dict.fromkeys((*self.stage_names, *self.readings.names)):
            refuse_unless_single(model, joint, name, tip)
        joints = [model.joints[i] for i in chain]
        self._turns_freely = np.array([joint.nq == 2 for joint in joints], dtype=bool)
        self._at = np.array([joint.idx_q for joint in joints], dtype=np.int64)
        self._speed_at = np.array([joint.idx_v for joint in joints], dtype=np.int64)
        self.lower, self.upper = limits(model, self.readings.names)
        ends = self.readings.ends(self.lower, self.upper)
        unlimited = ~np.isfinite(ends).all(axis=0)
        self.travel: Array = np.where(unlimited, FREE_TRAVEL, np.abs(ends[1] - ends[0]))
        # All links stretched in one line, sliding joints far out: nothing is farther away.
        stages = self.stages()
        self.sliding: Booleans = np.zeros(len(self.readings.names), np.bool_)
        self.sliding[self.readings.of] = stages.slides
        far = np.where(unlimited, FREE_TRAVEL, np.max(np.abs(ends), axis=0))[stages.slides]
        lengths = np.linalg.norm(stages.placements[:, :3, 3], axis=1)
        self.reach = float(lengths.sum() + far.sum())

    @classmethod
    def from_file(cls, path: Path | str, tip: str | None = None, eye: str | None = None) -> Self:
        """The arm in a URDF file.

        Raises:
            InvalidInput: when there is no such file, no such link, or several tips are possible.
            FileFormatError: when the file is no URDF.
            MissingExtra: without pinocchio.
        """
        return cls._load(Path(path), tip, Path(path).stem, eye)

    @classmethod
    def shipped(cls, name: str, tip: str | None = None, eye: str | None = None) -> Self:
        """A robot that example-robot-data ships, for example "ur10".

        Raises:
            InvalidInput: for an unknown name (the message lists all), no such link, or several
                possible tips.
            MissingExtra: without pinocchio or example-robot-data.
        """
        robots = shipped_robots()
        if name not in robots:
            near = get_close_matches(name, robots, n=3)
            meant = f"; did you mean {' or '.join(near)}?" if near else ""
            raise InvalidInput(
                f"no robot is called {name!r}{meant}\n  shipped: {', '.join(sorted(robots))}\n"
                "  or give the path of a .urdf file"
            )
        return cls._load(robots[name], tip, name, eye)

    @classmethod
    def _load(cls, path: Path, tip: str | None, name: str, eye: str | None) -> Self:
        if not path.is_file():
            raise InvalidInput(f"{path}: there is no such URDF file")
        try:
            return cls.from_text(path.read_text(encoding="utf-8"), tip, name, eye)
        except (FileFormatError, UnicodeDecodeError) as error:
            raise FileFormatError(f"{path}: {error}") from error

    @classmethod
    def from_text(cls, urdf: str, tip: str | None, name: str, eye: str | None = None) -> Self:
        """The arm in the text of a URDF file; raises as `from_file`."""
        try:
            model = _pinocchio().buildModelFromXML(urdf)
        except (ValueError, RuntimeError) as error:
            raise FileFormatError(unusable(urdf, error)) from error
        ends = ends_in(model, name, tip, eye)
        return cls(model, ends.tip, name, urdf, ends.eye)

    def between(self, tip: str | None = None, eye: str | None = None) -> Self:
        """Another chain through the same robot, from the link `eye` to the link `tip`.

        By default from where this one begins, and to where it ends.

        Raises:
            InvalidInput: no such link, or links that no joint moves against each other.
        """
        wanted = tip or self.tip, eye or self.base
        if wanted == (self.tip, self.base):
            return self
        ends = ends_in(self._model, self.name, *wanted)
        return type(self)(self._model, ends.tip, self.name, self.urdf, ends.eye)

    @property
    def held(self) -> Booleans:
        """(m,) which joints stay where they are when the marker is brought to a place.

        Those that move the eye, if others move the hand: a place is seen from where the eye is.
        """
        out = np.zeros(len(self.joint_names), np.bool_)
        out[self.readings.of[: len(self._way.up)]] = True
        return out & ~out.all()

    @property
    def joint_names(self) -> tuple[str, ...]:
        """Of the joints that are read, in the order of every joint array."""
        return self.readings.names

    def poses(self, joints: ArrayLike) -> Array:
        """T_base_flange (N, 4, 4) at joints (N, m); raises InvalidInput for other shapes."""
        pin, model, data = _pinocchio(), self._model, self._data
        configurations = self._configurations(joints)
        out = np.empty((len(configurations), 4, 4))
        for pose, configuration in zip(out, configurations, strict=True):
            pin.forwardKinematics(model, data, configuration)
            place = pin.updateFramePlacement(model, data, self._tip)
            if self._eye is not None:
                place = pin.updateFramePlacement(model, data, self._eye).actInv(place)
            pose[:] = place.homogeneous
        return out

    def jacobians(self, joints: ArrayLike) -> Array:
        """Flange velocity per joint velocity (N, 6, m), linear rows first, in base axes.

        Raises InvalidInput for joints of another shape than (N, m).
        """
        pin, model, data = _pinocchio(), self._model, self._data
        configurations = self._configurations(joints)
        out = np.empty((len(configurations), 6, len(self._speed_at)))
        for jacobian, configuration in zip(out, configurations, strict=True):
            way = model, data, configuration
            by = pin.computeFrameJacobian(*way, self._tip, pin.LOCAL_WORLD_ALIGNED)
            if self._eye is not None:
                own = pin.computeFrameJacobian(*way, self._eye, pin.LOCAL_WORLD_ALIGNED)
                eye, tip = data.oMf[self._eye], data.oMf[self._tip]
                R, apart = eye.rotation.T, tip.translation - eye.translation
                carried = own[:3] + np.cross(own[3:], apart, axisa=0, axisc=0)
                by = np.vstack([R @ (by[:3] - carried), R @ (by[3:] - own[3:])])
            jacobian[:] = by[:, self._speed_at]
        return self.readings.slopes(out)

    def stages(self) -> Stages:
        """The constants of the chain from base to tip."""
        return Stages.of(self._model, self._way, self._place(self._eye), self._place(self._tip))

    def branches(self) -> tuple[Stages, Stages]:
        """From where both ends part in the tree, the constants of the way to base, and to tip.

        T_base_tip = T_base^-1 T_tip. Both lead away from the root; the first has the joints that
        move the base, in the opposite order, and the second the others.
        """
        ends = (self._way.up[::-1], self._eye), (self._way.down, self._tip)
        base, tip = (
            Stages.of(self._model, Way((), way), np.eye(4), self._place(end)) for way, end in ends
        )
        return base, tip

    def loads(self, joints: ArrayLike) -> Array:
        """Torque of gravity about (force along) each stage's axis, (N, n) [Nm] or [N].

        From the masses in the file, with gravity along -z of the root; zero where it has none.
        Raises InvalidInput for joints of another shape than (N, m).
        """
        pin, model, data = _pinocchio(), self._model, self._data
        configurations = self._configurations(joints)
        out = np.empty((len(configurations), len(self._speed_at)))
        for load, configuration in zip(out, configurations, strict=True):
            load[:] = -pin.computeGeneralizedGravity(model, data, configuration)[self._speed_at]
        return out

    def _place(self, frame: int | None) -> Array:
        """Of a link (4, 4), by default the root, in the frame of the joint that carries it."""
        if frame is None:
            return np.eye(4)
        return np.asarray(self._model.frames[frame].placement.homogeneous)

    def _configurations(self, joints: ArrayLike) -> Array:
        """Pinocchio's own coordinates: (cos, sin) for a continuous joint, else the value."""
        q = self.readings.positions(joints)
        out = np.tile(_pinocchio().neutral(self._model), (len(q), 1))
        free = self._turns_freely
        out[:, self._at] = np.where(free, np.cos(q), q)
        out[:, self._at[free] + 1] = np.sin(q[:, free])
        return out


def load_arm(spec: str, tip: str | None = None, eye: str | None = None) -> UrdfArm:
    """The arm in a .urdf file, or the shipped robot of that name.

    Raises:
        InvalidInput, FileFormatError, MissingExtra: as `UrdfArm.from_file` and `UrdfArm.shipped`.
    """
    if Path(spec).suffix == ".urdf" or Path(spec).is_file():
        return UrdfArm.from_file(spec, tip, eye)
    return UrdfArm.shipped(spec, tip, eye)


@cache
def _pinocchio() -> Any:
    try:
        return import_module("pinocchio")
    except ImportError as error:
        raise MissingExtra("a robot described by a URDF file", "robots") from error
