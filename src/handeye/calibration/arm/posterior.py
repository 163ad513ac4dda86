"""What a fit knows of its unknowns."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from typing import Self

import numpy as np
from scipy.linalg import solve_triangular

from handeye.arrays import Array, Booleans, shaped
from handeye.calibration.arm.lines import lines_at, root_of, whitened
from handeye.calibration.arm.student import Noise
from handeye.calibration.arm.system import System


@dataclass(frozen=True, eq=False)
class Posterior:
    """What is known of n unknowns after N rows in C channels.

    x        (n,) the estimate
    widths   (n,) standard deviations of the priors, as found
    used     (n,) those that were not switched off; the others are 0
    system   the equations
    errors   how noisy each channel is, and how badly each row fits
    told     (m, m) information of the rows on the used unknowns, by the latest tangents
    """

    x: Array
    widths: Array
    used: Booleans
    system: System
    errors: Noise
    told: Array

    @classmethod
    def restored(cls, system: System, arrays: Mapping[str, Array]) -> Self:
        """Of a system, from what `arrays` had of it.

        Raises:
            InvalidInput, KeyError: for arrays that are not of this system.
        """
        n, channels = len(system.tolerance), system.n_channels
        x, widths, used = (shaped(arrays[name], (n,), name) for name in ("x", "widths", "used"))
        m = int(np.sum(used > 0.0))
        # Of a row that has no such channel it is nan.
        squares = arrays["squares"]
        shaped(np.nan_to_num(squares), (system.n_rows, channels), "squares")
        noise, values = (shaped(arrays[name], (channels,), name) for name in ("noise", "values"))
        told = shaped(arrays["told"], (m, m), "told")
        errors = Noise(noise, squares, values.astype(np.int64))
        return cls(x, widths, used > 0.0, system, errors, told)

    def arrays(self) -> dict[str, Array]:
        """What to keep of it beside the system, by name."""
        return {
            "x": self.x, "widths": self.widths, "used": self.used.astype(np.float64),
            "squares": self.squares, "noise": self.noise,
            "values": self.errors.values.astype(np.float64), "told": self.told,
        }  # fmt: skip

    @property
    def noise(self) -> Array:
        """(C,) standard deviation of each channel beyond what was stated."""
        return self.errors.noise

    @property
    def squares(self) -> Array:
        """(N, C) squared residuals over their variance; nan where a row has no such channel."""
        return self.errors.squares

    def rows_say(self, which: Booleans) -> Array:
        """Information (m, m) of the rows on the unknowns of `which` (n,), in stated tolerances."""
        if not np.any(which & ~self.used):
            inside = which[self.used]
            return self.told[np.ix_(inside, inside)]
        return lines_at(self.system, self.x, self.errors, which).information.sum(axis=0)

    @cached_property
    def root(self) -> Array:
        """(n, n) lower triangular; root root^T is the information in units of stated tolerances.

        With priors as wide as found or as stated, whichever is wider: that nothing was seen of an
        unknown does not make it small.
        """
        width = np.maximum(self.widths / self.system.tolerance, 1.0)
        return root_of(self.rows_say(np.ones_like(self.used)), width)

    @cached_property
    def leverage(self) -> Array:
        """(N, C) how far a row determines what is predicted for it, 0 to the channel's values."""
        system, used = self.system, self.used
        width = (self.widths / system.tolerance)[used]
        root = root_of(self.rows_say(used), width)
        out = np.zeros(self.squares.shape)
        for rows in system.rows(self.x):
            _, J = whitened(rows, system.tolerance, self.errors, used)
            half = solve_triangular(root, J.reshape(-1, J.shape[-1]).T, lower=True)
            lever = np.sum(half**2, axis=0).reshape(J.shape[:2])
            for c in np.unique(rows.channels):
                some = slice(rows.first, rows.first + len(lever))
                out[some, c] = np.sum(lever[:, rows.channels == c], axis=1)
        return out
