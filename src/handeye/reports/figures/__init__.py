"""Figures drawn from plain arrays: they run nothing and know no experiment."""

from handeye.reports.figures.curves import Curve as Curve
from handeye.reports.figures.curves import learning_curve as learning_curve
from handeye.reports.figures.distribution import error_distribution as error_distribution
from handeye.reports.figures.joints import residuals_by_joint as residuals_by_joint
from handeye.reports.figures.maps import error_map as error_map
from handeye.reports.figures.picture import errors_in_picture as errors_in_picture
from handeye.reports.figures.running import running_error as running_error
from handeye.reports.figures.space import error_in_space as error_in_space
from handeye.reports.figures.story import PlanarArm as PlanarArm
from handeye.reports.figures.story import Stage as Stage
from handeye.reports.figures.story import robot_story as robot_story
from handeye.reports.figures.workspace import expected_map as expected_map
