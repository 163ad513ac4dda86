"""How much each part of a model contributes, on rows that were held out."""

from dataclasses import dataclass

import numpy as np

from handeye.arrays import Array
from handeye.calibration.results import CalibrationResult, ErrorSummary

_ALL = "all that was learned"
_LEARNED = {"network": "network", "estimator": "parameters"}


@dataclass(frozen=True)
class Contribution:
    """What is left with the model up to a part of it.

    part         placement of base and marker; geometry (lengths, directions, zeros, scales and
                 compliance of joints); error curves; or what else learns
    error        of positions [m]
    orientation  of orientations in degrees, None where none was measured
    """

    part: str
    error: ErrorSummary
    orientation: ErrorSummary | None


def contributions(result: CalibrationResult) -> tuple[Contribution, ...]:
    """One part after the other, each with those before it; nothing where no row was held out."""
    held = result.held_out
    if held is None or not len(held.rows):
        return ()

    def with_part(part: str, errors: Array, turns: Array | None) -> Contribution:
        turned = None if turns is None else ErrorSummary.of(np.degrees(turns), held.alike)
        return Contribution(part, ErrorSummary.of(errors, held.alike), turned)

    found = [with_part("placement", held.before, held.turns_before)]
    if result.method == "nominal":
        return tuple(found)
    last = _LEARNED.get(result.method, _ALL)
    if held.rigid is not None:
        found.append(with_part("geometry", held.rigid, held.turns_rigid))
        last = "error curves"
    return (*found, with_part(last, held.after, held.turns_after))
