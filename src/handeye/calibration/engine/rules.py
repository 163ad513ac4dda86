"""The engine's rules, from a chain and settings."""

import numpy as np

from handeye.calibration.engine.chain import Chain
from handeye.calibration.engine.filter import Rules
from handeye.calibration.engine.settings import Settings

BLOCK = 64
"""Observations from one fading of old information to the next, at least."""
_WALK_EVERY = 4
_BEND = 0.2
_MEMORY = 0.995


def rules_for(chain: Chain, settings: Settings) -> Rules:
    """What stays the same for a robot."""
    spreads = np.array(
        [np.where(chain.curved & (not h.curved), 0.0, chain.tolerance) for h in settings.hypotheses]
    )
    n = len(chain.names)
    # Fading costs O(n^3), an observation O(n^2).
    block = max(BLOCK, n // 2)
    raw = np.array([g.direction for g in chain.gauges]).reshape(-1, n)
    basis = np.linalg.qr(raw.T).Q.T
    most = max(len(change.places) for change in chain.changes)
    changes = np.full((len(chain.changes), most), -1)
    for i, change in enumerate(chain.changes):
        changes[i, : len(change.places)] = change.places
    return Rules(
        spreads=spreads,
        gauges=np.ascontiguousarray(np.broadcast_to(basis, (len(spreads), *basis.shape))),
        walks=np.array([h.walk for h in settings.hypotheses], np.float64),
        keeps=np.exp(-block / np.array([h.memory for h in settings.hypotheses], np.float64)),
        moving=chain.n_moving,
        walk_every=_WALK_EVERY,
        block=block,
        changes=changes,
        bend=_BEND,
        memory=_MEMORY,
    )
