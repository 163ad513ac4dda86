"""The resource-allocating network: an online regressor that adds neurons where it is surprised."""

from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import ArrayLike

from handeye.arrays import Array, count, scalar, shaped
from handeye.errors import InvalidInput
from handeye.io.tensors import Parts
from handeye.networks import kernels
from handeye.networks.adaptation import RULES, VirtualNeuron
from handeye.networks.checked import CheckedLearner
from handeye.networks.inputs import InputSpace
from handeye.networks.kinds import checked_kind, restored_kind, stored_kind
from handeye.networks.outcomes import LearnedMany, LearningDiverged
from handeye.networks.responses import RESPONSES, Gaussian
from handeye.networks.schedules import SCHEDULES, Constant
from handeye.networks.units import (
    Settings,
    Units,
    allocate_units,
    allocate_work,
    moderate,
    restored,
    with_room,
)

_FIRST_SIZE = 64
_KINDS = {"response": RESPONSES, "schedule": SCHEDULES, "adaptation": RULES}


class ResourceAllocatingNetwork(CheckedLearner):
    """Learns a mapping from R^d to R^m, one sample at a time (Platt 1990; thesis section 3.5.1).

    The output is `sum_j w_j o_j(|x - c_j|)` (eq 3.58), zero where no neuron answers. For each
    sample with error e = target - output, a neuron that makes the output exact there is added if
    |e| > theta_e, the nearest center is farther than the schedule's theta_d, and there is room;
    otherwise, if |e| > theta_l, the adaptation rule adjusts the neurons that exist. The defaults
    are the preferred network of section 3.5.4.

    Args:
        n_inputs: d.
        n_outputs: m.
        inputs: the space of inputs, which gives distances their unit; by default every input is
            taken as it is and expected to span about one.
        response: Gaussian(), Cosine() or Parabolic().
        schedule: theta_d over the trials: Constant(0), Power(...), GaussianDecay, Logarithmic.
        adaptation: VirtualNeuron(), CMAC(), GradientDescent() or NoAdaptation().
        capacity: most neurons ever, or None to grow by doubling.
        half_max_fraction: h: a new neuron answers one half at h times the distance to its nearest
            neighbour.
        error_threshold: theta_e, in output units.
        learning_threshold: theta_l, in output units.
        first_width: half-maximum distance of the first neuron over h D (note E8).
        smallest_width: floor of every half-maximum distance, over D. Without it an input that
            repeats a center would give a neuron of no width.

    Raises:
        InvalidInput: a setting out of range, here or in any method an array of the wrong shape or
            type or with values that are not finite; nothing has changed then.
        LearningDiverged: in learning, at the first sample whose error is beyond 1e100; the samples
            before it are learned.
    """

    FORMAT = "handeye.network"

    def __init__(
        self,
        n_inputs: int,
        n_outputs: int,
        *,
        inputs: InputSpace | None = None,
        response: NamedTuple = Gaussian(),
        schedule: NamedTuple = Constant(),
        adaptation: NamedTuple = VirtualNeuron(),
        capacity: int | None = None,
        half_max_fraction: float = 1.2,
        error_threshold: float = 1e-3,
        learning_threshold: float = 1e-3,
        first_width: float = 0.1,
        smallest_width: float = 1e-6,
    ) -> None:
        super().__init__(n_inputs, n_outputs)
        space = InputSpace.scaled(np.ones(self.n_inputs)) if inputs is None else inputs
        self.inputs = space.of(self.n_inputs)
        self.response = checked_kind("response", response, RESPONSES)
        self.schedule = checked_kind("schedule", schedule, SCHEDULES)
        self.adaptation = checked_kind("adaptation", adaptation, RULES)
        self.capacity = None if capacity is None else count(capacity, "capacity")
        self.settings = Settings(
            half_max_fraction=scalar(half_max_fraction, "half_max_fraction", above=0.0),
            error_threshold=scalar(error_threshold, "error_threshold", least=0.0),
            learning_threshold=scalar(learning_threshold, "learning_threshold", least=0.0),
            first_width=scalar(first_width, "first_width", above=0.0),
            smallest_width=scalar(smallest_width, "smallest_width", least=1e-50),
            diameter=self.inputs.diameter,
        )
        self._n = 0
        self._units = allocate_units(self.n_inputs, self.n_outputs, self.capacity or _FIRST_SIZE)
        self._work = allocate_work(0)

    @property
    def n_neurons(self) -> int:
        """Neurons allocated so far."""
        return self._n

    @property
    def centers(self) -> Array:
        """Where the neurons are, (N, d) in input units; a copy."""
        return self._units.centers[:, : self._n].T * self.inputs.scales

    @property
    def widths(self) -> Array:
        """Width parameters R, (N,), in scaled units (squared for a Gaussian); a copy."""
        return self._units.widths[: self._n].copy()

    @property
    def weights(self) -> Array:
        """Output weights, (N, m) in output units; a copy."""
        return self._units.weights[:, : self._n].T.copy()

    @property
    def bytes_per_neuron(self) -> int:
        """Memory of a neuron: d centers, m weights and a width, in double precision.

        Learning uses another 48 bytes for each neuron there is room for, as scratch.
        """
        return 8 * (self.n_inputs + self.n_outputs + 1)

    def nearest(self, x: ArrayLike) -> float:
        """Distance from x (d,) to the closest center in scaled units; inf if there is none.

        The novelty of x: a controller can refuse to act on inputs far from all experience.
        """
        return float(self.nearest_many(shaped(x, (self.n_inputs,), "x")[np.newaxis])[0])

    def nearest_many(self, x: ArrayLike) -> Array:
        """The same for inputs (N, d): distances (N,)."""
        scaled = self.inputs.scaled_inputs(shaped(x, (None, self.n_inputs), "x"))
        distances = np.empty(len(scaled))
        kernels.nearest_stream(self._units, self._n, scaled, distances)
        return distances

    def place(self, centers: ArrayLike, targets: ArrayLike | None = None, *,
              weight: float = 0.0) -> None:  # fmt: skip
        """Add neurons at centers (N, d), whatever the thresholds; no trial is counted.

        With targets (N, m) the output at each center becomes its target (eq 3.46), as when the
        robot visits the points of a grid in order; otherwise all output weights are `weight`.
        Widths follow from the nearest neighbour as in allocation.

        Raises:
            InvalidInput: also if the capacity does not suffice; nothing has changed then.
        """
        points = shaped(centers, (None, self.n_inputs), "centers")
        shape = (len(points), self.n_outputs)
        if targets is None:
            values = np.full(shape, scalar(weight, "weight"))
        else:
            values = shaped(targets, shape, "targets")
        if self.capacity is not None and self._n + len(points) > self.capacity:
            raise InvalidInput(
                f"{len(points)} more neurons than the {self._n} there are exceed the capacity of "
                f"{self.capacity}: give a larger capacity or fewer centers"
            )
        scaled, values = self.inputs.scaled_inputs(points), moderate(values, "targets and weight")
        self._units = with_room(self._units, self._n, self._n + len(points))
        self._n = kernels.place_stream(
            self.response, self.settings, self._units, self._n, scaled, values, targets is not None
        )

    def __repr__(self) -> str:
        """Shape, state and kinds."""
        limit = "unlimited" if self.capacity is None else f"at most {self.capacity}"
        return (
            f"ResourceAllocatingNetwork({self.n_inputs} inputs, {self.n_outputs} outputs, "
            f"{self._n} neurons of {limit}, {self._trials} trials, "
            f"{self.response!r}, {self.schedule!r}, {self.adaptation!r})"
        )

    def _inputs(self, x: Array) -> Array:
        return self.inputs.scaled_inputs(x)

    def _predict(self, inputs: Array) -> Array:
        outputs = np.empty((len(inputs), self.n_outputs))
        kernels.predict_stream(self.response, self._units, self._n, inputs, outputs)
        return outputs

    def _learn(self, inputs: Array, targets: Array) -> LearnedMany:
        errors = np.empty_like(targets)
        allocated = np.zeros(len(inputs), np.bool_)
        state = (0, self._n, self._trials)
        while state[0] < len(inputs):
            if self.capacity is None:
                self._units = with_room(self._units, self._n, self._n + 1)
            if self._work.z.size != self._units.widths.size:
                self._work = allocate_work(self._units.widths.size)
            done = state[0]
            state = kernels.learn_stream(
                self.response, self.schedule, self.adaptation, self.settings, self._units,
                self._work, state, self.capacity is None, inputs, targets, errors, allocated,
            )  # fmt: skip
            _, self._n, self._trials = state
            if state[0] == done:
                raise LearningDiverged(
                    f"the error at sample {done} is beyond all bounds: {self.adaptation!r} "
                    "diverged. Learn again from a saved network with a smaller rate."
                )
        return LearnedMany(errors, allocated)

    def _parts(self) -> Parts:
        n, units = self._n, self._units
        arrays = {
            "centers": units.centers[:, :n],
            "widths": units.widths[:n],
            "weights": units.weights[:, :n],
            **self.inputs.arrays,
        }
        rest: dict[str, Any] = {
            "capacity": self.capacity,
            "settings": {k: v for k, v in self.settings._asdict().items() if k != "diameter"},
        }
        return arrays, rest | {role: stored_kind(getattr(self, role)) for role in _KINDS}

    @classmethod
    def _restored(cls, arrays: dict[str, Array], rest: dict[str, Any]) -> Self:
        kinds = {role: restored_kind(role, rest[role], known) for role, known in _KINDS.items()}
        network = cls(
            len(arrays["centers"]),
            len(arrays["weights"]),
            inputs=InputSpace.of_arrays(arrays),
            capacity=rest["capacity"],
            **kinds,
            **rest["settings"],
        )
        units = Units(arrays["centers"], arrays["widths"], arrays["weights"])
        network._units = restored(units, network._units, network.capacity)
        network._n = np.size(units.widths)
        return network
