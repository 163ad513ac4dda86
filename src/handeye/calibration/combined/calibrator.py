"""The calibrator to use by default: the whole chain, with a learned function for each stage."""

import numpy as np

from handeye.arrays import Array
from handeye.calibration.calibrator import Feedback
from handeye.calibration.combined.acting import act_many, judge, missed
from handeye.calibration.combined.design import (
    Suggestion,
    hand_slopes,
    without_gauges,
)
from handeye.calibration.combined.engine import Engine
from handeye.calibration.combined.events import Event, Kind
from handeye.calibration.combined.guard import Comparison
from handeye.calibration.combined.knowledge import RobotKnowledge, health, robot_knowledge
from handeye.calibration.combined.leftover import Leftover
from handeye.calibration.combined.planar import planar_chain, seen_rows, target_rows
from handeye.calibration.combined.planar_kernels import PARAMETERS
from handeye.calibration.combined.settings import Settings
from handeye.calibration.combined.sheet import DataSheet
from handeye.calibration.combined.suggesting import best_pose, sightings_of
from handeye.calibration.estimation.parameters import plant_with
from handeye.calibration.models import PlanarModel
from handeye.calibration.plant import PlanarPlant
from handeye.calibration.world import Region
from handeye.errors import InvalidInput
from handeye.geometry.angles import wrap
from handeye.observations import StereoObservation, StereoTarget


