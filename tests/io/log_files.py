"""Logs to write and to spoil, shared by the tests of logs."""

from dataclasses import fields

import numpy as np
import pytest

from handeye.errors import LogError
from handeye.io.logs import Log, read_log
from handeye.observations import PointObservation, StereoObservation

HEADER = "time_s,a_rad,b_rad,x_m,y_m,z_m"
ROWS = ["0,0.1,0.2,1,2,3", "1,0.2,0.3,1.1,2.1,3.1", "2,0.3,0.4,1.2,2.2,3.2", "3,0.4,0.5,1,2,3"]


def error_of(path, **options):
    with pytest.raises(LogError) as caught:
        read_log(path, **options)
    assert str(path) in str(caught.value)
    return str(caught.value)


def point_log(n, joints=("a", "b"), *, oriented=False, std=False, seed=0):
    rng = np.random.default_rng(seed)
    wxyz = rng.normal(size=(n, 4))
    seen = PointObservation(
        np.cumsum(rng.uniform(0.01, 1.0, n)),
        rng.uniform(-3.0, 3.0, (n, len(joints))),
        rng.normal(size=(n, 3)),
        wxyz / np.linalg.norm(wxyz, axis=1, keepdims=True) if oriented else None,
        rng.uniform(1e-5, 1e-3, (n, 3)) if std else None,
    )
    return Log("made", joints, seen, np.arange(2, n + 2))


def stereo_log(n, seed=0):
    rng = np.random.default_rng(seed)
    seen = StereoObservation(
        np.arange(float(n)),
        rng.uniform(-3.0, 3.0, (n, 2)),
        rng.uniform(-1.0, 1.0, n),
        rng.uniform(0.1, 5.0, n),
        rng.uniform(-1.0, 1.0, n),
    )
    return Log("made", ("alpha", "beta"), seen, np.arange(2, n + 2))


def assert_same(read, written):
    assert type(read.observations) is type(written.observations)
    assert read.joint_names == written.joint_names
    for field in fields(written.observations):
        want = getattr(written.observations, field.name)
        have = getattr(read.observations, field.name)
        if want is None:
            assert have is None
        else:
            np.testing.assert_array_equal(have, want)
