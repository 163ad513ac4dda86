"""Where the eye of a planar robot stands, from sightings of its hand."""

from dataclasses import replace

import numpy as np
from scipy.optimize import least_squares

from handeye.arrays import Array
from handeye.calibration.plant import PlanarPlant
from handeye.geometry import rigid_transform
from handeye.geometry.angles import wrap
from handeye.observations import StereoObservation


def eye_points(observations: StereoObservation) -> Array:
    """Sightings as points (N, 2) [m] in the frame of the pointing encoder's zero."""
    theta = observations.pointing + observations.eccentricity
    return observations.range[:, np.newaxis] * np.stack([np.cos(theta), np.sin(theta)], axis=-1)


def place_eye(nominal: PlanarPlant, observations: StereoObservation) -> PlanarPlant:
    """The plant with v_x, v_y and the pointing encoder's offset fitted to N sightings.

    Closed form first: the rigid motion from the points seen to the nominal hand. Then robust least
    squares on range and bearing, each over its standard deviation, with the arm as it is:

        r_i - |t_i - v|,    theta_i + O_gamma - arg(t_i - v)

    Raises:
        InvalidInput: for fewer than three sightings, or hands on one line.
    """
    seen = replace(observations, range=observations.range / nominal.head.range_scale)
    tips = nominal.tips(seen.joints)
    flat = np.zeros((len(tips), 1))
    T_base_eye = rigid_transform(np.hstack([eye_points(seen), flat]), np.hstack([tips, flat]))
    offset = float(np.arctan2(T_base_eye[1, 0], T_base_eye[0, 0]))
    theta = seen.pointing + seen.eccentricity
    # What matters is the ratio of range to bearing noise, so a noise-free head is given that of
    # its defaults.
    head = nominal.head if nominal.head.pixel_pitch > 0.0 else type(nominal.head)()
    range_std = head.range_std(seen.range, seen.eccentricity)
    bearing_std = head.eccentricity_std(seen.eccentricity)

    def residuals(parameters: Array) -> Array:
        x, y = tips[:, 0] - parameters[0], tips[:, 1] - parameters[1]
        along = (seen.range - np.hypot(x, y)) / range_std
        across = wrap(theta + parameters[2] - np.arctan2(y, x)) / bearing_std
        return np.concatenate([along, across])

    start = np.array([T_base_eye[0, 3], T_base_eye[1, 3], offset])
    # The arm's own errors are many times the noise; soft_l1 from their size on is robust to more.
    scale = max(float(np.median(np.abs(residuals(start)))) * 3.0, 1.0)
    fit = least_squares(residuals, start, loss="soft_l1", f_scale=scale)
    v_x, v_y, offset = (float(p) for p in fit.x)
    return replace(nominal, v_x=v_x, v_y=v_y, gamma=replace(nominal.gamma, offset=offset))
