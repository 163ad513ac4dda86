"""The plants of chapter 3, number by number."""

from math import pi

import pytest

from handeye.thesis.plants import LARGE, NOMINAL, NORMAL

PARAMETERS = (
    "a",
    "b",
    "v_x",
    "v_y",
    "O_alpha",
    "O_beta",
    "O_gamma",
    "eta",
    "zeta",
    "nu",
    "xi",
    "kappa",
)
TABLES = {
    "nominal": (NOMINAL, (1.0, 1.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0)),
    "normal": (
        NORMAL,
        (1.005, 1.003, -1.01, -0.02, 0.0, 0.018, 0.035, 1.5e-2, 5.0e-3, 2.0e-3, -1.7e-3, 1.8e-3),
    ),
    "large": (
        LARGE,
        (1.05, 0.96, -1.08, 0.10, 0.0, 0.10, 0.20, 7.5e-2, 1.25e-2, 1e-2, -8.686e-3, 9.143e-3),
    ),
}


@pytest.mark.parametrize("name", TABLES)
def test_tables_3_1_to_3_4(name):
    plant, values = TABLES[name]
    found = (
        plant.arm.a, plant.arm.b, plant.v_x, plant.v_y, plant.alpha.offset, plant.beta.offset,
        plant.gamma.offset, plant.head.eccentricity_warp, plant.head.range_warp,
        plant.gamma.amplitude, plant.alpha.amplitude, plant.beta.amplitude,
    )  # fmt: skip
    assert dict(zip(PARAMETERS, found, strict=True)) == dict(zip(PARAMETERS, values, strict=True))


@pytest.mark.parametrize("plant", [NORMAL, LARGE], ids=["normal", "large"])
def test_forms_of_the_periodic_errors(plant):
    # Eq 3.33, 3.35, 3.36: sin(3 gamma + 0.7), sin(alpha + 2), sin(beta - 1).
    assert (plant.gamma.frequency, plant.gamma.phase) == (3.0, 0.7)
    assert (plant.alpha.frequency, plant.alpha.phase) == (1.0, 2.0)
    assert (plant.beta.frequency, plant.beta.phase) == (1.0, -1.0)


@pytest.mark.parametrize("plant", [NOMINAL, NORMAL, LARGE], ids=["nominal", "normal", "large"])
def test_every_head_has_the_cameras_of_section_3_4_2(plant):
    head = plant.head
    cameras = (head.pixel_pitch, head.focal_length, head.baseline, head.field_of_view)
    assert cameras == (0.0275e-3, 8.0e-3, 0.5, pi / 3.0)
    assert head.range_scale == 1.0
