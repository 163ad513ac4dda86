"""The layered network: neurons in layers, all taught at once by propagating errors back."""

from collections.abc import Sequence
from copy import deepcopy
from os import PathLike
from typing import NamedTuple, Self

import numpy as np
from numpy.typing import ArrayLike

from handeye.arrays import Array, count, scalar, shaped
from handeye.errors import InvalidInput
from handeye.networks.inputs import InputSpace
from handeye.networks.layered import kernels, storage
from handeye.networks.layered.activations import Linear, Tanh, checked_activation
from handeye.networks.outcomes import Learned, LearnedMany, LearningDiverged
from handeye.networks.units import moderate
from handeye.randomness import stream


class LayeredNetwork:
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
    """

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
        self.n_inputs = count(n_inputs, "n_inputs")
        self.n_outputs = count(n_outputs, "n_outputs")
        between = [count(n, "each of hidden") for n in hidden]
        self._sizes = np.array([self.n_inputs, *between, self.n_outputs], np.int64)
        ones = np.ones(self.n_inputs)
        self.inputs = InputSpace.box(-ones, ones) if inputs is None else inputs
        if self.inputs.n_inputs != self.n_inputs:
            raise InvalidInput(f"inputs describes {self.inputs.n_inputs} inputs, not {n_inputs}")
        self._scales = _output_scales(output_scale, self.n_outputs)
        self.kinds = kernels.Kinds(
            checked_activation("activation", activation), checked_activation("output", output)
        )
        self.rate = scalar(rate, "rate", above=0.0)
        span = scalar(largest_weight, "largest_weight", least=0.0)
        draw = stream("layered network: first weights") if rng is None else rng
        n_weights = int(((self._sizes[:-1] + 1) * self._sizes[1:]).sum())
        self._weights = draw.uniform(-span, span, n_weights)
        self._trials = 0

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
    def trials(self) -> int:
        """Samples learned so far."""
        return self._trials

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

    def predict(self, x: ArrayLike) -> Array:
        """Output (m,) at one input (d,)."""
        return self._predict(shaped(x, (self.n_inputs,), "x")[np.newaxis])[0]

    def predict_many(self, x: ArrayLike) -> Array:
        """Outputs (N, m) at inputs (N, d)."""
        return self._predict(shaped(x, (None, self.n_inputs), "x"))

    def slopes(self, x: ArrayLike) -> Array:
        """Derivatives (m, d) of every output by every input at x (d,), in their units."""
        centred = self._centred(shaped(x, (self.n_inputs,), "x"))
        slopes = np.empty((self.n_outputs, self.n_inputs))
        kernels.input_slopes(self.kinds, self._sizes, self._weights, centred, slopes)
        return slopes * self._scales[:, np.newaxis] / self._half

    def learn(self, x: ArrayLike, target: ArrayLike) -> Learned:
        """Learn one sample, x (d,) and target (m,) (eq A.9 to A.14)."""
        one = shaped(x, (self.n_inputs,), "x")[np.newaxis]
        error, _ = self._learn(one, shaped(target, (self.n_outputs,), "target")[np.newaxis])
        return Learned(error[0], False)

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

    def learn_change(self, x: ArrayLike, change: ArrayLike) -> None:
        """Move the output at x (d,) along a wanted change (m,), as if it were target - output.

        For a network whose own target nobody knows, only how its output should change (eq A.18).
        It counts as a trial.
        """
        centred = self._centred(shaped(x, (self.n_inputs,), "x"))
        wanted = moderate(shaped(change, (self.n_outputs,), "change"), "change") / self._scales
        kernels.learn_signal(self.kinds, self.rate, self._sizes, self._weights, centred, wanted)
        self._trials += 1

    def copy(self) -> Self:
        """An independent network in the same state."""
        return deepcopy(self)

    def save(self, path: str | PathLike[str]) -> None:
        """Write everything to one safetensors file, replacing an old one only once complete."""
        storage.save(self, path)

    @staticmethod
    def load(path: str | PathLike[str]) -> "LayeredNetwork":
        """The network that `save` wrote.

        Raises:
            FileFormatError: a damaged or foreign file, one written by a newer version, or one that
                uses an activation that is not registered.
        """
        return storage.load(path)

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

    def _centred(self, inputs: Array) -> Array:
        """Inputs with the box mapped to [-1, 1]."""
        middle = 0.5 * (self.inputs.low + self.inputs.high)
        with np.errstate(over="ignore"):
            return moderate((inputs - middle) / self._half, "inputs over half their box")

    def _blocks(self) -> list[Array]:
        pairs = list(zip(self._sizes[:-1] + 1, self._sizes[1:], strict=True))
        ends = np.cumsum([n * m for n, m in pairs])[:-1]
        parts = np.split(self._weights, ends)
        return [part.reshape(m, n) for part, (n, m) in zip(parts, pairs, strict=True)]

    def _predict(self, inputs: Array) -> Array:
        outputs = np.empty((len(inputs), self.n_outputs))
        centred = self._centred(inputs)
        kernels.predict_stream(
            self.kinds, self._sizes, self._weights, self._scales, centred, outputs
        )
        return outputs

    def _learn(self, inputs: Array, targets: Array) -> LearnedMany:
        centred, targets = self._centred(inputs), moderate(targets, "target")
        errors = np.empty_like(targets)
        done = kernels.learn_stream(
            self.kinds, self.rate, self._sizes, self._weights, self._scales, centred, targets,
            errors,
        )  # fmt: skip
        self._trials += done
        if done < len(inputs):
            raise LearningDiverged(
                f"the error at sample {done} is beyond all bounds: back-propagation at rate "
                f"{self.rate:g} diverged. Learn again from a saved network with a smaller rate."
            )
        return LearnedMany(errors, np.zeros(len(inputs), np.bool_))

    def _restore(self, weights: Array, trials: int) -> None:
        """Take over stored weights; InvalidInput if they do not fit."""
        self._weights = shaped(weights, self._weights.shape, "weights").copy()
        self._trials = count(trials, "trials", least=0)


def _output_scales(value: ArrayLike, n_outputs: int) -> Array:
    """(m,) positive scales from one number or (m,)."""
    given = np.asarray(value)
    scales = shaped(np.full(n_outputs, given) if given.ndim == 0 else given, (n_outputs,),
                    "output_scale").copy()  # fmt: skip
    if not np.all(scales > 0.0):
        raise InvalidInput(f"output_scale must be positive, got {scales}")
    return scales
