"""Rotations and rigid poses.

`T_a_b` is a 4x4 matrix that takes coordinates in frame b to frame a: p_a = T_a_b p_b. Poses are
composed with `@`: T_a_c = T_a_b @ T_b_c. Leading axes (...) are broadcast.
"""

from handeye.geometry.poses import invert as invert
from handeye.geometry.poses import make_pose as make_pose
from handeye.geometry.poses import transform as transform
from handeye.geometry.registration import rigid_transform as rigid_transform
from handeye.geometry.rotations import matrix_from_wxyz as matrix_from_wxyz
from handeye.geometry.rotations import nearest_rotation as nearest_rotation
from handeye.geometry.rotations import wxyz_from_matrix as wxyz_from_matrix
