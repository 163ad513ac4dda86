"""Calibration of the whole chain at once: parameters, a curve for each stage, and what remains."""

from handeye.calibration.arm.sheet import ArmSheet as ArmSheet
from handeye.calibration.arm.sheet import CurveTerms as CurveTerms
from handeye.calibration.combined.calibrator import Combined as Combined
from handeye.calibration.combined.planar.floor import Informed as Informed
from handeye.calibration.combined.planar.floor import floor as floor
from handeye.calibration.combined.planar.sheet import DataSheet as DataSheet
from handeye.calibration.combined.robots import knows as knows
from handeye.calibration.combined.storage import combined_from_arrays as combined_from_arrays
from handeye.calibration.combined.storage import combined_to_arrays as combined_to_arrays
from handeye.calibration.engine.events import Event as Event
from handeye.calibration.engine.knowledge import PartKnowledge as PartKnowledge
from handeye.calibration.engine.knowledge import RobotKnowledge as RobotKnowledge
from handeye.calibration.engine.settings import Hypothesis as Hypothesis
from handeye.calibration.engine.settings import Settings as Settings
from handeye.calibration.engine.suggestion import Suggestion as Suggestion
