"""The plants of chapter 3: nominal parameters, and the actual ones of tables 3.1 to 3.4."""

from handeye.calibration.plant import PlanarPlant
from handeye.robots.encoder import AxisEncoder
from handeye.robots.planar import TwoLinkArm
from handeye.sensors.stereo import StereoHead

NOMINAL = PlanarPlant(
    arm=TwoLinkArm(a=1.0, b=1.0),
    v_x=-1.0,
    v_y=0.0,
    alpha=AxisEncoder(),
    beta=AxisEncoder(),
    gamma=AxisEncoder(),
    head=StereoHead(),
)
"""What the engineer knows (tables 3.1, 3.3); seen through a noisy head."""

NORMAL = PlanarPlant(
    arm=TwoLinkArm(a=1.005, b=1.003),
    v_x=-1.01,
    v_y=-0.02,
    alpha=AxisEncoder(offset=0.0, amplitude=-1.7e-3, frequency=1.0, phase=2.0),
    beta=AxisEncoder(offset=0.018, amplitude=1.8e-3, frequency=1.0, phase=-1.0),
    gamma=AxisEncoder(offset=0.035, amplitude=2.0e-3, frequency=3.0, phase=0.7),
    head=StereoHead(eccentricity_warp=1.5e-2, range_warp=5.0e-3),
)
"""The normal plant (tables 3.1, 3.2) with noise and perturbations."""

LARGE = PlanarPlant(
    arm=TwoLinkArm(a=1.05, b=0.96),
    v_x=-1.08,
    v_y=0.10,
    alpha=AxisEncoder(offset=0.0, amplitude=-8.686e-3, frequency=1.0, phase=2.0),
    beta=AxisEncoder(offset=0.10, amplitude=9.143e-3, frequency=1.0, phase=-1.0),
    gamma=AxisEncoder(offset=0.20, amplitude=1.0e-2, frequency=3.0, phase=0.7),
    head=StereoHead(eccentricity_warp=7.5e-2, range_warp=1.25e-2),
)
"""The plant with large errors (tables 3.3, 3.4) with noise and perturbations."""
