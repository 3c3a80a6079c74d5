"""Warnings that clients can cause are not repeated at their pace."""

from __future__ import annotations

from thymio_sim_ros.bridge.report_limiter import PERIOD_S, ReportLimiter


def test_a_warning_is_repeated_after_a_minute_only() -> None:
    texts: list[str] = []
    now_s = 0.0
    report = ReportLimiter(texts.append, now_s=lambda: now_s)
    for number in range(100):
        report("full", f"connection {number}")
    report("other", "another subject")
    now_s = PERIOD_S
    report("full", "again")
    assert texts == ["connection 0", "another subject", "again"]


def test_subjects_without_end_do_not_fill_the_memory() -> None:
    texts: list[str] = []
    report = ReportLimiter(texts.append, now_s=lambda: 0.0)
    for number in range(3000):
        report(f"client {number}", str(number))
    assert len(texts) == 3000
    assert len(report._reported_s) <= 1000
