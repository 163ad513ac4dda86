"""The calibrator to use by default: the whole chain, with a learned function for each stage."""

from dataclasses import replace
from typing import Any

import numpy as np

from handeye.arrays import Array, count
from handeye.calibration.calibrator import Feedback
from handeye.calibration.combined.guard import Comparison
from handeye.calibration.combined.leftover import Leftover
from handeye.calibration.combined.robots import Model, Sheet, default_sheet, robot_of
from handeye.calibration.engine.design import hand_slopes, without_gauges
from handeye.calibration.engine.engine import Engine
from handeye.calibration.engine.events import Event, Kind
from handeye.calibration.engine.knowledge import RobotKnowledge, health, robot_knowledge
from handeye.calibration.engine.robot import Acting
from handeye.calibration.engine.settings import Settings
from handeye.calibration.engine.suggestion import Suggestion, best_pose
from handeye.errors import InvalidInput
from handeye.observations import Observation, Target


class Combined:
    """Learns a robot's parameters, and for each stage a small function of its own variable.

    What remains after that is left to a network over the full input, which is used only where it
    has proved itself. Observations that no hypothesis believes are left out; a run of surprises is
    recognised as a change, attributed to a part, and re-learned. Commands stay in an envelope
    around nominal ones, and fall back to them while they are worse. Every observation costs the
    same; none is kept for longer than the window.

    Args:
        model: nominal kinematics: a `PlanarModel`, or the `PlacedArm` of a URDF file.
        sheet: how far the robot may be from nominal: a `DataSheet`, or an `ArmSheet`.
        settings: how to learn; by default as suits the kind of robot.

    Raises:
        InvalidInput: a model of another kind, a sheet of another robot, or a nominal plant that
            drifts.
    """

    def __init__(
        self, model: Model, sheet: Sheet | None = None, settings: Settings | None = None
    ) -> None:
        self.model = model
        self.sheet = default_sheet(model) if sheet is None else sheet
        self.robot = robot_of(model, self.sheet)
        self.settings = settings or self.robot.settings
        self.engine = Engine(self.robot.chain, self.settings, self.robot.doubt)
        self.leftover = Leftover(
            self.robot.space, self.robot.n_outputs, self.settings.capacity, self.settings.chance
        )
        self.comparison = Comparison(self.settings.recent, self.settings.chance)
        self.falling_back = False
        self.known = 0
        self.past: tuple[Event, ...] = ()

    def begin(self, x: Array, root: Array, doubt: float, n: int) -> None:
        """Start with what n observations told, as the prior of what comes.

        x (n_x,) the estimate; root (n_x, n_x) upper triangular, root^T root the information in
        tolerances; doubt: what the model leaves unexplained.
        """
        engine = self.engine
        engine.x[:] = x
        scaled = x / engine.chain.tolerance
        engine.bank.roots[:] = np.column_stack([root, root @ scaled])
        engine.bank.olds[:] = engine.bank.roots
        engine.bank.d[:] = scaled
        engine.doubt = max(doubt, self.robot.doubt[1])
        self.known = n

    @property
    def n_observations(self) -> int:
        """So far, believed or not."""
        return self.known + self.engine.n_observations

    @property
    def events(self) -> tuple[Event, ...]:
        """What the comparator noticed, oldest first; the latest thousand."""
        since = (replace(e, observation=e.observation + self.known) for e in self.engine.events)
        return (*self.past, *since)

    @property
    def parameters(self) -> Array:
        """The estimate of all that is no curve, in the order of `knowledge`.

        Of the planar robot (8,) in the order of estimation.NAMES: [m], [rad], and a number.
        """
        chain = self.engine.chain
        return (chain.nominal + self.engine.x)[~chain.curved]

    @property
    def plant(self) -> Any:
        """The nominal robot with the estimated parameters; it has none of the learned curves.

        A `PlanarPlant`, or a `CorrectedArm`.
        """
        return self.robot.corrected(self.engine.x)

    def knowledge(self) -> RobotKnowledge:
        """Every unknown with its uncertainty, by parts, and what is not determined."""
        return robot_knowledge(self.engine)

    def health(self) -> str:
        """The state of the robot in words."""
        if self.known and not self.engine.n_observations:
            back = "; commands are nominal: what was learned was worse" if self.falling_back else ""
            left = f"about {self.engine.doubt:.2g} m is left"
            return f"{self.known} observations, all of them fitted at once; {left}{back}"
        return health(self.engine, self.falling_back, self.leftover.proved)

    def observe(self, observation: Observation) -> Feedback:
        """Learn from one observation; report the error made before learning."""
        if observation.joints.ndim != 1:
            raise InvalidInput("observe needs one observation; for N of them use observe_many")
        return self._learn(self.robot.seen_rows(observation))

    def observe_many(self, observations: Observation) -> Feedback:
        """Learn from N observations in order: the same result as one by one."""
        if observations.joints.ndim != 2:
            raise InvalidInput("observe_many needs a leading axis; for one observation use observe")
        n, m = len(observations), self.engine.chain.n_hand
        error, allocated = np.empty((n, m)), np.empty(n, np.bool_)
        for i, seen in enumerate(self.robot.seen_rows(observations)):
            error[i], allocated[i] = self._learn(seen)
        return Feedback(error, allocated)

    def errors(self, observations: Observation) -> Array:
        """Errors (N, m) [m] on N observations as it is, learning nothing."""
        return self.robot.errors(self._acting(), self.robot.seen_rows(observations))

    def command(self, target: Target) -> Array:
        """Joint commands (encoder readings) for one target or N."""
        rows = self.robot.target_rows(target)
        if rows.ndim == 1:
            return self.robot.commands(self._acting(), rows[np.newaxis])[0]
        return self.robot.commands(self._acting(), rows)

    def covariance(self, target: Target, *, noise: bool = False) -> Array:
        """How far the hand may miss a target: (m, m) or (N, m, m) [m^2].

        In the base frame of the planar robot, in the sensor's frame of others. From what is not
        known of the robot; with `noise`, the sensor's noise in the sighting of the target as well.
        The standard deviation along an axis is the root of the diagonal.
        """
        rows = self.robot.target_rows(target)
        out = self._covariance(np.atleast_2d(rows), noise)
        return out[0] if rows.ndim == 1 else out

    def suggest(
        self, region: Any = None, working_points: Target | None = None, candidates: int = 400
    ) -> Suggestion:
        """The next pose, of the hand and of the eye beside it, that most helps the work.

        Args:
            region: where the arm may go: a `Region` of the planar robot; for others the joints (C,
                n) to choose from, which a camera can see. By default all of the working range.
            working_points: where the hand must be accurate; by default the whole region.
            candidates: poses to choose from.

        Raises:
            InvalidInput: no working points or no candidates.
        """
        poses, rows = self.robot.candidates(self.engine.x, region, count(candidates, "candidates"))
        if working_points is None:
            tasks = self.robot.candidates(self.engine.x, region, 64)[1][:64]
        else:
            tasks = self._tasks(np.atleast_2d(self.robot.target_rows(working_points)))
        return best_pose(self.engine, poses, rows, tasks)

    def __repr__(self) -> str:
        """How much was observed, and the state."""
        return f"Combined({self.health()})"

    def _learn(self, seen: Array) -> Feedback:
        engine, settings, leftover = self.engine, self.settings, self.leftover
        settled = self.n_observations >= 2 * settings.window
        judged = self.robot.judge(engine.x, seen, settings.envelope)
        inputs, left = self.robot.inputs(seen, judged), judged.misses[1]
        shift = leftover.used(inputs[np.newaxis])[0]
        error = judged.misses[0] if self.falling_back else left - shift
        self._compare(*(float(np.linalg.norm(miss)) for miss in (left - shift, judged.misses[0])))
        # What the network explains must not be learned a second time, as a drift of the model.
        explained = self.robot.explained(seen, shift) if leftover.proved else seen
        proved, allocated = leftover.proved, False
        if engine.learn(explained) and settled and (proved or engine.leaves_something):
            allocated = leftover.learn(inputs, left)
            if leftover.proved != proved:
                self._tell("network", "no longer used" if proved else "used: it has proved itself")
        return Feedback(error, np.bool_(allocated))  # pyright: ignore[reportArgumentType]

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
        self.engine.events.append(Event(self.engine.n_observations, kind, "", done))

    def _acting(self) -> Acting:
        """Nominal while falling back."""
        if self.falling_back:
            return Acting(np.zeros_like(self.engine.x), None, self.settings.envelope)
        return self._corrected()

    def _corrected(self) -> Acting:
        network = self.leftover.used if self.leftover.proved else None
        return Acting(self.engine.x, network, self.settings.envelope)

    def _tasks(self, rows: Array) -> Array:
        """Sightings (N, w) of the hand at targets, with the joints that would be commanded."""
        if not len(rows):
            raise InvalidInput("suggest needs at least one working point")
        return self.robot.posed_rows(rows, self.robot.commands(self._acting(), rows))

    def _covariance(self, rows: Array, noise: bool) -> Array:
        engine, chain = self.engine, self.engine.chain
        seen = self.robot.posed_rows(rows, self.robot.commands(self._acting(), rows))
        gauges = engine.rules.gauges[engine.flexible()]
        scaled = engine.covariance() / np.outer(chain.tolerance, chain.tolerance)
        m, k, n = chain.n_hand, chain.n_values, len(engine.x)
        out = np.empty((len(rows), m, m))
        by, hand, to_metres = np.empty((k, n)), np.empty((m, n)), np.empty((m, k))
        for i, row in enumerate(seen):
            hand_slopes(
                chain.kernel, engine.x, chain.tolerance, row, engine.doubt, by, hand, to_metres
            )
            without_gauges(hand, gauges)
            out[i] = hand @ scaled @ hand.T + (to_metres @ to_metres.T if noise else 0.0)
        return out
