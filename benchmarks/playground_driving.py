"""How programs drive a robot in Aseba's own playground and in this simulator: edge crossings and near readings.

The same program is loaded over the network into a live playground, and into this simulator with several models. Two
variants reproduce what was found in the reference: "grid" samples the sensors in steps of 30 ms; "memory" keeps the
last distance of a proximity ray that no longer hits anything while another ray of its sensor hits (docs/robot.md).
"near" and "seen" are shares of the readings above 3000 and above 0. The playground runs in real time. Needs
`asebaplayground` (Debian package `aseba`) and `xvfb-run`.
"""

from __future__ import annotations

import argparse
import contextlib
import dataclasses
import math
import os
import shutil
import signal
import socket
import subprocess
import tempfile
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any
from unittest import mock

from PIL import Image, ImageDraw

from aseba_vm.protocol import FrameReader, Run, UserMessage, decode, encode, requests
from benchmarks.lib.command import MissingError
from benchmarks.lib.report import Report, Table
from tests.processes import free_port
from thymio_sim_ros.device.layout import PLAYGROUND
from thymio_sim_ros.device.programs.program import ThymioProgram, load_program
from thymio_sim_ros.engine.engine import Engine
from thymio_sim_ros.files import loading
from thymio_sim_ros.sim import world as world_module
from thymio_sim_ros.sim.model.readings import ProximityReading
from thymio_sim_ros.sim.model.robot_constants import PROXIMITY_HALF_CONE_RAD as HALF_CONE_RAD
from thymio_sim_ros.sim.model.robot_constants import PROXIMITY_MODELS
from thymio_sim_ros.sim.playground.reader import Playground
from thymio_sim_ros.sim.sensors import Sensor, all_sensors, proximity

QUICK = {"seconds": 4.0, "programs": ["in proportion"]}
STEP_NS = 30_000_000
NODE = 1
"""Number of the robot of the playground."""
START_S = 30.0
SKIPPED = 5
"""Reports at the start that do not count."""

PROGRAM = """<!DOCTYPE aesl-source>
<network>
<event size="5" name="report"/>
<node nodeId="1" name="thymio-II">
var samples = 0
var crossings = 0
var left = 0
var before = 0
var near = 0
var seen = 0
var most
onevent prox
samples++
if prox.ground.delta[0] &lt; 500 then left = 1 else left = 0 end
if left != before then crossings++ end
before = left
call math.max(most, prox.horizontal[0], prox.horizontal[1])
call math.max(most, most, prox.horizontal[2])
call math.max(most, most, prox.horizontal[3])
call math.max(most, most, prox.horizontal[4])
if most &gt; 3000 then near++ end
if most &gt; 0 then seen++ end
{steering}
if samples % 10 == 0 then emit report [samples, crossings, near, seen, most] end
</node>
</network>
"""

TRACK = {
    "one sensor, 300/100": """
if left == 1 then motor.left.target = 300 motor.right.target = 100
else motor.left.target = 100 motor.right.target = 300 end""",
    "one sensor, 400/0": """
if left == 1 then motor.left.target = 400 motor.right.target = 0
else motor.left.target = 0 motor.right.target = 400 end""",
    "in proportion": """
motor.left.target = 200 - (prox.ground.delta[0] - 500) / 3
motor.right.target = 200 + (prox.ground.delta[0] - 500) / 3""",
}
WALLS = {
    "follows a wall": """
if prox.horizontal[2] &gt; 1500 or prox.horizontal[3] &gt; 2500 then motor.left.target = -200 motor.right.target = 200
elseif prox.horizontal[4] &gt; 2000 then motor.left.target = 150 motor.right.target = 300
else motor.left.target = 300 motor.right.target = 150 end""",
    "all front sensors": """
motor.left.target = 300 - (prox.horizontal[2] / 5 + prox.horizontal[3] / 8 + prox.horizontal[4] / 10)
motor.right.target = 300 - (prox.horizontal[2] / 6 + prox.horizontal[1] / 8 + prox.horizontal[0] / 10)""",
}

