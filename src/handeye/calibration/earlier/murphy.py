"""A hand-eye learner after MURPHY: a table from joints to image, searched for a target."""

import numpy as np

from handeye.arrays import Array, Booleans, count, scalar
from handeye.calibration.earlier import murphy_kernels as kernels
from handeye.calibration.earlier.whole_map import WholeMap
from handeye.calibration.models import PlanarMap
from handeye.errors import InvalidInput
from handeye.observations import StereoObservation, StereoTarget


class MurphyTable(WholeMap):
    """Sigma-pi units over coarsely coded joints envision where the hand would be (Mel 1989).

    Each joint's angle excites a population of overlapping Gaussian units, and so does each
    coordinate of the hand in the image. A sigma-pi unit multiplies one unit of either joint (eq
    A.4). When the hand is seen, every active sigma-pi unit is connected with every active image
    unit, at once and for good: a table. Asked where the hand would be at some angles, image units
    sum the sigma-pi units they are connected with, those far below the largest fall silent, and the
    others are read out. To reach a target the arm is moved in imagination, from the remembered pose
    that looked most like it, as long as the imagined hand comes nearer; only the result is
    commanded.

    What differs from the original: two joints for three, so that one target has two poses, of which
    the one with the wanted elbow is searched. The image is the plane that the arm moves in, which
    the head's range and direction give. Of the original's two ways to reach, this is the search
    with the forward map; its other way, small steps by a map of differences, needs to see the hand
    after each step, which a command does not. Poses come at random, not in an even sweep.

    Args:
        model: what is sensed; no kinematics.
        joint_units: in the population of either joint, from -travel to travel.
        image_step: distance of image units [m].
        width: of a unit's response, in steps from unit to unit, at most 1.
        on: units and products of units more active than this are connected.
        share: of the largest sum, below which an image unit falls silent.
        travel: largest angle of either joint [rad].

    Raises:
        InvalidInput: a setting out of range, or what is no observation; nothing has changed then.
    """

    def __init__(
        self,
        model: PlanarMap,
        *,
        joint_units: int = 64,
        image_step: float = 0.1,
        width: float = 1.0,
        on: float = 0.3,
        share: float = 0.3,
        travel: float = 0.8 * np.pi,
    ) -> None:
        super().__init__(model)
        n = count(joint_units, "joint_units", least=2)
        last = scalar(travel, "travel", above=0.0)
        step = scalar(image_step, "image_step", above=0.0)
        self.width, self.on = scalar(width, "width", above=0.0), scalar(on, "on", least=0.02)
        self.share = scalar(share, "share", least=0.0)
        if self.width > 1.0 or self.share >= 1.0:
            raise InvalidInput(f"width must be at most 1 and share below 1: {width}, {share}")
        if np.exp(-0.25 / self.width**2) <= self.on:
            raise InvalidInput(
                f"with a width of {width} no unit exceeds {on} between two of them: there are gaps"
            )
        nominal = model.nominal
        far = 1.05 * (nominal.arm.reach + float(np.hypot(nominal.v_x, nominal.v_y)))
        images = 1 + 2 * int(np.ceil(far / step))
        self.codes = kernels.Codes(
            -last, 2.0 * last / (n - 1), n, -0.5 * step * (images - 1), step, images,
            0.5 / self.width**2, self.on,
        )  # fmt: skip
        box = np.zeros((n, n, 4), np.int64)
        box[:, :, 0::2] = images
        self._table = kernels.Table(
            np.zeros((n, n, images, images), np.bool_), box, np.zeros((n, n, 3))
        )

    @property
    def n_connections(self) -> int:
        """Connections formed so far."""
        return int(self._table.sums[..., 0].sum())

    def envision(self, joints: Array) -> Array:
        """Where the hand would be seen with the arm at joints (N, 2): (N, 2) [m] from the eye.

        NaN where no active unit has a connection yet.
        """
        images = np.full((len(joints), 2), np.nan)
        total = np.zeros((self.codes.images, self.codes.images))
        for angles, image in zip(joints, images, strict=True):
            kernels.envision(self.codes, self._table, self.share, angles, total, image)
        return images

    def __repr__(self) -> str:
        """Size and state."""
        codes = self.codes
        return (
            f"MurphyTable({codes.joints**2} sigma-pi units, {codes.images**2} image units, "
            f"{self.n_connections} connections, {type(self.model).__name__})"
        )

    def _learn(self, observations: StereoObservation) -> tuple[Array, Booleans]:
        commanded = np.empty((len(observations), 2))
        new = np.empty(len(observations), np.int64)
        kernels.learn_stream(
            self.codes, self._table, self.share, _images(observations.target),
            observations.joints, commanded, new,
        )  # fmt: skip
        return commanded, new > 0

    def _command(self, targets: StereoTarget) -> Array:
        joints = np.empty((len(targets), 2))
        kernels.command_stream(
            self.codes, self._table, self.share, _images(targets), targets.elbow, joints
        )
        return joints


def _images(targets: StereoTarget) -> Array:
    """Where targets are seen in the plane, (N, 2) [m], the eye in the middle."""
    direction = targets.pointing + targets.eccentricity
    seen = [targets.range * np.cos(direction), targets.range * np.sin(direction)]
    return np.stack(seen, axis=-1)
