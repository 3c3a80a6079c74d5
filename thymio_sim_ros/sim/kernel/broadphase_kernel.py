"""Kernel: which of many robots may reach something. The tests of `BroadphaseBatch.near`, operation by operation."""

from __future__ import annotations

from thymio_sim_ros.sim.kernel.compiler import Floats, Ints

__all__ = ["COUNTS", "KERNELS", "first_from", "near"]

KERNELS = ("first_from", "near")

COUNTS = ("robots", "fixed", "objects")
_ROBOTS, _FIXED, _OBJECTS = range(len(COUNTS))
_ROBOT_REACH, _OBJECT_REACH = 0, 1
"""Places in `sizes`: between two robots; beyond a thing's radius."""


def first_from(count: int, order: Ints, xs: Floats, least: float) -> int:
    """The first place in the order whose x is not less."""
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
    """`order` is that of last time, and is put right; rows of `fixed`, `bounds` and `objects` are values."""
    robots = counts[_ROBOTS]
    for robot in range(robots):
        found[robot] = 0
    for place in range(1, robots):
        robot = order[place]
        at = place
        while at > 0 and xs[order[at - 1]] > xs[robot]:
            order[at] = order[at - 1]
            at = at - 1
        order[at] = robot

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