TRACK_WORLD = """<aseba-playground>
<world w="100" h="80" groundTexture="track.png"/>
<robot type="thymio2" x="87" y="40" angle="1.57" port="{port}" name="thymio"/>
</aseba-playground>
"""
WALLS_WORLD = """<aseba-playground>
<color name="white" r="0.9" g="0.9" b="0.9"/>
<world w="140" h="120" color="white"/>
<wall x="70" y="20" l1="104" l2="2" h="10" color="white"/>
<wall x="70" y="100" l1="104" l2="2" h="10" color="white"/>
<wall x="19" y="60" l1="2" l2="82" h="10" color="white"/>
<wall x="121" y="60" l1="2" l2="82" h="10" color="white"/>
<robot type="thymio2" x="100" y="60" angle="1.57" port="{port}" name="thymio"/>
</aseba-playground>
"""

VARIANTS: dict[str, tuple[dict[str, Any], bool, bool]] = {
    "ideal": ({}, False, False),
    "ideal, grid": ({}, True, False),
    "ideal, grid, memory": ({}, True, True),
    "firmware": ({"motor_model": "firmware"}, False, False),
    "ideal, cone": ({"proximity_model": "cone"}, False, False),
}
"""Options of the runner, then whether the sensors sample in steps of 30 ms, and whether rays keep old distances."""


def draw_track(path: Path) -> None:
    """A closed black line of 4 cm on white, 100 x 80 cm."""
    scale = 2
    picture = Image.new("RGB", (1000 * scale, 800 * scale), "white")
    angles = [math.radians(half / 2) for half in range(721)]
    points = [
        (
            (500 + 330 * math.cos(angle) + 40 * math.cos(3 * angle)) * scale,
            (400 + 250 * math.sin(angle) + 30 * math.sin(2 * angle)) * scale,
        )
        for angle in angles
    ]
    ImageDraw.Draw(picture).line(points, fill="black", width=40 * scale, joint="curve")
    picture.resize((1000, 800)).save(path)


def figures(reports: Sequence[Sequence[int]]) -> list[float]:
    """Return the crossings per minute, and the percentages of readings above 3000 and above 0."""
    first, last = reports[min(SKIPPED, len(reports) - 2)], reports[-1]
    samples, crossings, near, seen = (after - before for before, after in zip(first[:4], last[:4], strict=True))
    return [crossings * 600 / samples, near * 100 / samples, seen * 100 / samples]


@contextlib.contextmanager
def reference(world: Path, port: int) -> Iterator[socket.socket]:
    """A connection to the robot of a live playground with this world."""
    with subprocess.Popen(
        ["xvfb-run", "-a", "asebaplayground", str(world)],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    ) as process:
        try:
            yield connected(port, time.monotonic() + START_S)
        finally:
            os.killpg(process.pid, signal.SIGTERM)


def connected(port: int, deadline: float) -> socket.socket:
    """A connection to the playground, which needs some seconds; OSError if it does not start."""
    while True:
        try:
            return socket.create_connection(("127.0.0.1", port))
        except OSError:
            if time.monotonic() > deadline:
                raise
            time.sleep(0.2)


def drive_reference(connection: socket.socket, program: ThymioProgram, seconds: float) -> list[Sequence[int]]:
    """Return what the program reports from the playground in so many seconds, or later if that is less than needed."""
    load = [*requests.set_bytecode(NODE, program.program.words), Run(0, NODE)]
    connection.sendall(b"".join(map(encode, load)))
    reader, start_s = FrameReader(), time.monotonic()
    reports: list[Sequence[int]] = []
    connection.settimeout(1.0)
    while (now_s := time.monotonic() - start_s) < seconds or (len(reports) < SKIPPED + 2 and now_s < seconds + START_S):
        with contextlib.suppress(TimeoutError):
            messages = map(decode, reader.feed(connection.recv(65536)))
            reports += [message.words for message in messages if isinstance(message, UserMessage)]
    if len(reports) < 2:
        raise TimeoutError(f"asebaplayground: {len(reports)} reports in {now_s:.0f} s, expected 2 or more")
    return reports


