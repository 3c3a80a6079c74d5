"""Enki behind the same interface as our world: a driver compiled with Debian's `libenki-dev`."""

from __future__ import annotations

import atexit
import shutil
import subprocess
import tempfile
from functools import cache
from pathlib import Path

from benchmarks.lib.scenes import side_m
from thymio_sim_ros.sim.ground.sampling import Ground
from thymio_sim_ros.sim.model.primitives import Box
from thymio_sim_ros.sim.playground.reader import Playground

_SOURCE = Path(__file__).with_suffix(".cpp")
_HEADER = Path("/usr/include/enki/PhysicalEngine.h")
_TEXELS = 512


@cache
def driver() -> Path | None:
    """Return the compiled driver; None where headers, library or compiler are missing."""
    compiler = shutil.which("g++")
    if compiler is None or not _HEADER.is_file():
        return None
    folder = tempfile.mkdtemp()
    atexit.register(shutil.rmtree, folder)
    program = Path(folder) / "enki"
    command = [compiler, "-O2", "-w", "-o", str(program), str(_SOURCE), "-lenki"]
    return program if subprocess.run(command, check=False).returncode == 0 else None


class Enki:
    """A playground in Enki. Steps are of 30 ms: three of physics, then all sensors."""

    def __init__(self, program: Path, scene: Playground) -> None:
        self._process = subprocess.Popen([program], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, bufsize=1)
        self._send(_describe(scene))

    def run(self, steps: int) -> float:
        """Set new targets and run so many steps; return the seconds of processor time."""
        self._send(f"{steps}\n")
        assert self._process.stdout is not None
        return float(self._process.stdout.readline())

    def close(self) -> None:
        """End the process."""
        self._process.communicate()

    def _send(self, text: str) -> None:
        assert self._process.stdin is not None
        self._process.stdin.write(text)
        self._process.stdin.flush()


def _describe(scene: Playground) -> str:
    """Return the driver's input: side and ground, then objects and robots, in cm."""
    side = side_m(len(scene.robots))
    ground = Ground(scene.floors, scene.paints)
    step = side / _TEXELS
    lines = [f"{side * 100} {_TEXELS}"]
    for row in range(_TEXELS):
        colors = (ground.color_at((column + 0.5) * step, (row + 0.5) * step) for column in range(_TEXELS))
        lines.append(" ".join(str(round(255 * sum(color or (0, 0, 0)) / 3)) for color in colors))
    for solid in scene.solids:
        if isinstance(solid.outline, Box) and 0.0 < solid.pose.x_m < side and 0.0 < solid.pose.y_m < side:
            place = f"{solid.pose.x_m * 100} {solid.pose.y_m * 100} {solid.pose.yaw_rad}"
            size = f"{solid.outline.size_x_m * 100} {solid.outline.size_y_m * 100} {solid.height_m * 100}"
            mass = -1 if solid.load is None else solid.load.mass_kg * 1000
            lines.append(f"box {place} {size} {mass}")
    lines += [f"robot {robot.x_m * 100} {robot.y_m * 100} {robot.yaw_rad}" for robot in scene.robots]
    return "\n".join([*lines, "end"]) + "\n"
