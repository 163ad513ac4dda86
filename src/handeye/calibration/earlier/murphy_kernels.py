"""The compiled loops of the MURPHY-type table."""

from typing import NamedTuple

import numpy as np

from handeye._compiled import compiled
from handeye.arrays import Array, Booleans, Integers

_FINEST = 1e-4
"""Where a search stops [rad]."""


class Codes(NamedTuple):
    """Populations of Gaussian units, evenly spaced, whose order is what they stand for.

    joint_first, joint_step, joints   centres of the units of either joint [rad], and how many
    image_first, image_step, images   centres along either axis of the image [m], and how many
    sharpness                         `1 / (2 s^2)` for a width of s steps
    on                                a unit is active when its activity exceeds this
    """

    joint_first: float
    joint_step: float
    joints: int
    image_first: float
    image_step: float
    images: int
    sharpness: float
    on: float


class Table(NamedTuple):
    """Which conjunction of joint units is connected to which image units.

    connected  (joints, joints, images, images)
    box        first and last connected image unit along both axes, (joints, joints, 4)
    sums       number of connected image units and sums of their places, (joints, joints, 3)
    """

    connected: Booleans
    box: Integers
    sums: Array


@compiled
def excite(
    value: float, first: float, step: float, sharpness: float, activity: Array
) -> tuple[int, int]:
    """Activities of a population's units at a value, and the range of those within reach.

    Units four steps away or more are silent: with widths of up to a step they are below any
    threshold that matters.
    """
    place = (value - first) / step
    place = min(max(place, -8.0), activity.size + 8.0)
    low = max(int(np.floor(place)) - 3, 0)
    high = min(int(np.floor(place)) + 5, activity.size)
    for i in range(low, high):
        activity[i] = np.exp(-sharpness * (place - i) * (place - i))
    return low, max(high, low)


@compiled
def connect(codes: Codes, table: Table, joints: Array, image: Array) -> int:
    """Connect every active conjunction with every active image unit; return how many are new."""
    a, b = np.empty(codes.joints), np.empty(codes.joints)
    u, v = np.empty(codes.images), np.empty(codes.images)
    a_low, a_high = excite(joints[0], codes.joint_first, codes.joint_step, codes.sharpness, a)
    b_low, b_high = excite(joints[1], codes.joint_first, codes.joint_step, codes.sharpness, b)
    u_low, u_high = excite(image[0], codes.image_first, codes.image_step, codes.sharpness, u)
    v_low, v_high = excite(image[1], codes.image_first, codes.image_step, codes.sharpness, v)
    new = 0
    for i in range(a_low, a_high):
        for j in range(b_low, b_high):
            if a[i] * b[j] <= codes.on:
                continue
            box, sums = table.box[i, j], table.sums[i, j]
            for p in range(u_low, u_high):
                for q in range(v_low, v_high):
                    if u[p] * v[q] <= codes.on or table.connected[i, j, p, q]:
                        continue
                    table.connected[i, j, p, q] = True
                    new += 1
                    box[0], box[1] = min(box[0], p), max(box[1], p + 1)
                    box[2], box[3] = min(box[2], q), max(box[3], q + 1)
                    sums[0] += 1.0
                    sums[1] += p
                    sums[2] += q
    return new


@compiled
def excite_images(codes: Codes, table: Table, joints: Array, total: Array) -> Integers:
    """Sum for each image unit the active conjunctions that are connected with it, at joints (2,).

    That is eq A.4 with weights of one. Returns the range of image units for which `total` was
    overwritten, first and last along both axes, (4,); it is empty where nothing is known.
    """
    a, b = np.empty(codes.joints), np.empty(codes.joints)
    a_low, a_high = excite(joints[0], codes.joint_first, codes.joint_step, codes.sharpness, a)
    b_low, b_high = excite(joints[1], codes.joint_first, codes.joint_step, codes.sharpness, b)
    span = np.array([codes.images, 0, codes.images, 0])
    for i in range(a_low, a_high):
        for j in range(b_low, b_high):
            if a[i] * b[j] > codes.on:
                box = table.box[i, j]
                span[0], span[1] = min(span[0], box[0]), max(span[1], box[1])
                span[2], span[3] = min(span[2], box[2]), max(span[3], box[3])
    for p in range(span[0], span[1]):
        for q in range(span[2], span[3]):
            total[p, q] = 0.0
    for i in range(a_low, a_high):
        for j in range(b_low, b_high):
            product = a[i] * b[j]
            if product > codes.on:
                box = table.box[i, j]
                for p in range(box[0], box[1]):
                    for q in range(box[2], box[3]):
                        if table.connected[i, j, p, q]:
                            total[p, q] += product
    return span


