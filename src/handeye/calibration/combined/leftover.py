"""What the model leaves over: a network over the full input, used once it has proved itself."""

import numpy as np

from handeye.arrays import Array
from handeye.calibration.combined.guard import Comparison
from handeye.networks import ResourceAllocatingNetwork
from handeye.networks.inputs import InputSpace

# Corrections smaller than this are not worth a neuron [rad].
_WORTH = 1e-5
# A correction counts up to this distance from all experience, in the network's scaled inputs.
_NEAR = 0.3
# Comparisons of the network with its absence.
_RECENT = 100


class Leftover:
    """Corrections of two joint angles, learned from what is left after the model.

    Every observation is tested before it is learned. The network is used only while it has been
    better than its absence, beyond chance, over the latest hundred, and only near inputs that it
    has seen; so it cannot make things worse for longer than that takes to notice.

    Args:
        space: of the inputs.
        n_outputs: corrections.
        capacity: most neurons; 0 for no network.
        chance: mean over standard error that proves it.
    """

    def __init__(self, space: InputSpace, n_outputs: int, capacity: int, chance: float) -> None:
        self.network = (
            ResourceAllocatingNetwork(
                space.n_inputs,
                n_outputs,
                inputs=space,
                capacity=capacity,
                error_threshold=_WORTH,
                learning_threshold=_WORTH,
            )
            if capacity
            else None
        )
        self.n_outputs = n_outputs
        self.comparison = Comparison(_RECENT, chance)
        self.proved = False

    def correction(self, inputs: Array) -> Array:
        """What the network says (N, m) at inputs (N, d) near its experience, used or not."""
        if self.network is None or self.network.n_neurons == 0:
            return np.zeros((len(inputs), self.n_outputs))
        near = self.network.nearest_many(inputs) < _NEAR
        return self.network.predict_many(inputs) * near[:, np.newaxis]

    def used(self, inputs: Array) -> Array:
        """What is added to commands (N, m): nothing unless the network has proved itself."""
        if not self.proved:
            return np.zeros((len(inputs), self.n_outputs))
        return self.correction(inputs)

    def learn(self, inputs: Array, wanted: Array) -> tuple[Array, bool]:
        """Learn from one observation: inputs (d,), correction wanted (m,).

        Returns what it had said before (m,), and whether a neuron was added.
        """
        if self.network is None:
            return np.zeros(self.n_outputs), False
        error, allocated = self.network.learn(inputs, wanted)
        return wanted - error, allocated

    def judge(self, without: float, given: float) -> None:
        """Errors that would have been made without it and with it, before it learned."""
        self.comparison.add(without, given)
        # Proof takes a full count; to lose it takes only doubt.
        if self.proved:
            self.proved = self.comparison.significance > 0.0
        else:
            self.proved = self.comparison.n >= _RECENT and self.comparison.a_is_worse
