"""Reports on faulty messages to a node: for its log, `/diagnostics`, the page and `thymio-sim doctor`."""

from __future__ import annotations

import time

from diagnostic_msgs.msg import DiagnosticStatus, KeyValue
from rclpy.node import Node

from thymio_sim_ros.ros.rclpy_ext.throttled_log import ThrottledLog

__all__ = ["RECENT_S", "MessageReports"]

RECENT_S = 10.0
"""Time for which a report about a message counts as the present state."""

_MAX_REPORTS = 100
"""Subjects that are remembered; limited, because their names may come from untrusted clients."""


class MessageReports:
    """Reports on faulty messages to a node: their numbers since the start, and the last report on each subject.

    A subject is a topic, or something that a message on it names, such as an event.
    """

    def __init__(self, node: Node) -> None:
        self._name = node.get_fully_qualified_name().removeprefix("/")
        self._warn = ThrottledLog(node)
        self.rejected = 0
        self.clamped = 0
        self._faults: dict[str, tuple[str, float]] = {}
        self._limits: dict[str, tuple[str, float]] = {}

    def add_rejected(self, about: str, reason: object) -> None:
        """Report and log a rejected message."""
        self.rejected += 1
        self.add_suspect(about, f"rejected: {reason}")
        self._warn(about, f"rejected: {reason}")

    def add_suspect(self, about: str, text: str) -> None:
        """Report a message that was executed, but is surely a mistake."""
        _remember(self._faults, about, text)

    def add_clamped(self, about: str, text: str) -> None:
        """Report a clamped message; that is no fault: programs use large numbers for full speed."""
        self.clamped += 1
        _remember(self._limits, about, f"clamped: {text}")

    @property
    def faults(self) -> tuple[str, ...]:
        """Faults of recent messages, a sentence for each subject."""
        return tuple(_recent(self._faults).values())

    def status(self) -> DiagnosticStatus:
        """Return the entry for `/diagnostics`: WARN while messages are rejected."""
        faults, limits = _recent(self._faults), _recent(self._limits)
        counts = (("rejected", self.rejected), ("clamped", self.clamped))
        return DiagnosticStatus(
            level=DiagnosticStatus.WARN if faults else DiagnosticStatus.OK,
            name=f"{self._name}: messages",
            hardware_id="thymio_sim_ros",
            message=next(iter(faults.values()), "no message was rejected lately"),
            values=[
                *(KeyValue(key=key, value=str(count)) for key, count in counts),
                *(KeyValue(key=about, value=text) for about, text in (*faults.items(), *limits.items())),
            ],
        )


def _remember(reports: dict[str, tuple[str, float]], about: str, text: str) -> None:
    if about not in reports and len(reports) >= _MAX_REPORTS:
        del reports[min(reports, key=lambda subject: reports[subject][1])]
    reports[about] = f"{about} {text}", time.monotonic()


def _recent(reports: dict[str, tuple[str, float]]) -> dict[str, str]:
    since_s = time.monotonic() - RECENT_S
    return {about: text for about, (text, when_s) in reports.items() if when_s >= since_s}
