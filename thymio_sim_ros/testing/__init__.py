"""Building blocks of tests for grading: robots in a simulated world, records and checks (docs/grading.md).

The fixtures are in `thymio_sim_ros.pytest_plugin`; parts that need ROS are in `thymio_sim_ros.testing.ros`.
"""

from __future__ import annotations

from thymio_sim_ros.testing.checks import Check, emitted, no_contact, reached, shows, slower_than
from thymio_sim_ros.testing.classroom import Classroom
from thymio_sim_ros.testing.line_following import followed_line
from thymio_sim_ros.testing.mission import check_star, judged
from thymio_sim_ros.testing.record import Event, Moment, Touch
from thymio_sim_ros.testing.thymio import Thymio

__all__ = [
    "Check",
    "Classroom",
    "Event",
    "Moment",
    "Thymio",
    "Touch",
    "check_star",
    "emitted",
    "followed_line",
    "judged",
    "no_contact",
    "reached",
    "shows",
    "slower_than",
]
