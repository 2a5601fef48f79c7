"""How the joints move the tip: in one order of sums, so that the bits depend on no library of linear algebra."""

import numpy as np

TIP_SPEED = 0.04  # of the tip at action 1 [m/s]


def _dot(a, b):
    """In one order: numpy and sum() have others, by processor and version."""
    total = 0.0
    for x, y in zip(a, b):
        total += x * y
    return total


def _cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def tip_motion(jacobian, pose, speed, limits, damping=2e-3):
    """Shares (4,) of the joint speeds that move the tip with a speed (3,) in its own axes [m/s]: damped least squares in
    units of the limits, scaled down together where one would exceed its limit (Wampler 1986). The same numbers give the
    same bits with every library of linear algebra."""
    turn, speed, limits = pose[:3, :3].tolist(), list(map(float, speed)), list(map(float, limits))
    wanted = [_dot(row, speed) for row in turn]
    rows = [[x * limit for x, limit in zip(row, limits)] for row in jacobian[:3].tolist()]
    square = [[_dot(a, b) + (damping**2 if a is b else 0.0) for b in rows] for a in rows]  # symmetric, positive
    minors = [_cross(square[1], square[2]), _cross(square[2], square[0]), _cross(square[0], square[1])]
    size = _dot(square[0], minors[0])
    solved = [_dot(column, wanted) / size for column in zip(*minors)]
    shares = [_dot(column, solved) for column in zip(*rows)]
    most = max(1.0, *map(abs, shares))
    return np.array([share / most for share in shares])
