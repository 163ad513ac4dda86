"""The planar robot's chain, from its nominal plant and a data sheet."""

import numpy as np

from handeye.arrays import Array
from handeye.calibration.combined.planar.curves import curve_std
from handeye.calibration.combined.planar.kernels import PARAMETERS, Planar
from handeye.calibration.combined.planar.sheet import DataSheet
from handeye.calibration.engine.chain import Chain, Direction, Group
from handeye.calibration.estimation.gauges import gauges
from handeye.calibration.estimation.parameters import NAMES, vector
from handeye.calibration.models import PlanarModel
from handeye.calibration.plant import PlanarPlant
from handeye.observations import StereoObservation, StereoTarget

AXES = ("alpha", "beta", "gamma")
_CURVE_TERMS = 16
# Terms of a curve vanish at the ends of their interval, so it reaches beyond a full turn.
_HALF = 1.25 * np.pi
_RIPPLE_LENGTH = 0.35
# Degrees in eccentricity and range. A pure shift and growth of range are range_scale's; bearing
# has no constant, which would be O_gamma's.
_BEARING_TERMS = (
    (0, 1), (0, 2), (1, 0), (1, 1), (1, 2), (1, 3), (2, 0), (2, 1), (2, 2), (2, 3),
    (3, 0), (3, 1), (3, 2), (4, 0), (4, 1), (5, 0), (6, 0),
)  # fmt: skip
_RANGE_TERMS = (
    (0, 0), (0, 2), (0, 3), (0, 4), (1, 0), (1, 1), (2, 0), (2, 1), (2, 2), (3, 0), (4, 0),
)  # fmt: skip
# Every further degree is expected to be smaller by so much.
_FALL = 0.25
_RANGE_FALL = 0.15
# Errors of baseline and vergence grow with range and its square: few are constant.
_CONSTANT_RANGE = 0.3
# Lenses bend range less than they bend directions.
_ECCENTRIC_RANGE = 0.1


def planar_chain(model: PlanarModel, sheet: DataSheet) -> Chain:
    """What the engine is told: eight parameters, a curve for each axis, two for the camera.

    Raises InvalidInput for a nominal plant that drifts.
    """
    nominal = model.nominal
    m = _CURVE_TERMS
    middle = 0.5 * (nominal.arm.reach + float(np.hypot(nominal.v_x, nominal.v_y)))
    kernel = Planar(
        nominal=vector(nominal),
        half=_HALF,
        n_curve=m,
        bearing_terms=np.array(_BEARING_TERMS, np.int64),
        range_terms=np.array(_RANGE_TERMS, np.int64),
        field=0.5 * nominal.head.field_of_view,
        middle=middle,
        span=middle,
        pitch=nominal.head.pixel_pitch / nominal.head.focal_length,
        baseline=nominal.head.baseline,
    )
    parts = _parts(sheet)
    tolerance = np.concatenate([std for _, _, std in parts])
    names, groups = list(NAMES), _parameter_groups()
    at = PARAMETERS
    for words, symbol, std in parts[1:]:
        names += [f"{symbol}[{k}]" for k in range(len(std))]
        groups.append(Group(words, tuple(range(at, at + len(std)))))
        at += len(std)
    lengths = {"a", "b", "v_x", "v_y"}
    range_names = {name for name in names if name.startswith("c_r[")}
    units = tuple(
        "m" if n in lengths | range_names else "" if n == "range_scale" else "rad" for n in names
    )
    return Chain(
        kernel=kernel,
        names=tuple(names),
        units=units,
        nominal=np.concatenate([kernel.nominal, np.zeros(at - PARAMETERS)]),
        tolerance=tolerance,
        curved=np.arange(at) >= PARAMETERS,
        n_moving=PARAMETERS,
        n_values=2,
        n_hand=2,
        n_seen=5,
        groups=tuple(groups),
        changes=(*groups, Group("camera remounted (place and zero)", (2, 3, 6))),
        gauges=_gauges(nominal, sheet, at),
    )


def _parts(sheet: DataSheet) -> list[tuple[str, str, Array]]:
    """Words, symbol and tolerances of each group of unknowns, in order."""
    parameters = [sheet.link] * 2 + [sheet.eye] * 2 + [sheet.offset] * 3 + [sheet.range_scale]
    parts = [("parameters", "", np.array(parameters))]
    for axis in AXES:
        pointing = axis == "gamma"
        smooth = (
            (sheet.pointing_curve, sheet.pointing_length)
            if pointing
            else (sheet.joint_curve, sheet.joint_length)
        )
        std = curve_std(_CURVE_TERMS, _HALF, (smooth, (sheet.ripple, _RIPPLE_LENGTH)))
        parts.append((f"error curve of {axis}", f"c_{axis}", std))
    lens = [_FALL ** (max(i - 2, 0) + (j if i else j - 1)) for i, j in _BEARING_TERMS]
    parts.append(("lens distortion", "c_eps", sheet.lens * np.array(lens)))
    bent = [
        (_CONSTANT_RANGE if i == j == 0 else _ECCENTRIC_RANGE**i * _RANGE_FALL ** max(j - 2, 0))
        for i, j in _RANGE_TERMS
    ]
    parts.append(("range error curve", "c_r", sheet.range_curve * np.array(bent)))
    return parts


def _parameter_groups() -> list[Group]:
    words = (
        "length of link a",
        "length of link b",
        "encoder offset of alpha",
        "encoder offset of beta",
        "encoder offset of gamma",
        "range scale",
    )
    groups = [Group(w, (k,)) for w, k in zip(words, (0, 1, 4, 5, 6, 7), strict=True)]
    return [*groups, Group("place of the camera", (2, 3))]


def _gauges(nominal: PlanarPlant, sheet: DataSheet, n: int) -> tuple[Direction, ...]:
    tolerance = _parts(sheet)[0][2]
    found = gauges(vector(nominal), np.arange(PARAMETERS), tolerance)
    rest = np.zeros(n - PARAMETERS)
    return tuple(Direction(np.concatenate([g.direction, rest]), g.words) for g in found)


def seen_rows(observations: StereoObservation) -> Array:
    """One observation (5,) or N (N, 5) as the kernels read them."""
    o = observations
    if o.joints.ndim == 1:
        return np.array((*o.joints, o.pointing, o.range, o.eccentricity))
    parts = (o.joints[..., 0], o.joints[..., 1], o.pointing, o.range, o.eccentricity)
    return np.stack(parts, axis=-1)


def target_rows(target: StereoTarget) -> Array:
    """The same of targets: joints are only told by the elbow, (5,) or (N, 5)."""
    if target.range.ndim == 0:
        return np.array((0.0, target.elbow, target.pointing, target.range, target.eccentricity))
    unknown = np.zeros_like(target.range)
    parts = (unknown, target.elbow, target.pointing, target.range, target.eccentricity)
    return np.stack(parts, axis=-1)
