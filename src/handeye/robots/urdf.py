"""Arms described by URDF files, through pinocchio."""

from collections.abc import Collection
from difflib import get_close_matches
from functools import cache
from importlib import import_module
from importlib.metadata import PackageNotFoundError, distribution
from pathlib import Path
from typing import Any, Self
from xml.etree import ElementTree

import numpy as np
from numpy.typing import ArrayLike

from handeye.arrays import Array, shaped
from handeye.errors import FileFormatError, InvalidInput, MissingExtra
from handeye.robots.stages import Stages
from handeye.robots.tips import default_tip


class UrdfArm:
    """The chain of joints from the root of a URDF to one of its links; implements `Arm`.

    The base is the root link, the flange is `tip`. Without `tip` it is the end of the longest
    chain of moving joints: a link fixed there with a usual flange name (`flange`, `tool0`,
    `ee_link`, ...), or else the last moving link itself. Every angle is in radians, also of
    continuous joints. Joints off the chain rest at zero. Meshes are not needed.
    """

    def __init__(
        self, model: Any, tip: str, name: str, urdf: str, mimics: Collection[str] = ()
    ) -> None:
        self.tip = tip
        self.name = name
        self.urdf = urdf
        self._model = model
        self._data: Any = model.createData()
        # A joint may have the same name.
        self._tip = int(model.getFrameId(tip, _pinocchio().FrameType.BODY))
        chain = list(model.supports[model.frames[self._tip].parentJoint])[1:]
        self._chain: list[int] = chain
        self.joint_names = tuple(str(model.names[i]) for i in chain)
        joints = [model.joints[i] for i in chain]
        for joint, joint_name in zip(joints, self.joint_names, strict=True):
            if joint.nv != 1 or joint_name in mimics:
                raise InvalidInput(
                    f"{name}: joint {joint_name} on the way to {tip} is no revolute, continuous or "
                    "prismatic joint of its own: choose a link before it with --tip (in Python: "
                    "tip=)"
                )
        self._turns_freely = np.array([joint.nq == 2 for joint in joints], dtype=bool)
        self._at = np.array([joint.idx_q for joint in joints], dtype=np.int64)
        self._speed_at = np.array([joint.idx_v for joint in joints], dtype=np.int64)
        low, high = model.lowerPositionLimit[self._at], model.upperPositionLimit[self._at]
        # A limit that the file leaves out reads as 0 <= q <= 0.
        unlimited = self._turns_freely | (low >= high)
        self.lower: Array = np.where(unlimited, -np.inf, low)
        self.upper: Array = np.where(unlimited, np.inf, high)
        # All links stretched in one line, sliding joints far out: nothing is farther away.
        stages = self.stages()
        travel = np.maximum(np.abs(self.lower), np.abs(self.upper))[stages.slides]
        lengths = np.linalg.norm(stages.placements[:, :3, 3], axis=1)
        self.reach = float(lengths.sum() + travel.sum())

    @classmethod
    def from_file(cls, path: Path | str, tip: str | None = None) -> Self:
        """The arm in a URDF file.

        Raises:
            InvalidInput: when there is no such file, no such link, or several tips are possible.
            FileFormatError: when the file is no URDF.
            MissingExtra: without pinocchio.
        """
        return cls._load(Path(path), tip, Path(path).stem)

    @classmethod
    def shipped(cls, name: str, tip: str | None = None) -> Self:
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
        return cls._load(robots[name], tip, name)

    @classmethod
    def _load(cls, path: Path, tip: str | None, name: str) -> Self:
        if not path.is_file():
            raise InvalidInput(f"{path}: there is no such URDF file")
        try:
            return cls.from_text(path.read_text(encoding="utf-8"), tip, name)
        except (FileFormatError, UnicodeDecodeError) as error:
            raise FileFormatError(f"{path}: {error}") from error

    @classmethod
    def from_text(cls, urdf: str, tip: str | None, name: str) -> Self:
        """The arm in the text of a URDF file; raises as `from_file`."""
        pin = _pinocchio()
        try:
            followers = ElementTree.fromstring(urdf).iterfind("joint[mimic]")
            mimics = {follower.get("name", "") for follower in followers}
            model = pin.buildModelFromXML(urdf)
        except (ElementTree.ParseError, ValueError, RuntimeError) as error:
            raise FileFormatError(
                f"is not a usable URDF file ({error}); expand a xacro file with `xacro` first"
            ) from error
        bodies = [frame for frame in model.frames if frame.type == pin.FrameType.BODY]
        joints = {str(body.name): int(body.parentJoint) for body in bodies}
        if tip is None:
            tip = default_tip([list(way) for way in model.supports], joints, name)
        elif tip not in joints:
            near = get_close_matches(tip, joints, n=3, cutoff=0.5) or joints
            raise InvalidInput(f"{name} has no link {tip!r}: choose one of {', '.join(near)}")
        elif joints[tip] == 0:
            raise InvalidInput(
                f"{name}: no joint moves the link {tip!r}: choose one beyond a joint"
            )
        return cls(model, tip, name, urdf, mimics)

    def poses(self, joints: ArrayLike) -> Array:
        """T_base_flange (N, 4, 4) at joints (N, n) [rad]; raises InvalidInput for other shapes."""
        pin, model, data = _pinocchio(), self._model, self._data
        configurations = self._configurations(joints)
        out = np.empty((len(configurations), 4, 4))
        for pose, configuration in zip(out, configurations, strict=True):
            pin.forwardKinematics(model, data, configuration)
            pose[:] = pin.updateFramePlacement(model, data, self._tip).homogeneous
        return out

    def jacobians(self, joints: ArrayLike) -> Array:
        """Flange velocity per joint velocity (N, 6, n), linear rows first, in base axes.

        Raises InvalidInput for joints of another shape than (N, n).
        """
        pin, model, data = _pinocchio(), self._model, self._data
        configurations = self._configurations(joints)
        out = np.empty((len(configurations), 6, len(self.joint_names)))
        for jacobian, configuration in zip(out, configurations, strict=True):
            jacobian[:] = pin.computeFrameJacobian(
                model, data, configuration, self._tip, pin.LOCAL_WORLD_ALIGNED
            )[:, self._speed_at]
        return out

    def stages(self) -> Stages:
        """The constants of the chain from root to tip."""
        return Stages.of(self._model, self._chain, self._model.frames[self._tip])

    def loads(self, joints: ArrayLike) -> Array:
        """Torque of gravity about (force along) each joint's axis, (N, n) [Nm] or [N].

        From the masses in the file, with gravity along -z of the base; zero where it has none.
        Raises InvalidInput for joints of another shape than (N, n).
        """
        pin, model, data = _pinocchio(), self._model, self._data
        configurations = self._configurations(joints)
        out = np.empty((len(configurations), len(self.joint_names)))
        for load, configuration in zip(out, configurations, strict=True):
            load[:] = -pin.computeGeneralizedGravity(model, data, configuration)[self._speed_at]
        return out

    def _configurations(self, joints: ArrayLike) -> Array:
        """Pinocchio's own coordinates: (cos, sin) for a continuous joint, else the value."""
        q = shaped(joints, (None, len(self.joint_names)), "joints")
        out = np.tile(_pinocchio().neutral(self._model), (len(q), 1))
        free = self._turns_freely
        out[:, self._at] = np.where(free, np.cos(q), q)
        out[:, self._at[free] + 1] = np.sin(q[:, free])
        return out


