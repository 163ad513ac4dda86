"""Records that were never measured."""

from collections.abc import Mapping

import numpy as np

from handeye.thesis.claims import load_claims
from handeye.thesis.records import Record, Records
from handeye.thesis.shapes import SHAPES, Finding

LIMITS = {claim.id: claim.limits for claim in load_claims()}
MARKS = tuple(float(at) for at in range(0, 5001, 100))
REPLICATES = 4


def curves(paths: Mapping[str, object]) -> Records:
    """Curves over MARKS by path, from values (M,) or one for all marks.

    Replicates differ by a part in a thousand, the same in every path as worlds are shared.
    """
    rows: list[Record] = []
    for path, given in paths.items():
        values = np.broadcast_to(np.asarray(given, np.float64), len(MARKS))
        for replicate in range(REPLICATES):
            shared = 1.0 + 1e-3 * replicate
            rows += [
                Record(*_split(path, replicate), at, float(value * shared))
                for at, value in zip(MARKS, values, strict=True)
            ]
    return Records(rows)


def _split(path: str, replicate: int) -> tuple[str, str, int, str]:
    experiment, setting, quantity = path.split("/")
    return experiment, setting, replicate, quantity


def judged(claim: str, paths: Mapping[str, object]) -> Finding:
    """What the claim's predicate, with the claim's own limits, finds in made-up curves."""
    return SHAPES[claim](curves(paths), LIMITS[claim])
