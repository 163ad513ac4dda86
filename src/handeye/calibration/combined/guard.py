"""Is one way of commanding better than another, beyond chance, on recent observations?"""

import numpy as np

from handeye._compiled import compiled
from handeye.arrays import Array

_FEW = 10


@compiled
def significance(scores: Array) -> float:
    """Mean over standard error of scores (n,); 0 for fewer than ten.

    A standard deviation below 0.05 counts as that: one of nothing would call anything significant.
    """
    n = len(scores)
    if n < _FEW:
        return 0.0
    mean, squares = 0.0, 0.0
    for i in range(n):
        mean += scores[i] / n
    for i in range(n):
        squares += (scores[i] - mean) ** 2
    return mean / max(np.sqrt(squares / (n - 1)), 0.05) * np.sqrt(float(n))


class Comparison:
    """Running test-then-train comparison of two commanders.

    Each observation counts by `(|e_a| - |e_b|) / (|e_a| + |e_b|)`, between -1 and 1, so that no
    single one decides; mean over standard error of the latest `recent` is compared with chance.

    Args:
        recent: observations that count.
        chance: mean over standard error beyond which it is not chance.
    """

    def __init__(self, recent: int, chance: float) -> None:
        self.scores = np.zeros(recent)
        self.n = 0
        self.chance = chance

    def add(self, a: float, b: float) -> None:
        """Errors of both on one observation, made before either learned from it."""
        total = a + b
        self.scores[self.n % len(self.scores)] = (a - b) / total if total > 0.0 else 0.0
        self.n += 1

    @property
    def significance(self) -> float:
        """Mean over standard error of a minus b: positive where a errs more; 0 while few."""
        return significance(self.scores[: min(self.n, len(self.scores))])

    @property
    def a_is_worse(self) -> bool:
        """Beyond chance."""
        return self.significance > self.chance

    @property
    def b_is_worse(self) -> bool:
        """Beyond chance."""
        return self.significance < -self.chance

    def arrays(self) -> dict[str, Array]:
        """All that `restore` needs."""
        return {"scores": self.scores.copy(), "n": np.array([float(self.n)])}

    def restore(self, arrays: dict[str, Array]) -> None:
        """Continue from arrays; ValueError where they do not fit."""
        if arrays["scores"].shape != self.scores.shape or arrays["n"].shape != (1,):
            raise ValueError("a comparison of another length")
        self.scores = np.array(arrays["scores"])
        self.n = int(arrays["n"][0])