@compiled
def envision(
    codes: Codes, table: Table, share: float, joints: Array, total: Array, image: Array
) -> bool:
    """Where the hand would be seen with the arm at joints (2,): image (2,) [m], overwritten.

    Image units below `share` of the largest fall silent; the others, by how much they are above,
    are read out by their centre of mass. Returns whether anything is known there. `total` (images,
    images) is scratch.
    """
    span = excite_images(codes, table, joints, total)
    if span[1] <= span[0]:
        return False
    active = total[span[0] : span[1], span[2] : span[3]]
    silent = share * active.max()
    mass, x, y = 0.0, 0.0, 0.0
    for p in range(active.shape[0]):
        for q in range(active.shape[1]):
            over = active[p, q] - silent
            if over > 0.0:
                mass += over
                x += over * (span[0] + p)
                y += over * (span[2] + q)
    image[0] = codes.image_first + codes.image_step * x / mass
    image[1] = codes.image_first + codes.image_step * y / mass
    return True


@compiled
def begin(codes: Codes, table: Table, target: Array, elbow: float, joints: Array) -> bool:
    """Joints (2,), overwritten: the conjunction remembered nearest to a target with this elbow."""
    p = (target[0] - codes.image_first) / codes.image_step
    q = (target[1] - codes.image_first) / codes.image_step
    least = np.inf
    for i in range(codes.joints):
        for j in range(codes.joints):
            beta = codes.joint_first + codes.joint_step * j
            known = table.sums[i, j]
            if beta * elbow <= 0.0 or known[0] == 0.0:
                continue
            squared = (known[1] / known[0] - p) ** 2 + (known[2] / known[0] - q) ** 2
            if squared < least:
                least = squared
                joints[0] = codes.joint_first + codes.joint_step * i
                joints[1] = beta
    return least < np.inf


@compiled
def flail(
    codes: Codes,
    table: Table,
    share: float,
    target: Array,
    elbow: float,
    total: Array,
    joints: Array,
) -> None:
    """Joints (2,), overwritten, whose imagined hand is nearest to a target (2,) [m].

    Begins with the nearest remembered conjunction, tries either joint in both directions, keeps
    what brings the imagined hand nearer, and halves the step where nothing does. Zero where
    nothing is known yet.
    """
    joints[:] = 0.0
    if not begin(codes, table, target, elbow, joints):
        return
    trial, image = joints.copy(), np.empty(2)
    least = np.inf
    if envision(codes, table, share, joints, total, image):
        least = (image[0] - target[0]) ** 2 + (image[1] - target[1]) ** 2
    last = codes.joint_first + codes.joint_step * (codes.joints - 1)
    step = 0.5 * codes.joint_step
    while step > _FINEST:
        moved = False
        for move in range(4):
            trial[:] = joints
            trial[move // 2] += step if move % 2 == 0 else -step
            inside = abs(trial[0]) <= last and 0.0 < trial[1] * elbow <= last
            if inside and envision(codes, table, share, trial, total, image):
                squared = (image[0] - target[0]) ** 2 + (image[1] - target[1]) ** 2
                if squared < least:
                    least = squared
                    joints[:] = trial
                    moved = True
        if not moved:
            step *= 0.5


@compiled
def command_stream(
    codes: Codes, table: Table, share: float, targets: Array, elbows: Array, joints: Array
) -> None:
    """Joints (N, 2), overwritten, for targets (N, 2) [m]."""
    total = np.zeros((codes.images, codes.images))
    for n in range(len(targets)):
        flail(codes, table, share, targets[n], elbows[n], total, joints[n])


@compiled
def learn_stream(
    codes: Codes,
    table: Table,
    share: float,
    images: Array,
    joints: Array,
    commanded: Array,
    connections: Integers,
) -> None:
    """See the hand at images (N, 2) with the arm at joints (N, 2), one after the other.

    Overwrites what would have been commanded before each, (N, 2), and the number of connections
    that each has formed, (N,).
    """
    total = np.zeros((codes.images, codes.images))
    for n in range(len(images)):
        elbow = 1.0 if joints[n, 1] >= 0.0 else -1.0
        flail(codes, table, share, images[n], elbow, total, commanded[n])
        connections[n] = connect(codes, table, joints[n], images[n])
