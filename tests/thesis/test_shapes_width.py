import numpy as np
import pytest
from tests.thesis.made_up import MARKS, judged

from handeye.arrays import Array

WIDTHS = {0.4: 0.009, 0.8: 0.008, 2.0: 0.010, 4.0: 0.015, 10.0: 0.020, 100.0: 0.022}


def growing(by: float) -> Array:
    """An error whose end is that many times its lowest."""
    return np.where(np.array(MARKS) < 1000.0, 0.01, 0.01 * by)


def widths(change: dict[float, float], narrow: float) -> dict[str, object]:
    made: dict[float, object] = {0.1: growing(9.0), 0.2: growing(narrow), **(WIDTHS | change)}
    paths: dict[str, object] = {f"width/h-{h}/error": v for h, v in made.items()}
    return paths | {"width/all-active-h-0.1/error": 1.9}


@pytest.mark.parametrize(
    ("change", "narrow", "holds"),
    [
        ({}, 1.6, True),
        ({}, 1.4, False),
        ({0.4: 0.016}, 1.6, False),
        ({4.0: 0.0099}, 1.6, False),
        ({100.0: 0.025}, 1.6, False),
        ({100.0: 0.017}, 1.6, True),
    ],
)
def test_widths(change: dict[float, float], narrow: float, holds: bool):
    found = judged("width-h", widths(change, narrow))
    assert found.holds is holds
    assert found.held == (holds,) * 4


def responses(change: dict[str, object]) -> dict[str, object]:
    made: dict[str, object] = {
        f"{kind}-h-{h}": level
        for kind in ("parabolic", "cosine")
        for h, level in {0.6: growing(3.0), 0.8: growing(2.0), 1.0: 0.009, 2.0: 0.012}.items()
    }
    made |= {"gaussian-h-1.2": 0.008, "all-active-parabolic-h-0.8": 1.0, **change}
    return {f"responses/{name}/error": level for name, level in made.items()}


@pytest.mark.parametrize(
    ("change", "holds"),
    [
        ({}, True),
        ({"parabolic-h-0.8": growing(1.3)}, False),
        ({"cosine-h-0.6": 0.02}, False),
        ({"cosine-h-2.0": growing(1.6)}, False),
        ({"cosine-h-2.0": 0.0145}, False),
        ({"gaussian-h-1.2": 0.0092}, False),
        ({"gaussian-h-1.2": 0.0070}, False),
    ],
)
def test_other_responses(change: dict[str, object], holds: bool):
    found = judged("other-responses", responses(change))
    assert found.holds is holds
    assert found.held == (holds,) * 4


def test_notes_give_growth_and_what_correcting_all_does():
    assert "0.1 9.00, 0.2 1.60" in judged("width-h", widths({}, 1.6)).note
    assert "corrected: 0.1 1.90 m" in judged("width-h", widths({}, 1.6)).note
    assert (
        "At best behind Gaussian: parabolic 1.00 mm"
        in judged("other-responses", responses({})).note
    )
