"""What the model leaves over: a network over the full input, used once it has proved itself."""

import numpy as np

from handeye.arrays import Array
from handeye.calibration.combined.guard import Comparison
from handeye.networks.inputs import InputSpace
from handeye.networks.recursive import RecursiveNetwork

# Comparisons of the network with its absence.
_RECENT = 100
# What is left is about as large as the noise, or the model would have been found wanting before.
_NOISE_RATIO = 1.0


class Leftover:
    """Shifts of the hand, learned from what is left after the model.

    A recursive network: it averages noise as the model does, and away from what it has seen it says
    nothing, its prior. Every observation is tested before it is learned, and the network is used
    only while it has been better than its absence, beyond chance, over the latest hundred; so it
    cannot make things worse for longer than that takes to notice.

    Args:
        space: of the inputs; one scale is how far an observation tells about its neighbours.
        n_outputs: components of a shift.
        capacity: most neurons; 0 for no network.
        chance: mean over standard error that proves it.
    """

    def __init__(self, space: InputSpace, n_outputs: int, capacity: int, chance: float) -> None:
        self.network = (
            RecursiveNetwork(
                space.n_inputs,
                n_outputs,
                inputs=space,
                capacity=capacity,
                block=capacity,
                noise_ratio=_NOISE_RATIO,
                relevance_samples=None,
            )
            if capacity
            else None
        )
        self.n_outputs = n_outputs
        self.comparison = Comparison(_RECENT, chance)
        self.proved = False

    def used(self, inputs: Array) -> Array:
        """Shifts (N, m) [m] to count with at inputs (N, d): none unless it has proved itself."""
        if self.network is None or not self.proved:
            return np.zeros((len(inputs), self.n_outputs))
        return self.network.predict_many(inputs)

    def learn(self, inputs: Array, left: Array) -> bool:
        """Learn the miss (m,) that the model left at inputs (d,); tells of a new neuron."""
        if self.network is None:
            return False
        error, allocated = self.network.learn(inputs, left)
        self._judge(float(np.linalg.norm(left)), float(np.linalg.norm(error)))
        return bool(allocated)

    def _judge(self, without: float, given: float) -> None:
        """Misses without it and with it, before it learned."""
        self.comparison.add(without, given)
        # Proof takes a full count; to lose it takes only doubt.
        if self.proved:
            self.proved = self.comparison.significance > 0.0
        else:
            self.proved = self.comparison.n >= _RECENT and self.comparison.a_is_worse