class Grid:
    """In place of `Schedule`: every sensor that is due measures at the end of the next step of 30 ms."""

    def __init__(self, periods_and_phases_ns: Sequence[tuple[int, int]]) -> None:
        self._periods_ns = [period_ns for period_ns, _ in periods_and_phases_ns]

    def due(self, now_ns: int) -> list[int]:
        """Numbers of the sensors that measure in the tick that ends now."""
        if now_ns % STEP_NS:
            return []
        periods = enumerate(self._periods_ns)
        return [number for number, period_ns in periods if now_ns // period_ns > (now_ns - STEP_NS) // period_ns]


MODEL = PROXIMITY_MODELS.index("enki")


def remembering() -> Sensor:
    """The proximity sensor of model "enki", for one robot, whose rays keep old distances."""
    kept = [[math.inf] * 3 for _ in proximity.PROXIMITY_POSES]
    range_m, height_m = proximity.PROXIMITY_RANGE_M, proximity.PROXIMITY_HEIGHT_M

    def measure(view: Any) -> ProximityReading:
        x, y, yaw = view.pose.x_m, view.pose.y_m, view.pose.yaw_rad
        around = view.surroundings(0.3, height_m)
        counts = []
        for number, (mount_x, mount_y, angle) in enumerate(proximity.PROXIMITY_POSES):
            at_x = x + math.cos(yaw) * mount_x - math.sin(yaw) * mount_y
            at_y = y + math.sin(yaw) * mount_x + math.cos(yaw) * mount_y
            angles = [yaw + angle + side for side in (-HALF_CONE_RAD, 0.0, HALF_CONE_RAD)]
            directions = [(math.cos(ray), math.sin(ray)) for ray in angles]
            distances = around.near(at_x, at_y, range_m).fan(at_x, at_y, directions, range_m)
            if min(distances) == math.inf:
                counts.append(0)
                continue
            kept[number] = [new if new < math.inf else old for new, old in zip(distances, kept[number], strict=True)]
            value = proximity.response(kept[number], 0, 3, (), MODEL) + view.noise.gauss(proximity.PROXIMITY_NOISE)
            counts.append(round(max(0.0, min(4505.0, value))))
        return ProximityReading(view.now_ns, tuple(counts), (math.inf,) * len(counts))

    return dataclasses.replace(proximity.SENSOR, measure=measure, prepare_all=None)


def drive_here(world: Playground, program: ThymioProgram, seconds: float, variant: str) -> list[Sequence[int]]:
    """Return what the program reports from this simulator."""
    options, on_grid, with_memory = VARIANTS[variant]
    sensors = tuple(remembering() if with_memory and sensor.name == "proximity" else sensor for sensor in all_sensors())
    with contextlib.ExitStack() as stack:
        stack.enter_context(mock.patch.object(world_module, "all_sensors", return_value=sensors))
        if on_grid:
            stack.enter_context(mock.patch.object(world_module, "Schedule", Grid))
        engine = Engine(world, program, **{"proximity_model": "enki", **options})
        return [event.args for _ in engine.steps(seconds) for _, event in engine.emitted]


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add options."""
    every = [*TRACK, *WALLS]
    parser.add_argument("--programs", nargs="+", choices=every, default=every, metavar="PROGRAM", help=f"of {every}")
    parser.add_argument("--seconds", type=float, default=95.0, help="of simulated time for each")


def measure(options: argparse.Namespace) -> Report:
    """Drive with all programs."""
    for needed in ("asebaplayground", "xvfb-run"):
        if shutil.which(needed) is None:
            raise MissingError("program", needed)
    rows: list[list[str | float]] = []
    with tempfile.TemporaryDirectory() as folder:
        draw_track(Path(folder) / "track.png")
        for name, steering in {**TRACK, **WALLS}.items():
            if name not in options.programs:
                continue
            port = free_port()
            path = Path(folder) / "driving.playground"
            path.write_text((TRACK_WORLD if name in TRACK else WALLS_WORLD).format(port=port))
            text = PROGRAM.format(steering=steering)
            with reference(path, port) as connection, connection:
                reports = drive_reference(connection, load_program(text, name, PLAYGROUND), options.seconds)
            rows.append([f"{name}: reference", *figures(reports)])
            _, world = loading.load_playground(str(path))
            for variant in VARIANTS:
                reports = drive_here(world, load_program(text, name), options.seconds, variant)
                rows.append([f"{name}: {variant}", *figures(reports)])
    return Report([Table(["", "crossings per minute", "near, %", "seen, %"], rows)])
