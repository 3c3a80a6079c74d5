"""The variables of a confined process."""

from __future__ import annotations

import os
import sys
from pathlib import Path

from thymio_sim_ros.grading.sandbox.readable import python_path

__all__ = ["confined_environment"]

_KEPT = ("LD_LIBRARY_PATH", "AMENT_PREFIX_PATH", "ROS_DISTRO", "RMW_IMPLEMENTATION", "SYSTEMROOT")
"""Variables that a confined process gets from the one that starts it; all others may be secrets."""


def confined_environment(folder: Path) -> dict[str, str]:
    """The variables of a process of Python in a place (`place.FOLDERS`)."""
    return {
        "PATH": os.defpath if sys.platform == "win32" else "/usr/local/bin:/usr/bin:/bin",
        **dict.fromkeys(("HOME", "USERPROFILE", "TMPDIR", "TEMP", "TMP"), str(folder / "tmp")),
        "LANG": "C.UTF-8",
        "PYTHONUTF8": "1",
        "PYTHONPATH": python_path(),
        "PYTHONDONTWRITEBYTECODE": "1",
        "OPENBLAS_NUM_THREADS": "1",
        **{name: os.environ[name] for name in _KEPT if name in os.environ},
    }
