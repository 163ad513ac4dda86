"""What has just happened: a shift register that the clock moves on (section 4.4.1)."""

from collections.abc import Iterable, Mapping

import numpy as np
from numpy.typing import ArrayLike

from handeye.arrays import Array, Booleans, count
from handeye.errors import InvalidInput


class ShortTermMemory:
    """A shift register with many streams, for N trials at once.

    Each tick of the clock opens a new place in every stream and moves all that was there one place
    back. With x_i what was recorded in tick i of a stream, now being tick n,

        at(stream, k) = x_(n - k - delay)

    which is NaN before anything was recorded. A delay stands for a sense that reports late: it
    moves a whole stream, so streams of the same delay keep their phase.

    Args:
        streams: their names.
        depth: places that can be asked for, the present one included.
        n: trials.
        delays: ticks by which a stream lags; a stream that is not named does not lag.

    Raises:
        InvalidInput: a delay for a stream that does not exist, or a depth or delay out of range.
    """

    def __init__(
        self,
        streams: Iterable[str],
        depth: int,
        n: int,
        delays: Mapping[str, int] | None = None,
    ) -> None:
        self._rows = {name: row for row, name in enumerate(streams)}
        lags = dict(delays or {})
        for name in lags.keys() - self._rows.keys():
            raise InvalidInput(f"there is no stream {name!r} to delay")
        self.n = count(n, "n", least=0)
        self.depth = count(depth, "depth")
        self._delays = {s: count(lags.get(s, 0), f"delay of {s}", least=0) for s in self._rows}
        places = self.depth + max(self._delays.values(), default=0)
        self._register = np.full((places, len(self._rows), self.n), np.nan)

    def tick(self) -> None:
        """Move everything one place back and open a new place, empty (NaN)."""
        self._register[1:] = self._register[:-1]
        self._register[0] = np.nan

    def record(self, stream: str, values: ArrayLike) -> None:
        """Write values (N,) into the newest place of a stream."""
        self._register[0, self._rows[stream]] = values

    def at(self, stream: str, ago: int = 0) -> Array:
        """Values (N,) that stood at the exit of a stream `ago` ticks ago; a view."""
        return self._register[ago + self._delays[stream], self._rows[stream]]

    def latest(self, stream: str, ticks: int) -> Array:
        """The `ticks` most recent values (ticks, N), newest first; a view."""
        start = self._delays[stream]
        return self._register[start : start + ticks, self._rows[stream]]

    def forget(self, stream: str, trials: Booleans) -> None:
        """Empty a stream in some of the trials (N,)."""
        self._register[:, self._rows[stream], trials] = np.nan
