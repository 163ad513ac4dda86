"""The recursion itself, in scaled inputs: learn, consolidate, grow and prune."""

from typing import Any

import numpy as np

from handeye.arrays import Array
from handeye.networks.outcomes import LearnedMany
from handeye.networks.recursive import kernels
from handeye.networks.recursive.posterior import (
    add_neurons,
    consolidate,
    current_weights,
    empty_posterior,
    novel,
    prior_factor,
    refactor,
    unrepresented,
    with_block,
)
from handeye.networks.recursive.pruning import prune_block
from handeye.networks.recursive.units import (
    LONGEST,
    Arrays,
    Progress,
    Settings,
    allocate_scratch,
)


class Learner:
    """Weights, their covariances and samples pending; arguments are checked by the network."""

    def __init__(
        self, n_inputs: int, n_outputs: int, capacity: int | None, settings: Settings
    ) -> None:
        self.settings = settings
        self.capacity = capacity
        size = settings.block if capacity is None else min(settings.block, capacity)
        self.posterior = empty_posterior(n_inputs, n_outputs, size)
        self.noise = np.zeros(n_outputs)
        self.signal: Array | None = None
        self.known = 0
        self.waiting = 0
        self.trials = 0
        self.points = np.empty((LONGEST, n_inputs))
        self._scratch = allocate_scratch(size)
        self._weights: Array | None = None

    def __getstate__(self) -> dict[str, Any]:
        """All but the scratch, which must be writable where the rest need not."""
        return {name: value for name, value in self.__dict__.items() if name != "_scratch"}

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Scratch of its own."""
        self.__dict__.update(state)
        self._scratch = allocate_scratch(self.posterior.units.factor.shape[1])

    @property
    def n_neurons(self) -> int:
        """Neurons that answer."""
        return int(self.posterior.units.counts.sum())

    def centers(self) -> Array:
        """Centers (N, d), block after block."""
        units = self.posterior.units
        return np.concatenate(
            [c[:, :n].T for c, n in zip(units.centers, units.counts, strict=True)]
        )

    def weights(self) -> Array:
        """Weights (N, m) with all samples learned."""
        counts = self.posterior.units.counts
        return np.concatenate([w[:, :n].T for w, n in zip(self._current(), counts, strict=True)])

    def predict(self, inputs: Array) -> Array:
        """Outputs (N, m)."""
        units = self.posterior.units
        outputs = np.empty((len(inputs), units.weights.shape[1]))
        kernels.predict_stream(
            units._replace(weights=self._current()), self._scratch, inputs, outputs
        )
        return outputs

    def variance(self, inputs: Array) -> Array:
        """Variance of target minus output, (N, m)."""
        spread = np.empty(len(inputs))
        kernels.variance_stream(
            self.posterior.units, self.posterior.pending, self.known, self._scratch, inputs, spread
        )
        spread /= self.settings.forgetting**self.known
        missing = unrepresented(self.posterior, inputs)[:, np.newaxis]
        signal = self.noise / self.settings.noise_ratio if self.signal is None else self.signal
        return spread[:, np.newaxis] * self.noise + np.maximum(self.noise, signal * missing)

    def learn(self, inputs: Array, targets: Array) -> LearnedMany:
        """Learn samples in order."""
        errors = targets.copy()
        allocated = np.zeros(len(inputs), np.bool_)
        done = 0
        while done < len(inputs):
            rows = slice(done, done + self._horizon() - self.known)
            room = LONGEST if self.capacity is None else self.capacity - self.n_neurons
            units, pending = self.posterior.units, self.posterior.pending
            self.waiting = kernels.learn_stream(
                Arrays(units, pending, self._scratch, self.noise, self.points),
                self.settings,
                Progress(self.known, self.waiting, self.trials, room),
                inputs[rows],
                errors[rows],
                allocated[rows],
            )
            new = len(inputs[rows])
            done += new
            self.known += new
            self.trials += new
            self._weights = None
            if self.known == self._horizon():
                full = self.n_neurons + self.waiting == self.capacity
                self._consolidate(self.settings.prune_tolerance if full else 0.0)
        return LearnedMany(errors, allocated)

    def place(self, points: Array) -> None:
        """Neurons of weight zero at points (N, d), as many as are novel and there is room for."""
        while len(points):
            room = LONGEST if self.capacity is None else self.capacity - self.n_neurons
            some, points = np.split(points, [min(LONGEST, room)])
            if room == 0:
                return
            self.points[: len(some)] = some
            self.waiting = len(some)
            self._consolidate(0.0)

    def prune(self, tolerance: float) -> int:
        """Consolidate, and remove neurons within the tolerance; returns how many."""
        return self._consolidate(tolerance)

    def _horizon(self) -> int:
        """Samples from one consolidation to the next: solving for them takes about as long as it.

        While neurons are added few are there, and they should answer soon; later a consolidation
        takes a while however small the network. Forgetting at most halves what was known.
        """
        n = self.n_neurons
        full = self.capacity is not None and n >= self.capacity
        shared = min(n, self.settings.block)
        longest = min(shared // 2, LONGEST)
        if full:
            longest = max(longest, min(shared, 256), 64)
        longest = max(longest, 1)
        if self.settings.forgetting < 1.0:
            half = -np.log(2.0) / np.log(self.settings.forgetting)
            longest = min(longest, max(int(half), 1))
        return longest

    def _consolidate(self, tolerance: float) -> int:
        """Learn what is pending, prune, and let the points that wait become neurons."""
        consolidate(self.posterior, self.settings, self.known)
        self.known = 0
        self._weights = None
        removed = 0
        if tolerance > 0.0:  # before the new ones, which have done nothing yet
            refactor(self.posterior)
            removed = self._prune(tolerance)
        points = self.points[: self.waiting]
        while len(points):
            counts = self.posterior.units.counts
            block = int(np.argmin(counts))
            free = self.settings.block - int(counts[block])
            if free == 0:
                self.posterior = with_block(self.posterior)
                continue
            some, points = points[:free], points[free:]
            factor = prior_factor(self.posterior, block)
            some = some[novel(self.posterior, self.settings, block, some, factor)]
            add_neurons(self.posterior, self.settings, block, some, factor)
        self.waiting = 0
        refactor(self.posterior)
        return removed

    def _prune(self, tolerance: float) -> int:
        blocks, f = self.posterior.units.counts.size, self.settings.forgetting
        remembered = self.trials if f == 1.0 else (1.0 - f**self.trials) / (1.0 - f)
        allowance = (tolerance / blocks) ** 2 * remembered
        return sum(prune_block(self.posterior, b, allowance) for b in range(blocks))

    def _current(self) -> Array:
        if self._weights is None:
            self._weights = current_weights(self.posterior, self.known)
        return self._weights
