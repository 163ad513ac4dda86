"""A resource-allocating network that learns its weights by recursive least squares."""

from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from handeye.arrays import Array, count, scalar, shaped
from handeye.errors import InvalidInput
from handeye.io.tensors import Parts
from handeye.networks.checked import CheckedLearner
from handeye.networks.inputs import InputSpace
from handeye.networks.outcomes import LearnedMany
from handeye.networks.recursive.evidence import fitting_factor, relevance
from handeye.networks.recursive.learner import Learner
from handeye.networks.recursive.posterior import NUGGET
from handeye.networks.recursive.storage import learner_parts, restore_learner
from handeye.networks.recursive.units import Settings
from handeye.networks.units import moderate


class RecursiveNetwork(CheckedLearner):
    """Learns a mapping from R^d to R^m, one sample at a time, by second-order steps.

    The output is `sum_j w_j o_j`, `o_j = exp(-|(x - c_j) / scales|^2 / 2)`. As in Platt's
    resource-allocating network (1991) a neuron is added at an input that is far enough from all
    centers and badly enough predicted; the weights follow by recursive least squares, in the place
    of Platt's gradient steps, as Kadirkamanathan and Niranjan (1993) and Yingwei, Sundararajan and
    Saratchandran (1997, MRAN) do, and neurons that no longer matter are pruned, as in MRAN and
    GGAP-RBF (Huang, Saratchandran and Sundararajan 2005). Different from these:

    - The prior of the weights is that of a Gaussian process with noise, so neighbours may overlap
      as much as the data want, and a new neuron inherits information (Csato and Opper 2002).
    - Covariances are those within blocks of neurons (a decoupled extended Kalman filter; exact with
      one block), kept as information and its triangular factor, to which samples are only added.
    - Samples are consolidated a few hundred at a time. Until then they take part through the
      covariance of their errors, which is exact: every error and every prediction is that of the
      recursion sample by sample. A new neuron starts from weight zero and answers from the next
      consolidation on, if neither the others nor those that came with it represent it.
    - The scales are those that make the first samples most probable, times what `fitting_factor`
      finds; then these samples are learned anew by neurons that are there from the beginning.

    A sample costs `n (b + q) / 2` multiplications for n neurons in blocks of b, q samples pending,
    and consolidations about as much again.

    Args:
        n_inputs: d.
        n_outputs: m. Far from all neurons outputs are zero: give targets of about zero mean.
        inputs: the space of inputs; its scales, one standard deviation of a neuron's response, hold
            for ever or until relevance_samples have been seen. By default sqrt(d) for each input.
        capacity: most neurons ever, or None for no limit.
        block: neurons in a block.
        noise_ratio: variance of the noise over the prior variance of the function, until it is
            estimated with the scales.
        forgetting: weight of the past at each sample; 1 remembers everything, below it the last
            1 / (1 - forgetting) samples count. The prior is never forgotten.
        distance_threshold: theta_d, a new neuron is at least that far from others, in scales.
        novelty: a new neuron stays only if the prior variance that others do not represent is more
            than this part of the noise; 0 keeps all. Few inputs then need few neurons.
        error_threshold: theta_e, a neuron is added only for a larger |error|, in output units.
        prune_tolerance: when the capacity is reached, neurons are pruned that together change the
            outputs at what was learned by no more than this root mean square, in output units.
        relevance_samples: how many first samples scales and noise are estimated from, or None to
            keep those given. Learning the last of them takes a second or so at 500.

    Raises:
        InvalidInput: a setting out of range, here or in any method an array of the wrong shape or
            type or with values that are not finite; nothing has changed then.
    """

    FORMAT = "handeye.recursive_network"

    def __init__(
        self,
        n_inputs: int,
        n_outputs: int,
        *,
        inputs: InputSpace | None = None,
        capacity: int | None = 1000,
        block: int = 1000,
        noise_ratio: float = 0.01,
        forgetting: float = 1.0,
        distance_threshold: float = 0.05,
        novelty: float = 0.01,
        error_threshold: float = 0.0,
        prune_tolerance: float = 0.0,
        relevance_samples: int | None = 500,
    ) -> None:
        super().__init__(n_inputs, n_outputs)
        if inputs is None:
            inputs = InputSpace.scaled(np.full(self.n_inputs, np.sqrt(self.n_inputs)))
        self.inputs = inputs.of(self.n_inputs)
        self.capacity = None if capacity is None else count(capacity, "capacity")
        first = 0 if relevance_samples is None else relevance_samples
        self.settings = Settings(
            block=count(block, "block"),
            noise_ratio=scalar(noise_ratio, "noise_ratio", least=1e-8),
            forgetting=scalar(forgetting, "forgetting", least=0.5),
            distance_threshold=scalar(distance_threshold, "distance_threshold", least=0.0),
            novelty=scalar(novelty, "novelty", least=0.0),
            error_threshold=scalar(error_threshold, "error_threshold", least=0.0),
            prune_tolerance=scalar(prune_tolerance, "prune_tolerance", least=0.0),
            relevance_samples=count(first, "relevance_samples", least=0),
        )
        if self.settings.forgetting > 1.0:
            raise InvalidInput(f"forgetting must be at most 1, got {forgetting}")
        if 0 < self.settings.relevance_samples < 2 * (self.n_inputs + 2):
            raise InvalidInput(
                f"relevance_samples must be at least {2 * (self.n_inputs + 2)} to say anything "
                f"about {self.n_inputs} scales, or None; got {relevance_samples}"
            )
        self._learner = Learner(self.n_inputs, self.n_outputs, self.capacity, self.settings)
        self._scales = np.array(self.inputs.scales)
        self._first = np.empty((0, self.n_inputs + self.n_outputs))

    @property
    def n_neurons(self) -> int:
        """Neurons allocated so far, with those that answer only from the next consolidation on."""
        return self._learner.n_neurons + self._learner.waiting

    @property
    def scales(self) -> Array:
        """One standard deviation of a neuron's response along each input, (d,); a copy."""
        return self._scales.copy()

    @property
    def centers(self) -> Array:
        """Where the neurons that answer are, (N, d) in input units; a copy."""
        return self._learner.centers() * self._scales

    @property
    def weights(self) -> Array:
        """Their output weights, (N, m); a copy."""
        return self._learner.weights()

    @property
    def noise(self) -> Array:
        """Estimated standard deviation of what no network could predict, (m,); a copy."""
        return np.sqrt(self._learner.noise)

    def variance(self, x: ArrayLike) -> Array:
        """Variance of target minus output (m,) at one input (d,), the noise included."""
        return self.variance_many(shaped(x, (self.n_inputs,), "x")[np.newaxis])[0]

    def variance_many(self, x: ArrayLike) -> Array:
        """The same at inputs (N, d), (N, m).

        `noise o^T A^-1 o + max(noise, signal (1 - k^T K^-1 k))`: uncertain weights, and noise or
        what the neurons cannot represent there (the deterministic training conditional of
        Quinonero-Candela and Rasmussen 2005), whichever is more, since the estimate of the noise
        holds what they usually cannot. Far from all neurons it is the prior's.
        """
        return self._learner.variance(self._scaled(shaped(x, (None, self.n_inputs), "x")))

    def prune(self, tolerance: float) -> int:
        """Remove neurons that matter least; returns how many.

        The root mean square of the change of the outputs at what was learned, weighted by what is
        not forgotten, is at most the tolerance, in output units (an estimate where neurons were
        added later, and with more than one block).
        """
        return self._learner.prune(scalar(tolerance, "tolerance", least=0.0))

    def __repr__(self) -> str:
        """Shape and state."""
        limit = "unlimited" if self.capacity is None else f"at most {self.capacity}"
        return (
            f"RecursiveNetwork({self.n_inputs} inputs, {self.n_outputs} outputs, "
            f"{self.n_neurons} neurons of {limit}, {self._trials} trials, {self.settings})"
        )

    def _scaled(self, inputs: Array) -> Array:
        with np.errstate(over="ignore"):
            return moderate(inputs / self._scales, "inputs over scales")

    def _inputs(self, x: Array) -> Array:
        self._scaled(x)
        return x  # scales may change while a stream is learned

    def _predict(self, inputs: Array) -> Array:
        return self._learner.predict(self._scaled(inputs))

    def _learn(self, inputs: Array, targets: Array) -> LearnedMany:
        first = self.settings.relevance_samples
        until = max(0, min(len(inputs), first - self._trials))
        parts: list[LearnedMany] = []
        for rows in (slice(0, until), slice(until, None)):
            parts.append(self._learner.learn(self._scaled(inputs[rows]), targets[rows]))
            self._trials += len(inputs[rows])
            if rows.stop:
                new = np.concatenate([inputs[rows], targets[rows]], axis=1)
                self._first = np.concatenate([self._first, new])
                if self._trials == first:
                    self._begin_again()
        return LearnedMany(*(np.concatenate(both) for both in zip(*parts, strict=True)))

    def _begin_again(self) -> None:
        """Estimate scales and noise from the first samples, and learn these anew."""
        inputs, targets = np.split(self._first, [self.n_inputs], axis=1)
        found = relevance(inputs, targets)
        self._first = self._first[:0]
        neurons = inputs[: self.capacity] / found.scales
        self._scales = found.scales * fitting_factor(neurons, found.noise_ratio, NUGGET)
        settings = self.settings._replace(noise_ratio=found.noise_ratio)
        self._learner = Learner(self.n_inputs, self.n_outputs, self.capacity, settings)
        # A neuron that comes later knows of earlier samples only what others tell it.
        self._learner.place(self._scaled(inputs))
        self._learner.learn(self._scaled(inputs), targets)
        self._learner.noise, self._learner.signal = found.noise, found.signal

    def _parts(self) -> Parts:
        arrays, rest = learner_parts(self._learner)
        arrays |= {
            "low": self.inputs.low,
            "high": self.inputs.high,
            "box_scales": self.inputs.scales,
            "scales": self._scales,
            "first": self._first,
        }
        settings = self.settings._asdict()
        return arrays, rest | {
            "n_inputs": self.n_inputs,
            "n_outputs": self.n_outputs,
            "capacity": self.capacity,
            "settings": settings,
        }

    @classmethod
    def _restored(cls, arrays: dict[str, Array], rest: dict[str, Any]) -> Self:
        d, m = rest["n_inputs"], rest["n_outputs"]
        space = InputSpace(arrays["low"], arrays["high"], arrays["box_scales"])
        settings = {"novelty": 0.0} | rest["settings"]  # the first version kept every neuron
        network = cls(d, m, inputs=space, capacity=rest["capacity"], **settings)
        network._scales = shaped(arrays["scales"], (d,), "scales")
        if not np.all(network._scales > 0.0):
            raise InvalidInput("scales must be positive")
        network._first = shaped(arrays["first"], (None, d + m), "first")
        restore_learner(network._learner, arrays, rest)
        return network
