"""Reports on messages: what a stranger sends is counted, and takes a limited amount of memory."""

from __future__ import annotations

import pytest

from thymio_sim_ros.ros.rclpy_ext import message_reports
from thymio_sim_ros.ros.rclpy_ext.message_reports import MessageReports


@pytest.fixture
def reports(ros):
    return MessageReports(ros.node)


def test_the_last_reason_of_each_subject_is_reported(reports):
    for about, reason in (("/one", "first"), ("/two", "second"), ("/one", "third")):
        reports.add_rejected(about, reason)
    reports.add_clamped("/one", "too large")
    assert reports.faults == ("/one rejected: third", "/two rejected: second")
    assert [(pair.key, pair.value) for pair in reports.status().values] == [
        ("rejected", "3"),
        ("clamped", "1"),
        ("/one", "/one rejected: third"),
        ("/two", "/two rejected: second"),
        ("/one", "/one clamped: too large"),
    ]


def test_the_oldest_of_many_subjects_is_forgotten(reports, monkeypatch):
    """Names of events come from clients: they do not fill the memory."""
    monkeypatch.setattr(message_reports, "_MAX_REPORTS", 2)
    for number in range(4):
        reports.add_rejected(f"event {number}", "unknown")
    assert reports.faults == ("event 2 rejected: unknown", "event 3 rejected: unknown")
    assert reports.rejected == 4
