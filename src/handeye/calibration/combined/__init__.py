"""Calibration of the whole chain at once: parameters, a curve for each stage, and what remains."""

from handeye.calibration.combined.calibrator import Combined as Combined
from handeye.calibration.combined.design import Suggestion as Suggestion
from handeye.calibration.combined.events import Event as Event
from handeye.calibration.combined.floor import Informed as Informed
from handeye.calibration.combined.floor import floor as floor
from handeye.calibration.combined.knowledge import PartKnowledge as PartKnowledge
from handeye.calibration.combined.knowledge import RobotKnowledge as RobotKnowledge
from handeye.calibration.combined.settings import Hypothesis as Hypothesis
from handeye.calibration.combined.settings import Settings as Settings
from handeye.calibration.combined.sheet import DataSheet as DataSheet
from handeye.calibration.combined.storage import combined_from_arrays as combined_from_arrays
from handeye.calibration.combined.storage import combined_to_arrays as combined_to_arrays
