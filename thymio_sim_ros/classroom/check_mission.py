"""Checks a mission before it is handed out, as `thymio-sim mission --check` does, in a process of its own."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

from thymio_sim_ros.classroom.errors import ClassError

__all__ = ["check_mission"]

_COMMAND = (sys.executable, "-P", "-m", "thymio_sim_ros", "mission", "--check", "--untrusted", "--json")
_MISTAKES = 1
"""Exit code of a mission with mistakes, which are in the output; others have a sentence on standard error."""
_LONGEST_S = 60.0
"""Time for all its programs, each of which runs until the time of the mission is over."""
_MOST_MISTAKES = 5


def check_mission(name: str, content: bytes) -> None:
    """Run the solutions and start programs of a mission, but no ROS nodes: its file can be of anyone.

    `name` is that of the file, without folders. Raises ClassError with the places of its mistakes, and OSError.
    """
    with tempfile.TemporaryDirectory(prefix="thymio-check-") as folder:
        ending = ".zip" if content.startswith(b"PK") else ".json"
        file = Path(folder, f"{Path(name).stem}{ending}")
        file.write_bytes(content)
        try:
            ended = subprocess.run(
                [*_COMMAND, f"./{file.name}"],
                cwd=folder,
                env={**os.environ, "PYTHONPATH": os.pathsep.join(filter(None, sys.path)), "PYTHONUTF8": "1"},
                stdin=subprocess.DEVNULL,
                capture_output=True,
                timeout=_LONGEST_S,
            )
        except subprocess.TimeoutExpired as error:
            raise ClassError(
                f"{name}: its programs took more than {_LONGEST_S:g} s, expected a smaller time_s"
            ) from error
    if ended.returncode == 0:
        return
    if ended.returncode == _MISTAKES:
        raise ClassError("; ".join(json.loads(ended.stdout)["mistakes"][:_MOST_MISTAKES]))
    lines = ended.stderr.decode("utf-8", "replace").strip().splitlines()
    raise ClassError(lines[-1].removeprefix("thymio-sim: ") if lines else f"{name}: it could not be checked")