class Combined:
    """Learns a planar robot's parameters, and for each stage a small function of its own variable.

    What remains after that is left to a network over the full input, which is used only where it
    has proved itself. Observations that no hypothesis believes are left out; a run of surprises is
    recognised as a change, attributed to a part, and re-learned. Commands stay in an envelope
    around nominal ones, and fall back to them while they are worse. Every observation costs the
    same; none is kept for longer than the window.

    Args:
        model: nominal kinematics; its head says how noisy sightings are.
        sheet: how far the robot may be from nominal.
        settings: how to learn.

    Raises:
        InvalidInput: a model of another kind, one that foveates, or a nominal plant that drifts.
    """

    def __init__(
        self, model: PlanarModel, sheet: DataSheet | None = None, settings: Settings | None = None
    ) -> None:
        if not isinstance(model, PlanarModel):  # pyright: ignore[reportUnnecessaryIsInstance]
            raise InvalidInput(
                f"Combined needs a PlanarModel so far, got a {type(model).__name__}; use a "
                "NetworkCorrection for other robots"
            )
        self.model = model
        self.sheet = sheet or DataSheet()
        self.settings = settings or Settings()
        doubt = (self.sheet.unexplained, self.sheet.resolution)
        self.engine = Engine(planar_chain(model, self.sheet), self.settings, doubt)
        space = PlanarModel(model.nominal).space
        self.leftover = Leftover(space, 2, self.settings.capacity, self.settings.chance)
        self.comparison = Comparison(self.settings.recent, self.settings.chance)
        self.falling_back = False

    @property
    def n_observations(self) -> int:
        """So far, believed or not."""
        return self.engine.n_observations

    @property
    def events(self) -> tuple[Event, ...]:
        """What the comparator noticed, oldest first; the latest thousand."""
        return tuple(self.engine.events)

    @property
    def parameters(self) -> Array:
        """The estimate (8,) in the order of estimation.NAMES: [m], [rad], and a number."""
        return self.engine.chain.nominal[:PARAMETERS] + self.engine.x[:PARAMETERS]

    @property
    def plant(self) -> PlanarPlant:
        """The nominal plant with the estimated parameters; it has none of the learned curves."""
        return plant_with(self.model.nominal, self.parameters)

    def knowledge(self) -> RobotKnowledge:
        """Every unknown with its uncertainty, by parts, and what is not determined."""
        return robot_knowledge(self.engine)

    def health(self) -> str:
        """The state of the robot in words."""
        return health(self.engine, self.falling_back, self.leftover.proved)

    def observe(self, observation: StereoObservation) -> Feedback:
        """Learn from one observation; report the error made before learning."""
        if observation.joints.ndim != 1:
            raise InvalidInput("observe needs one observation; for N of them use observe_many")
        return self._learn(seen_rows(observation))

    def observe_many(self, observations: StereoObservation) -> Feedback:
        """Learn from N observations in order: the same result as one by one."""
        if observations.joints.ndim != 2:
            raise InvalidInput("observe_many needs a leading axis; for one observation use observe")
        n = len(observations)
        error, allocated = np.empty((n, 2)), np.empty(n, np.bool_)
        for i, seen in enumerate(seen_rows(observations)):
            error[i], allocated[i] = self._learn(seen)
        return Feedback(error, allocated)

    def errors(self, observations: StereoObservation) -> Array:
        """Errors (N, 2) [m] on N observations as it is, learning nothing."""
        joints = self._commands(target_rows(observations.target))
        out = np.empty((len(observations), 2))
        for i, seen in enumerate(seen_rows(observations)):
            missed(self.engine.chain.kernel, seen, joints[i], out[i])
        return out

    def command(self, target: StereoTarget) -> Array:
        """Joint commands (encoder readings) for one target or N."""
        rows = target_rows(target)
        return self._commands(rows) if rows.ndim == 2 else self._commands(rows[np.newaxis])[0]

    def covariance(self, target: StereoTarget, *, noise: bool = False) -> Array:
        """How far the hand may miss a target, in the base frame: (2, 2) or (N, 2, 2) [m^2].

        From what is not known of the robot; with `noise`, the sensor's noise in the sighting of
        the target as well. The standard deviation along an axis is the root of the diagonal.
        """
        rows = target_rows(target)
        if rows.ndim == 1:
            return self._covariance(rows[np.newaxis], noise)[0]
        return self._covariance(rows, noise)

    def suggest(
        self, region: Region | None = None, working_points: StereoTarget | None = None,
        candidates: int = 400,
    ) -> Suggestion:  # fmt: skip
        """The next pose, of the hand and of the eye beside it, that most helps the work.

        Args:
            region: where the arm may go; its limits are the joints' limits.
            working_points: where the hand must be accurate; by default the whole region.
            candidates: poses to choose from.

        Raises:
            InvalidInput: no working points or no candidates.
        """
        where = Region() if region is None else region
        poses, rows = sightings_of(self.engine, where, candidates)
        if working_points is None:
            tasks = sightings_of(self.engine, where, 64)[1]
        else:
            tasks = self._tasks(working_points)
        return best_pose(self.engine, poses, rows, tasks)

    def __repr__(self) -> str:
        """How much was observed, and the state."""
        return f"Combined({self.health()})"

    def _inputs(self, joints: Array, seen: Array) -> Array:
        """What the network is told (N, 5): learned command, pointing, range, eccentricity."""
        return np.concatenate([joints, seen[:, 2:]], axis=1)

    def _learn(self, seen: Array) -> Feedback:
        engine, settings = self.engine, self.settings
        kernel, settled = engine.chain.kernel, self.n_observations >= 2 * settings.window
        joints, misses = np.empty((2, 2)), np.empty((2, 2))
        judge(kernel, engine.x, seen, settings.envelope, joints, misses)
        lengths = np.hypot(misses[:, 0], misses[:, 1])
        corrected, allocated = misses[1], False
        if self.leftover.proved:
            corrected = self._miss_with_network(seen)
        error = misses[0] if self.falling_back else corrected
        self._compare(float(np.hypot(corrected[0], corrected[1])), float(lengths[0]))
        if engine.learn(seen) and settled and self.leftover.network and engine.leaves_something:
            inputs = self._inputs(joints[1:], seen[np.newaxis])[0]
            extra, allocated = self.leftover.learn(inputs, wrap(seen[:2] - joints[1]))
            helped = np.empty(2)
            missed(kernel, seen, joints[1] + extra, helped)
            proved = self.leftover.proved
            self.leftover.judge(float(lengths[1]), float(np.hypot(helped[0], helped[1])))
            if self.leftover.proved != proved:
                self._tell("network", "no longer used" if proved else "used: it has proved itself")
        return Feedback(error, np.bool_(allocated))  # pyright: ignore[reportArgumentType]

    def _miss_with_network(self, seen: Array) -> Array:
        """Error (2,) of the command with the network, for a sighting of the hand (5,)."""
        row, out = seen.copy(), np.empty(2)
        row[:2] = 0.0, np.where(seen[1] >= 0.0, 1.0, -1.0)
        missed(self.engine.chain.kernel, seen, self._corrected(row[np.newaxis])[0], out)
        return out

    def _compare(self, corrected: float, nominal: float) -> None:
        """Fall back to nominal commands while corrected ones are worse beyond chance."""
        self.comparison.add(corrected, nominal)
        if self.falling_back and self.comparison.significance < 0.0:
            self.falling_back = False
            self._tell("recovered", "corrected commands again")
        elif not self.falling_back and self.comparison.a_is_worse:
            self.falling_back = True
            self._tell("fallback", "nominal commands until corrections are better again")

    def _tell(self, kind: Kind, done: str) -> None:
        self.engine.events.append(Event(self.n_observations, kind, "", done))

    def _commands(self, rows: Array) -> Array:
        """Readings (N, 2) for sightings (N, 5), nominal while falling back."""
        if self.falling_back:
            return self._acted(np.zeros_like(self.engine.x), np.zeros((len(rows), 2)), rows)
        return self._corrected(rows)

    def _corrected(self, rows: Array) -> Array:
        joints = self._acted(self.engine.x, np.zeros((len(rows), 2)), rows)
        if not self.leftover.proved:
            return joints
        return self._acted(self.engine.x, self.leftover.used(self._inputs(joints, rows)), rows)

    def _acted(self, x: Array, extra: Array, rows: Array) -> Array:
        joints, held = np.empty((len(rows), 2)), np.zeros(len(rows), np.bool_)
        kernel, envelope = self.engine.chain.kernel, self.settings.envelope
        act_many(kernel, x, extra, rows, envelope, joints, held)
        return joints

    def _tasks(self, target: StereoTarget) -> Array:
        """Sightings (N, 5) of the hand at targets, with the joints that would be commanded."""
        rows = np.atleast_2d(target_rows(target)).copy()
        if not len(rows):
            raise InvalidInput("suggest needs at least one working point")
        rows[:, :2] = self._commands(rows)
        return rows

    def _covariance(self, rows: Array, noise: bool) -> Array:
        engine, chain = self.engine, self.engine.chain
        seen = rows.copy()
        seen[:, :2] = self._commands(rows)
        gauges = engine.rules.gauges[engine.flexible()]
        scaled = engine.covariance() / np.outer(chain.tolerance, chain.tolerance)
        out = np.empty((len(rows), 2, 2))
        by, hand = np.empty((2, len(engine.x))), np.empty((2, len(engine.x)))
        to_metres = np.empty((2, 2))
        for i, row in enumerate(seen):
            hand_slopes(
                chain.kernel, engine.x, chain.tolerance, row, engine.doubt, by, hand, to_metres
            )
            without_gauges(hand, gauges)
            out[i] = hand @ scaled @ hand.T + (to_metres @ to_metres.T if noise else 0.0)
        return out
