"""A pupil's drawing is a line like any other: one robot draws a track with the pen, another one follows it."""

from __future__ import annotations

import math

from tests.sim.builders import make
from tests.tracks import distance_to
from thymio_sim_ros.device.programs.program import load_program
from thymio_sim_ros.engine.engine import Engine
from thymio_sim_ros.files.loading import read_program
from thymio_sim_ros.sim.commands import MoveRobot, SetPen

SHEET = {"kind": "rectangle", "name": "sheet", "size_x_m": 2.0, "size_y_m": 1.4, "color": "#ffffff"}
STARTS = [
    {"name": "artist", "x_m": 0.0, "y_m": -0.35, "yaw_rad": 0.0},
    {"name": "reader", "x_m": -0.8, "y_m": 0.55, "yaw_rad": 0.0},
]
DRAWING = """
# a race track: straight for 4 s, then a half circle, again and again
var turning = 0
timer.period[0] = 4000
motor.left.target = 200
motor.right.target = 200
onevent timer0
turning = 1 - turning
if turning == 1 then
  timer.period[0] = 6178
  motor.left.target = 128
  motor.right.target = 272
else
  timer.period[0] = 4000
  motor.left.target = 200
  motor.right.target = 200
end
"""
SECONDS_OF_DRAWING = 2 * (4.0 + 6.178)


def test_a_robot_follows_what_another_one_drew():
    engine = Engine(
        make([SHEET], STARTS),
        {"artist": load_program(DRAWING, "drawing"), "reader": load_program("", "waiting")},
        seed=4,
    )
    artist, reader = engine.world.robots["artist"], engine.world.robots["reader"]
    engine.post("artist", SetPen(down=True, color=(0.0, 0.0, 0.0), width_m=0.035))
    drawn = []
    for _ in range(round(SECONDS_OF_DRAWING / 0.1)):
        engine.run(0.1)
        drawn.append((artist.pose.x_m, artist.pose.y_m))
    assert math.dist(drawn[0], drawn[-1]) < 0.03

    engine.post("artist", SetPen(down=False))
    engine.post("artist", MoveRobot(-0.8, -0.55, 0.0))
    engine.run(0.02)
    engine.post("reader", MoveRobot(drawn[10][0], drawn[10][1], 0.0))
    engine.load("reader", read_program("line_follower"))

    seen, farthest = set(), 0.0
    while len(seen) < len(drawn):
        assert engine.now_ns < 90e9, f"{len(drawn) - len(seen)} of {len(drawn)} places not reached"
        engine.run(0.1)
        sensors = reader.pose.place((0.072, 0.0))
        farthest = max(farthest, distance_to(drawn, sensors))
        seen |= {number for number, point in enumerate(drawn) if math.dist(point, sensors) < 0.05}
    assert farthest < 0.04
