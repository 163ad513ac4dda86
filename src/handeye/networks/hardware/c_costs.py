"""What an exported chip costs on a processor: bytes, and operations of a prediction and a trial."""

from dataclasses import dataclass

from handeye.networks.adaptation import CMAC, NoAdaptation
from handeye.networks.hardware.chip import HardwareNetwork
from handeye.networks.hardware.costs import Operations, most_operations
from handeye.networks.hardware.operations import KINDS

_DOUBLE = 8
_DISTANCE = 8
_NOISE = 4


def word_type(word_length: int) -> str:
    """The smallest signed type of C that holds a word."""
    return f"int{_bits(word_length)}_t"


def _bits(word_length: int) -> int:
    return next(bits for bits in (8, 16, 32) if bits >= word_length)


@dataclass(frozen=True)
class CCosts:
    """Bytes and operations.

    constants   of centers, widths, first weights and tables, which never change
    state       of the struct that changes
    operations  of one prediction, and at most of one trial
    learns      whether there are trials
    """

    constants: int
    state: int
    operations: Operations
    learns: bool

    @classmethod
    def of(cls, chip: HardwareNetwork) -> "CCosts":
        """Those of a chip's C files; in floating point, with double precision."""
        n, d, m = chip.n_neurons, chip.n_inputs, chip.n_outputs
        rule = type(chip.design.adaptation)
        learns = rule is not NoAdaptation
        responses = 0 if not learns else 1 if rule is CMAC else 2
        fixed = chip.design.fixed
        if fixed is None:
            constants = _DOUBLE * (n * (d + 1 + m) + d)
            state = _DOUBLE * n * (m + responses + int(learns))
        else:
            word = _bits(fixed.word_length) // 8
            tables = len(chip.tables.responses) + learns * len(chip.tables.reciprocals)
            constants = word * (n * (d + 1 + m) + tables) + n
            state = word * n * (m + responses)
            if learns:
                state = _rounded_up(state + _DISTANCE * n + _NOISE, _DISTANCE)
        return cls(constants, state, most_operations(chip), learns)

    def rows(self) -> list[tuple[str, str, str]]:
        """A table: what, for a prediction, for a trial at most (empty without learning)."""
        predict, learn = self.operations
        return [
            (kind, f"{predict[kind]:,}", f"{learn[kind]:,}" if self.learns else "")
            for kind in KINDS
        ]

    def lines(self) -> list[str]:
        """The same as text, with the bytes."""
        head = ("", "predict", "learn, at most" if self.learns else "")
        table = [f"{a:<10}{b:>12}{c:>17}" for a, b, c in (head, *self.rows())]
        return [
            f"{self.constants:,} bytes of constants, {self.state:,} bytes of state",
            *table,
        ]


def _rounded_up(size: int, unit: int) -> int:
    return -(-size // unit) * unit
