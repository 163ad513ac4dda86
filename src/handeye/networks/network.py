"""The resource-allocating network: an online regressor that adds neurons where it is surprised."""

from copy import deepcopy
from os import PathLike
from typing import NamedTuple, Self

import numpy as np
from numpy.typing import ArrayLike

from handeye.arrays import Array, count, scalar, shaped
from handeye.errors import InvalidInput
from handeye.networks import kernels, storage
from handeye.networks.adaptation import VirtualNeuron
from handeye.networks.inputs import InputSpace
from handeye.networks.outcomes import Learned, LearnedMany, LearningDiverged
from handeye.networks.responses import Gaussian
from handeye.networks.schedules import Constant
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


class ResourceAllocatingNetwork:
    """Learns a mapping from R^d to R^m, one sample at a time (Platt 1990; thesis section 3.5.1).

    The output is `sum_j w_j o_j(|x - c_j|)` (eq 3.58). For each sample with error e = target -
    output, a neuron that makes the output exact there is added if |e| > theta_e, the nearest
    center is farther than the schedule's theta_d, and there is room; otherwise, if |e| > theta_l,
    the adaptation rule adjusts the neurons that exist. The defaults are the preferred network of
    section 3.5.4.

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
    """

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
        self.n_inputs = count(n_inputs, "n_inputs")
        self.n_outputs = count(n_outputs, "n_outputs")
        self.inputs = InputSpace.scaled(np.ones(self.n_inputs)) if inputs is None else inputs
        if self.inputs.n_inputs != self.n_inputs:
            raise InvalidInput(f"inputs describes {self.inputs.n_inputs} inputs, not {n_inputs}")
        self.response = storage.checked_kind("response", response)
        self.schedule = storage.checked_kind("schedule", schedule)
        self.adaptation = storage.checked_kind("adaptation", adaptation)
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
        self._trials = 0
        self._units = allocate_units(self.n_inputs, self.n_outputs, self.capacity or _FIRST_SIZE)
        self._work = allocate_work(0)

    @property
    def n_neurons(self) -> int:
        """Neurons allocated so far."""
        return self._n

    @property
    def trials(self) -> int:
        """Samples learned so far: the t of the allocation schedules."""
        return self._trials

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

    def predict(self, x: ArrayLike) -> Array:
        """Output (m,) at one input (d,) (eq 3.58); zero where no neuron answers."""
        return self._predict(shaped(x, (self.n_inputs,), "x")[np.newaxis])[0]

    def predict_many(self, x: ArrayLike) -> Array:
        """Outputs (N, m) at inputs (N, d)."""
        return self._predict(shaped(x, (None, self.n_inputs), "x"))

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

    def learn(self, x: ArrayLike, target: ArrayLike) -> Learned:
        """Learn one sample, x (d,) and target (m,) (section 3.5.2, A.6.3)."""
        one = shaped(x, (self.n_inputs,), "x")[np.newaxis]
        error, allocated = self._learn(one, shaped(target, (self.n_outputs,), "target")[np.newaxis])
        return Learned(error[0], bool(allocated[0]))

    def learn_many(self, x: ArrayLike, target: ArrayLike) -> LearnedMany:
        """Learn N samples in order, x (N, d) and target (N, m); the same result as one by one.

        Raises:
            LearningDiverged: at the first sample whose error is beyond 1e100 or no number; the
                samples before it are learned.
        """
        inputs = shaped(x, (None, self.n_inputs), "x")
        targets = shaped(target, (None, self.n_outputs), "target")
        if len(inputs) != len(targets):
            raise InvalidInput(f"x has {len(inputs)} samples but target has {len(targets)}")
        return self._learn(inputs, targets)

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

    def copy(self) -> Self:
        """An independent network in the same state."""
        return deepcopy(self)

    def save(self, path: str | PathLike[str]) -> None:
        """Write everything to one safetensors file, replacing an old one only once complete."""
        storage.save(self, path)

    @staticmethod
    def load(path: str | PathLike[str]) -> "ResourceAllocatingNetwork":
        """The network that `save` wrote.

        Raises:
            FileFormatError: a damaged or foreign file, one written by a newer version, or one that
                uses a response, schedule or rule that is not registered.
        """
        return storage.load(path)

    def __repr__(self) -> str:
        """Shape, state and kinds."""
        limit = "unlimited" if self.capacity is None else f"at most {self.capacity}"
        return (
            f"ResourceAllocatingNetwork({self.n_inputs} inputs, {self.n_outputs} outputs, "
            f"{self._n} neurons of {limit}, {self._trials} trials, "
            f"{self.response!r}, {self.schedule!r}, {self.adaptation!r})"
        )

    def _predict(self, inputs: Array) -> Array:
        outputs = np.empty((len(inputs), self.n_outputs))
        scaled = self.inputs.scaled_inputs(inputs)
        kernels.predict_stream(self.response, self._units, self._n, scaled, outputs)
        return outputs

    def _learn(self, inputs: Array, targets: Array) -> LearnedMany:
        scaled, targets = self.inputs.scaled_inputs(inputs), moderate(targets, "target")
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
                self._work, state, self.capacity is None, scaled, targets, errors, allocated,
            )  # fmt: skip
            _, self._n, self._trials = state
            if state[0] == done:
                raise LearningDiverged(
                    f"the error at sample {done} is beyond all bounds: {self.adaptation!r} "
                    "diverged. Learn again from a saved network with a smaller rate."
                )
        return LearnedMany(errors, allocated)

    def _restore(self, units: Units, trials: int) -> None:
        """Take over stored neurons; InvalidInput if their arrays do not fit together."""
        self._units = restored(units, self._units, self.capacity)
        self._trials = count(trials, "trials", least=0)
        self._n = np.size(units.widths)
