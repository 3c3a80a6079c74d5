"""Kernel: which of many robots may reach something. The tests of `BroadphaseBatch.near`, operation by operation."""

from __future__ import annotations

from thymio_sim_ros.sim.kernel.compiler import Floats, Ints

__all__ = ["COUNTS", "KERNELS", "first_from", "near"]

KERNELS = ("first_from", "near")

COUNTS = ("robots", "fixed", "objects")
_ROBOTS, _FIXED, _OBJECTS = range(len(COUNTS))
_ROBOT_REACH, _OBJECT_REACH = 0, 1
"""Indices in `sizes`: reach between two robots, and beyond the radius of an object."""


def first_from(count: int, order: Ints, xs: Floats, least: float) -> int:
    """Return the first index in the order whose x is not below `least`: binary search."""
    low = 0
    high = count
    while low < high:
        middle = (low + high) >> 1
        if xs[order[middle]] < least:
            low = middle + 1
        else:
            high = middle
    return low


def near(
    counts: Ints, sizes: Floats, xs: Floats, ys: Floats, stands: Ints, fixed: Floats, bounds: Floats, objects: Floats,
    order: Ints, found: Ints,
) -> None:  # fmt: skip
    """Write to `found` whether each robot may reach anything.

    Args:
        counts: see `COUNTS`.
        sizes: see `_ROBOT_REACH` and `_OBJECT_REACH`.
        xs: x of the centers of the robots' circles; `ys`: y.
        stands: whether each robot stands, shape (robots,).
        fixed: x, y, cosine, sine, half size along and across, reach of the obstacles, shape (7, fixed).
        bounds: left, right, middle and half width in y of the obstacles, shape (4, fixed).
        objects: x, y and radius of the objects, shape (3, objects).
        order: robots sorted by x; on entry the order of the last call.
        found: result, shape (robots,).
    """
    robots = counts[_ROBOTS]
    for robot in range(robots):
        found[robot] = 0
    # Insertion sort: robots hardly change their order between two calls, so this is nearly linear.
    for place in range(1, robots):
        robot = order[place]
        at = place
        while at > 0 and xs[order[at - 1]] > xs[robot]:
            order[at] = order[at - 1]
            at = at - 1
        order[at] = robot

    # Pairs of robots: compare each with its successors, as long as they are within reach in x.
    reach = sizes[_ROBOT_REACH]
    for place in range(robots):
        robot = order[place]
        if stands[robot] != 0:
            after = place + 1
            while after < robots and xs[order[after]] - xs[robot] < reach:
                other = order[after]
                dx = xs[robot] - xs[other]
                dy = ys[robot] - ys[other]
                if stands[other] != 0 and dx * dx + dy * dy < reach * reach:
                    found[robot] = 1
                    found[other] = 1
                after = after + 1

    count = counts[_OBJECTS]
    for object_ in range(count):
        x = objects[object_]
        y = objects[count + object_]
        reach = objects[2 * count + object_] + sizes[_OBJECT_REACH]
        at = first_from(robots, order, xs, x - reach)
        while at < robots and xs[order[at]] <= x + reach:
            robot = order[at]
            dx = xs[robot] - x
            dy = ys[robot] - y
            if stands[robot] != 0 and dx * dx + dy * dy < reach * reach:
                found[robot] = 1
            at = at + 1

    count = counts[_FIXED]
    for wall in range(count):
        cos = fixed[2 * count + wall]
        sin = fixed[3 * count + wall]
        reach = fixed[6 * count + wall]
        at = first_from(robots, order, xs, bounds[wall])
        while at < robots and xs[order[at]] <= bounds[count + wall]:
            robot = order[at]
            if stands[robot] != 0 and abs(ys[robot] - bounds[2 * count + wall]) <= bounds[3 * count + wall]:
                dx = xs[robot] - fixed[wall]
                dy = ys[robot] - fixed[count + wall]
                along = max(abs(cos * dx + sin * dy) - fixed[4 * count + wall], 0.0)
                across = max(abs(cos * dy - sin * dx) - fixed[5 * count + wall], 0.0)
                if along * along + across * across < reach * reach:
                    found[robot] = 1
            at = at + 1
