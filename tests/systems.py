"""What tests need of the system, where not every system has it."""

from __future__ import annotations

import sys

import pytest

__all__ = ["links", "posix"]

posix = pytest.mark.skipif(sys.platform == "win32", reason="uses a shell, signals, limits, pipes or sockets of POSIX")
links = pytest.mark.skipif(sys.platform == "win32", reason="users may not make links on Windows")
