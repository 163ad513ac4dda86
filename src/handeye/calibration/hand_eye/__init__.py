"""Hand-eye and robot-world calibration from nothing: A X = X B and A X = Z B.

`solve` takes pairs of poses, `solve_arm` joints and poses; both return a `HandEye`.
"""

from handeye.calibration.hand_eye.beliefs import Mounting as Mounting
from handeye.calibration.hand_eye.beliefs import Tolerances as Tolerances
from handeye.calibration.hand_eye.noise import Noise as Noise
from handeye.calibration.hand_eye.result import HandEye as HandEye
from handeye.calibration.hand_eye.solution import solve as solve
from handeye.calibration.hand_eye.solution import solve_arm as solve_arm
