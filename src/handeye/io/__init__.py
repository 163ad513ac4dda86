"""Logs, targets and stored arrays on disk."""

from handeye.io.convert import convert as convert
from handeye.io.logs import read_log as read_log
from handeye.io.logs import write_log as write_log
from handeye.io.records import BadRow as BadRow
from handeye.io.records import Log as Log
from handeye.io.records import LogReading as LogReading
from handeye.io.targets import read_point_targets as read_point_targets
from handeye.io.targets import read_stereo_targets as read_stereo_targets
