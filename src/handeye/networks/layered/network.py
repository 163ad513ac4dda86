"""The layered network: neurons in layers, all taught at once by propagating errors back."""

from collections.abc import Sequence
from typing import Any, NamedTuple, Self

import numpy as np
from numpy.typing import ArrayLike

from handeye.arrays import Array, count, scalar, shaped
from handeye.errors import InvalidInput
from handeye.io.tensors import Parts
from handeye.networks.checked import CheckedLearner
from handeye.networks.inputs import InputSpace
from handeye.networks.kinds import checked_kind, restored_kind, stored_kind
from handeye.networks.layered import kernels
from handeye.networks.layered.activations import ACTIVATIONS, Linear, Tanh
from handeye.networks.outcomes import LearnedMany, LearningDiverged
from handeye.networks.units import moderate
from handeye.randomness import stream

_ROLES = ("activation", "output")


class LayeredNetwork(CheckedLearner):
    """Learns a mapping from R^d to R^m by back error propagation (section A.6.2).

    Each neuron weighs the answers of the layer below, `o_j = f(sum_k w_jk o_k - theta_j)`. After
    each sample every weight and threshold descends the energy `E = |target - output|^2 / 2` (eq
    A.8), outputs counted in `output_scale`: `delta w_jk = -rate dE/dw_jk` (eq A.9 to A.14). No
    neuron is ever added, so `allocated` is always False.

    Args:
        n_inputs: d.
        n_outputs: m.
        hidden: neurons of each hidden layer, from the inputs on; none for a single layer.
        inputs: the box of inputs, which is mapped to [-1, 1]; by default [-1, 1] itself.
        output_scale: what an answer of 1 of an output neuron means, in output units, one number or
            (m,).
        activation: of hidden neurons: Tanh(), Sigmoid() or Linear().
        output: of output neurons.
        rate: eta of eq A.9.
        largest_weight: first weights and thresholds are drawn evenly up to this, either sign.
        rng: draws them; by default from a stream of their own, the same each time.

    Raises:
        InvalidInput: a setting out of range, here or in any method an array of the wrong shape or
            type or with values that are not finite; nothing has changed then.
        LearningDiverged: in learning, at the first sample whose error is beyond 1e100; the samples
            before it are learned.
    """

    FORMAT = "handeye.layered"

    def __init__(
        self,
        n_inputs: int,
        n_outputs: int,
        hidden: Sequence[int] = (20,),
        *,
        inputs: InputSpace | None = None,
        output_scale: ArrayLike = 1.0,
        activation: NamedTuple = Tanh(),  # noqa: B008 (immutable)
        output: NamedTuple = Linear(),  # noqa: B008 (immutable)
        rate: float = 0.05,
        largest_weight: float = 0.3,
        rng: np.random.Generator | None = None,
    ) -> None:
        super().__init__(n_inputs, n_outputs)
        between = [count(n, "each of hidden") for n in hidden]
        self._sizes = np.array([self.n_inputs, *between, self.n_outputs], np.int64)
        ones = np.ones(self.n_inputs)
        space = InputSpace.box(-ones, ones) if inputs is None else inputs
        self.inputs = space.of(self.n_inputs)
        self._scales = _output_scales(output_scale, self.n_outputs)
        self.kinds = kernels.Kinds(
            checked_kind("activation", activation, ACTIVATIONS, above=0.0),
            checked_kind("output", output, ACTIVATIONS, above=0.0),
        )
        self.rate = scalar(rate, "rate", above=0.0)
        span = scalar(largest_weight, "largest_weight", least=0.0)
        draw = stream("layered network: first weights") if rng is None else rng
        n_weights = int(((self._sizes[:-1] + 1) * self._sizes[1:]).sum())
        self._weights = draw.uniform(-span, span, n_weights)

    @property
    def hidden(self) -> tuple[int, ...]:
        """Neurons of each hidden layer."""
        return tuple(self._sizes[1:-1].tolist())

    @property
    def output_scale(self) -> Array:
        """What an answer of 1 of each output neuron means, (m,); a copy."""
        return self._scales.copy()

    @property
    def n_weights(self) -> int:
        """Weights and thresholds."""
        return self._weights.size

    @property
    def weights(self) -> list[Array]:
        """Of each layer a matrix (m, n + 1) from n neurons to m, minus thresholds last; copies."""
        return [block.copy() for block in self._blocks()]

    @weights.setter
    def weights(self, blocks: Sequence[ArrayLike]) -> None:
        old = self._blocks()
        if len(blocks) != len(old):
            raise InvalidInput(f"{len(old)} layers need as many matrices, got {len(blocks)}")
        checked = [
            shaped(new, block.shape, f"weights of layer {i}")
            for i, (new, block) in enumerate(zip(blocks, old, strict=True))
        ]
        self._weights = np.concatenate([block.ravel() for block in checked])

    def slopes(self, x: ArrayLike) -> Array:
        """Derivatives (m, d) of every output by every input at x (d,), in their units."""
        centred = self._inputs(shaped(x, (self.n_inputs,), "x"))
        slopes = np.empty((self.n_outputs, self.n_inputs))
        kernels.input_slopes(self.kinds, self._sizes, self._weights, centred, slopes)
        return slopes * self._scales[:, np.newaxis] / self._half

    def learn_change(self, x: ArrayLike, change: ArrayLike) -> None:
        """Move the output at x (d,) along a wanted change (m,), as if it were target - output.

        For a network whose own target nobody knows, only how its output should change (eq A.18).
        It counts as a trial.
        """
        centred = self._inputs(shaped(x, (self.n_inputs,), "x"))
        wanted = moderate(shaped(change, (self.n_outputs,), "change"), "change") / self._scales
        kernels.learn_signal(self.kinds, self.rate, self._sizes, self._weights, centred, wanted)
        self._trials += 1

    def __repr__(self) -> str:
        """Shape, state and kinds."""
        layers = "-".join(map(str, self._sizes))
        return (
            f"LayeredNetwork({layers} neurons, {self._trials} trials, {self.kinds.hidden!r}, "
            f"{self.kinds.output!r}, rate {self.rate:g})"
        )

    @property
    def _half(self) -> Array:
        return 0.5 * (self.inputs.high - self.inputs.low)

    def _inputs(self, x: Array) -> Array:
        """With the box mapped to [-1, 1]."""
        middle = 0.5 * (self.inputs.low + self.inputs.high)
        with np.errstate(over="ignore"):
            return moderate((x - middle) / self._half, "inputs over half their box")

    def _blocks(self) -> list[Array]:
        pairs = list(zip(self._sizes[:-1] + 1, self._sizes[1:], strict=True))
        ends = np.cumsum([n * m for n, m in pairs])[:-1]
        parts = np.split(self._weights, ends)
        return [part.reshape(m, n) for part, (n, m) in zip(parts, pairs, strict=True)]

    def _predict(self, inputs: Array) -> Array:
        outputs = np.empty((len(inputs), self.n_outputs))
        kernels.predict_stream(
            self.kinds, self._sizes, self._weights, self._scales, inputs, outputs
        )
        return outputs

    def _learn(self, inputs: Array, targets: Array) -> LearnedMany:
        errors = np.empty_like(targets)
        done = kernels.learn_stream(
            self.kinds, self.rate, self._sizes, self._weights, self._scales, inputs, targets,
            errors,
        )  # fmt: skip
        self._trials += done
        if done < len(inputs):
            raise LearningDiverged(
                f"the error at sample {done} is beyond all bounds: back-propagation at rate "
                f"{self.rate:g} diverged. Learn again from a saved network with a smaller rate."
            )
        return LearnedMany(errors, np.zeros(len(inputs), np.bool_))

    def _parts(self) -> Parts:
        arrays = {
            "weights": self._weights, "output_scale": self._scales, **self.inputs.arrays
        }  # fmt: skip
        return arrays, {
            "hidden": list(self.hidden),
            "rate": self.rate,
            "activation": stored_kind(self.kinds.hidden),
            "output": stored_kind(self.kinds.output),
        }

    @classmethod
    def _restored(cls, arrays: dict[str, Array], rest: dict[str, Any]) -> Self:
        kinds = {role: restored_kind(role, rest[role], ACTIVATIONS) for role in _ROLES}
        network = cls(
            arrays["low"].size,
            arrays["output_scale"].size,
            rest["hidden"],
            inputs=InputSpace.of_arrays(arrays),
            output_scale=arrays["output_scale"],
            rate=rest["rate"],
            **kinds,
        )
        network._weights = shaped(arrays["weights"], network._weights.shape, "weights").copy()
        return network


def _output_scales(value: ArrayLike, n_outputs: int) -> Array:
    """(m,) positive scales from one number or (m,)."""
    given = np.asarray(value)
    scales = shaped(np.full(n_outputs, given) if given.ndim == 0 else given, (n_outputs,),
                    "output_scale").copy()  # fmt: skip
    if not np.all(scales > 0.0):
        raise InvalidInput(f"output_scale must be positive, got {scales}")
    return scales
