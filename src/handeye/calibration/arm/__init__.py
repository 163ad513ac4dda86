"""Serial arms described by URDF files, with errors in every stage."""

from handeye.calibration.arm.estimator import ArmEstimator as ArmEstimator
from handeye.calibration.arm.sheet import ArmSheet as ArmSheet
from handeye.calibration.arm.sheet import CurveTerms as CurveTerms
