"""Waits of an installed rclpy that cannot end in code under test, as functions that refuse to begin them."""

from __future__ import annotations

import functools
import inspect
import threading
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

import rclpy
from rclpy.client import Client
from rclpy.clock import Clock
from rclpy.impl.implementation_singleton import rclpy_implementation
from rclpy.timer import Rate

from thymio_sim_ros.testing.record import SECOND_NS
from thymio_sim_ros.testing.ros.student_errors import never_ends

__all__ = ["checks"]

_SPINS = ("spin", "spin_once", "spin_until_future_complete")
_rclpy: Any = rclpy_implementation
_signature = functools.lru_cache(maxsize=16)(inspect.signature)


def checks(here: int, limit_s: float) -> list[tuple[Any, str, Any]]:
    """Functions that raise StudentError where a thread begins a wait without end, or longer than a limit.

    Each with the object and the name of the attribute that it replaces.
    """

    def checked(name: str, wait: Callable[..., Any], is_endless: Callable[[Mapping[str, Any]], bool]) -> Any:
        signature = _signature(wait)

        def call(*args: Any, **kwargs: Any) -> Any:
            if threading.get_ident() == here:
                bound = signature.bind(*args, **kwargs)
                bound.apply_defaults()
                if is_endless(bound.arguments):
                    raise never_ends(name)
            return wait(*args, **kwargs)

        return call

    def wait(wait_set: Any, timeout_nsec: int) -> None:
        if threading.get_ident() == here and not 0 <= timeout_nsec <= limit_s * SECOND_NS:
            raise never_ends("a wait for messages")
        real_wait(wait_set, timeout_nsec)

    real_wait = _rclpy.WaitSet.wait
    return [
        *((rclpy, name, checked(f"rclpy.{name}()", getattr(rclpy, name), _has_no_limit)) for name in _SPINS),
        (Rate, "sleep", checked("Rate.sleep()", Rate.sleep, lambda _arguments: True)),
        (Client, "call", checked("Client.call()", Client.call, _has_no_limit)),
        (Clock, "sleep_until", checked("Clock.sleep_until()", Clock.sleep_until, partial(_sleeps_long, limit_s))),
        (_rclpy.WaitSet, "wait", wait),
    ]


def _has_no_limit(arguments: Mapping[str, Any]) -> bool:
    return arguments.get("timeout_sec") is None


def _sleeps_long(limit_s: float, arguments: Mapping[str, Any]) -> bool:
    """Whether `Clock.sleep_until` waits for simulated time, or longer than a limit."""
    clock, until = arguments["self"], arguments["until"]
    if until.clock_type != clock.clock_type:
        return False  # rclpy reports it
    rest_ns = until.nanoseconds - clock.now().nanoseconds
    limit_s = 0.0 if getattr(clock, "ros_time_is_active", False) else limit_s
    return bool(rest_ns > limit_s * SECOND_NS)
