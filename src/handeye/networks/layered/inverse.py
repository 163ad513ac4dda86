"""Learning to command an unknown plant: errors are propagated back across it (section A.6.2)."""

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from handeye.arrays import Array, scalar, shaped
from handeye.errors import InvalidInput
from handeye.networks.layered.network import LayeredNetwork


class Commanded(NamedTuple):
    """What one trial of a plant taught.

    error        goal - outcome, (m,)
    model_error  outcome - what the model expected, before it learned, (m,)
    """

    error: Array
    model_error: Array


class InverseLearner:
    """A controller that learns which command reaches a goal, from the outcomes of its commands.

    Nobody tells it the right command. A model, another network, learns which outcome each command
    has; through its derivatives the miss becomes a wanted change of the command,
    `sum_l (goal_l - outcome_l) dO_l/da_j` (eq A.18), which the controller learns. Commands that
    the plant can be given besides the goal may depend on its state.

    Args:
        controller: from goal (m,) and state (s,) together to the command (a,).
        model: from command (a,) and state (s,) together to the outcome (m,).

    Raises:
        InvalidInput: networks whose inputs and outputs do not fit each other; in any method an
            array of the wrong shape or that is not finite; nothing has changed then.
    """

    def __init__(self, controller: LayeredNetwork, model: LayeredNetwork) -> None:
        self.controller = controller
        self.model = model
        self.n_state = controller.n_inputs - model.n_outputs
        if self.n_state < 0 or model.n_inputs != controller.n_outputs + self.n_state:
            raise InvalidInput(
                "a controller takes a goal and a state and gives a command, a model takes a "
                f"command and the state and gives an outcome; {controller.n_inputs} inputs and "
                f"{controller.n_outputs} outputs do not fit {model.n_inputs} and "
                f"{model.n_outputs}"
            )

    def command(self, goal: ArrayLike, state: ArrayLike = ()) -> Array:
        """The command (a,) for a goal (m,) in a state (s,)."""
        return self.controller.predict(self._asked(goal, state))

    def observe(self, command: ArrayLike, outcome: ArrayLike, state: ArrayLike = ()) -> Array:
        """Let the model learn what a command brought about, for any reason; return its error."""
        return self.model.learn(self._done(command, state), outcome).error

    def learn(
        self, goal: ArrayLike, command: ArrayLike, outcome: ArrayLike, state: ArrayLike = ()
    ) -> Commanded:
        """Learn from one trial: the plant was given a command for a goal.

        First the model learns the outcome, then the controller what it should have commanded.
        """
        asked, done = self._asked(goal, state), self._done(command, state)
        self.controller.predict(asked)  # refuses what it could not learn, before the model has
        miss = asked[: self.model.n_outputs] - shaped(outcome, (self.model.n_outputs,), "outcome")
        model_error = self.model.learn(done, outcome).error
        slopes = self.model.slopes(done)[:, : self.controller.n_outputs]
        self.controller.learn_change(asked, miss @ slopes)
        return Commanded(miss, model_error)

    def _asked(self, goal: ArrayLike, state: ArrayLike) -> Array:
        return self._joined(goal, self.model.n_outputs, "goal", state)

    def _done(self, command: ArrayLike, state: ArrayLike) -> Array:
        return self._joined(command, self.controller.n_outputs, "command", state)

    def _joined(self, first: ArrayLike, n: int, name: str, state: ArrayLike) -> Array:
        now = shaped(np.asarray(state, np.float64), (self.n_state,), "state")
        return np.concatenate([shaped(first, (n,), name), now])


def measured_slopes(
    plant: Callable[[Array], ArrayLike], command: ArrayLike, step: float = 1e-3
) -> Array:
    """Derivatives (m, a) of a plant's outcome by its command (a,), by trying.

    Two trials for each component, a step to either side: the way that needs no model (Psaltis,
    Sideris and Yamamura 1987). Feed `miss @ slopes` to a controller's `learn_change`.
    """
    at = shaped(command, (None,), "command")
    size = scalar(step, "step", above=0.0)
    sides = [
        (np.asarray(plant(at + move), np.float64), np.asarray(plant(at - move), np.float64))
        for move in size * np.eye(at.size)
    ]
    return np.stack([(more - less) / (2.0 * size) for more, less in sides], axis=-1)
