"""Checks of a robot, to assert or to wait for; each describes the observed values. They combine with &, | and ~.

assert reached(thymio, (0.5, 0.0), tolerance=0.02)
thymio.until(reached(thymio, (0.5, 0.0)) & shows(thymio, "top", "green"), seconds=20)
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence

from thymio_sim_ros.sim.commands import LED_COLORS, LED_GROUPS
from thymio_sim_ros.sim.model.geometry import Pose, wrap_angle
from thymio_sim_ros.testing.thymio import Thymio

__all__ = ["Check", "emitted", "no_contact", "reached", "shows", "slower_than"]


class Check:
    """A condition that is evaluated at each use: by `assert`, as a condition of `until`, or as text."""

    def __init__(self, judge: Callable[[], tuple[bool, str]]) -> None:
        """`judge` returns whether the condition is true now, and a text with the observed and expected values."""
        self._judge = judge

    def __bool__(self) -> bool:
        return self._judge()[0]

    def __call__(self) -> bool:
        """Whether the condition is true now."""
        return self._judge()[0]

    def __repr__(self) -> str:
        return self._judge()[1]

    def __and__(self, other: Check) -> Check:
        return Check(lambda: (bool(self) and bool(other), f"{self!r}; and {other!r}"))

    def __or__(self, other: Check) -> Check:
        return Check(lambda: (bool(self) or bool(other), f"{self!r}; or {other!r}"))

    def __invert__(self) -> Check:
        return Check(lambda: (not self, f"not so: {self!r}"))


def reached(
    thymio: Thymio,
    pose: Sequence[float] | Pose,
    tolerance: float = 0.05,
    *,
    yaw_tolerance: float = math.radians(15),
) -> Check:
    """The robot is now within `tolerance` (m) of (x, y); with (x, y, yaw) also within `yaw_tolerance` (rad) of yaw."""
    x, y, *yaw = (pose.x_m, pose.y_m, pose.yaw_rad) if isinstance(pose, Pose) else pose

    def judge() -> tuple[bool, str]:
        here = thymio.pose
        distance = math.hypot(here.x_m - x, here.y_m - y)
        text = f"{thymio.name} is at ({here.x_m:.3f}, {here.y_m:.3f}), {distance:.3f} m from ({x:g}, {y:g})"
        holds, wanted = distance <= tolerance, f"expected at most {tolerance:g} m"
        if yaw:
            turn = abs(wrap_angle(here.yaw_rad - yaw[0]))
            text += f", and turned {math.degrees(turn):.0f}° away from {math.degrees(yaw[0]):.0f}°"
            holds, wanted = holds and turn <= yaw_tolerance, f"{wanted} and {math.degrees(yaw_tolerance):.0f}°"
        return holds, f"{text}: {wanted}"

    return Check(judge)


def no_contact(thymio: Thymio, *, since: float = 0.0) -> Check:
    """The robot has had no contact since a simulated time in s."""

    def judge() -> tuple[bool, str]:
        touches = [touch for touch in thymio.touches if touch.at_s >= since]
        if not touches:
            return True, f"{thymio.name} touched nothing"
        text = ", ".join(f"{touch.other} at {touch.at_s:.2f} s" for touch in touches[:3])
        more = f" and {len(touches) - 3} times more" if len(touches) > 3 else ""
        return False, f"{thymio.name} touched {text}{more}: expected no contact"

    return Check(judge)


def emitted(
    thymio: Thymio, event: str, args: Sequence[int] | None = None, *, times: int | None = None, since: float = 0.0
) -> Check:
    """The program emitted an event, with these arguments if given; exactly `times` times, or at least once."""

    def judge() -> tuple[bool, str]:
        events = [seen for seen in thymio.events if seen.at_s >= since]
        count = sum(seen.name == event and (args is None or seen.args == tuple(args)) for seen in events)
        wanted = "at least once" if times is None else f"{times} times"
        what = event if args is None else f"{event} {list(args)}"
        last = ", ".join(f"{seen.name} {list(seen.args)} at {seen.at_s:.2f} s" for seen in events[-3:])
        text = f"{thymio.name} emitted {what} {count} times; last of {len(events)} events: {last or 'none'}"
        return (count > 0 if times is None else count == times), f"{text}: expected {wanted}"

    return Check(judge)


def shows(thymio: Thymio, group: str, levels: str | Sequence[int], *, tolerance: int = 4) -> Check:
    """The lights of a group ("top", "circle", …) have these levels now, 0…32 each, or a color name for the body.

    Raises ValueError for an unknown color or group, or a wrong number of levels.
    """
    if isinstance(levels, str) and levels not in LED_COLORS:
        raise ValueError(f"no color '{levels}': expected one of {', '.join(LED_COLORS)}")
    wanted = LED_COLORS[levels] if isinstance(levels, str) else tuple(levels)
    if group not in LED_GROUPS:
        raise ValueError(f"no lights '{group}': expected one of {', '.join(LED_GROUPS)}")
    if len(wanted) != LED_GROUPS[group]:
        raise ValueError(f"{group}: {len(wanted)} levels found, expected {LED_GROUPS[group]}")

    def judge() -> tuple[bool, str]:
        seen = thymio.leds[group]
        holds = all(abs(a - b) <= tolerance for a, b in zip(seen, wanted, strict=True))
        return holds, f"{thymio.name} shows {seen} on {group}: expected {wanted} within {tolerance}"

    return Check(judge)


def slower_than(thymio: Thymio, speed_m_s: float, *, since: float = 0.0) -> Check:
    """The robot has never exceeded this speed, forward or backward, since a simulated time in s."""

    def judge() -> tuple[bool, str]:
        fastest = max(thymio.record.since(since), key=lambda moment: abs(moment.speed_m_s), default=None)
        if fastest is None:
            return True, f"{thymio.name} has not been seen"
        text = f"{thymio.name} drove {fastest.speed_m_s:.3f} m/s at {fastest.at_s:.2f} s"
        return abs(fastest.speed_m_s) <= speed_m_s, f"{text}: expected at most {speed_m_s:g} m/s"

    return Check(judge)
