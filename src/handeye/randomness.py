"""Random streams by name, so that methods that are compared see the same world and noise."""

from zlib import crc32

import numpy as np


def stream(name: str, replicate: int = 0) -> np.random.Generator:
    """An independent generator for each name and replicate number; the same on every machine.

    A world draws its poses from one stream and its noise from another, a learner from a third:
    changing how much one of them draws leaves the others as they were.
    """
    return np.random.default_rng(np.random.SeedSequence([crc32(name.encode()), replicate]))
