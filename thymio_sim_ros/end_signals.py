"""The signals by which users and systems ask a program to end."""

from __future__ import annotations

import signal

__all__ = ["END_SIGNALS"]

END_SIGNALS = tuple(
    signal.Signals[name] for name in ("SIGINT", "SIGTERM", "SIGBREAK") if name in signal.Signals.__members__
)
"""Ctrl-C; the end of a service; on Windows also Ctrl-Break, a console that is closed, and the user's log-off."""