def load_arm(spec: str, tip: str | None = None) -> UrdfArm:
    """The arm in a .urdf file, or the shipped robot of that name.

    Raises:
        InvalidInput, FileFormatError, MissingExtra: as `UrdfArm.from_file` and `UrdfArm.shipped`.
    """
    if Path(spec).suffix == ".urdf" or Path(spec).is_file():
        return UrdfArm.from_file(spec, tip)
    return UrdfArm.shipped(spec, tip)


@cache
def shipped_robots() -> dict[str, Path]:
    """The URDF files of example-robot-data by name.

    The name is the file's, without `_robot` at its end (which wins over a file without); where
    two robots share one, the folder goes before it (`anymal_b_simple/anymal`).

    Raises:
        MissingExtra: when example-robot-data is not installed.
    """
    try:
        files = distribution("example-robot-data").files or []
    except PackageNotFoundError as error:
        raise MissingExtra("a robot known by name", "robots") from error
    paths = [Path(str(file.locate())) for file in files if file.suffix == ".urdf"]
    paths = [path for path in paths if path.with_name(f"{path.stem}_robot.urdf") not in paths]
    short = [path.stem.removesuffix("_robot") for path in paths]
    return {
        name if short.count(name) == 1 else f"{_package(path)}/{name}": path
        for name, path in zip(short, paths, strict=True)
    }


def _package(path: Path) -> str:
    return path.parents[1].name.removesuffix("_description")


@cache
def _pinocchio() -> Any:
    try:
        return import_module("pinocchio")
    except ImportError as error:
        raise MissingExtra("a robot described by a URDF file", "robots") from error
