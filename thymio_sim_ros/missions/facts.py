"""Facts of a mission: what is true or false of a robot in a tick.

A fact is a frozen dataclass whose fields a mission file gives; `watch` binds it to an engine. The texts of facts are in
the mission, so that a checklist speaks of its own story.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Annotated, Protocol

from thymio_sim_ros.device.programs.program import ThymioProgram
from thymio_sim_ros.engine.engine import Engine
from thymio_sim_ros.missions.zones import Zone
from thymio_sim_ros.sim.actuators.comm import FULL_PAYLOAD, CommState
from thymio_sim_ros.sim.actuators.leds import LedState
from thymio_sim_ros.sim.actuators.loudspeaker import LoudspeakerState
from thymio_sim_ros.sim.commands import COLORED_GROUPS, LED_COLORS
from thymio_sim_ros.sim.model import fields
from thymio_sim_ros.sim.model.fields import FieldError, Name, Number, Pattern
from thymio_sim_ros.sim.model.geometry import wrap_angle
from thymio_sim_ros.sim.playground.track_line import EVERY, SENSOR_OFFSET_M, TrackLine, TrackProgress
from thymio_sim_ros.sim.robot.robot import Robot

__all__ = ["FACTS", "Fact", "Measured", "Scene", "Watch"]


@dataclass(frozen=True, slots=True)
class Measured:
    """How far a fact is: a value now, the value from which it is true, and their unit ("" is a plain number)."""

    value: float
    goal: float
    unit: str


@dataclass(frozen=True, slots=True)
class Watch:
    """A fact that is bound to an engine.

    `is_true` is called once in each tick. `measure` says how far it is, None while the robot is not there; facts
    that are no quantities have none.
    """

    is_true: Callable[[], bool]
    measure: Callable[[], Measured | None] | None = None


_STILL_M_S, _STILL_RAD_S = 0.001, 0.01
_TURN_RAD_S = 0.1
_LIGHT_TOLERANCE = 4
"""Levels by which a light may differ from a color."""

Label = Annotated[str, Pattern(r"[^\x00-\x1f\x7f\ud800-\udfff]*", "the name of a shape", 60)]
Word = Annotated[str, Pattern(r"[A-Za-z_][A-Za-z0-9_.]*", "the name of an event", 60)]
Group = Annotated[str, Pattern("|".join(COLORED_GROUPS), f"one of {', '.join(COLORED_GROUPS)}", 20)]
ColorName = Annotated[str, Pattern("|".join(LED_COLORS), f"one of {', '.join(LED_COLORS)}", 20)]
Meters = Annotated[float, Number("m", 0.0, 1000.0)]
Speed = Annotated[float, Number("m/s", 0.0, 1.0)]
Way = Annotated[str, Pattern("|forward|backward", "forward or backward", 20)]
Side = Annotated[str, Pattern("left|right", "left or right", 20)]
Degrees = Annotated[float, Number("degrees", -360.0, 360.0)]
Width = Annotated[float, Number("degrees", 0.0, 180.0)]
Loudness = Annotated[float, Number("of mic.intensity", 0.0, 255.0)]
Payload = Annotated[float, Number("of prox.comm.tx", 0.0, FULL_PAYLOAD)]
Short = Annotated[float, Number("of a variable", -32768.0, 32767.0)]
Index = Annotated[float, Number("place in an array", 0.0, 1000.0)]
Laps = Annotated[float, Number("laps", 0.0, 100.0)]


_Sampled = tuple[Callable[[Robot], TrackProgress], TrackProgress]


@dataclass(frozen=True, slots=True)
class Scene:
    """What facts are watched in: the engine, the zones of the mission, and the robot of a fact."""

    engine: Engine
    zones: Mapping[str, Zone]
    robot: str
    tracks: dict[tuple[str, str], _Sampled] = field(default_factory=dict)
    """What facts of a mission share: the progress of a robot along a track, which takes the longest to measure."""

    def present(self) -> Robot | None:
        """The robot, None while it is not in the world."""
        return self.engine.world.robots.get(self.robot)

    def when_present(self, check: Callable[[Robot], bool], measure: Callable[[Robot], Measured] | None = None) -> Watch:
        """A check of the robot that is false while it is not there, and its measure."""

        def is_true() -> bool:
            robot = self.present()
            return robot is not None and check(robot)

        if measure is None:
            return Watch(is_true)
        return Watch(is_true, lambda: None if (robot := self.present()) is None else measure(robot))

    def variable(self, name: str) -> Callable[[], tuple[int, ...]]:
        """A function that reads a variable of the robot's program; empty if there is none, or no program."""
        program: ThymioProgram | None = None
        is_there = False

        def read() -> tuple[int, ...]:
            nonlocal program, is_there
            host = self.engine.hosts.get(self.robot)
            if host is None:
                return ()
            if host.program is not program:
                program, is_there = host.program, name in host.device.variables.addresses()
            return host.device.variables.get(name) if is_there else ()

        return read


class Fact(Protocol):
    """A fact: a frozen dataclass. `watch` raises FieldError for a name that the playground does not have."""

    def watch(self, scene: Scene) -> Watch:
        """Bind it to an engine."""


@dataclass(frozen=True, slots=True)
class Inside:
    """The center of the robot is inside a zone."""

    zone: Name

    def watch(self, scene: Scene) -> Watch:
        """Bind it to an engine."""
        if self.zone not in scene.zones:
            raise FieldError("zone", f"'{self.zone}'", fields.nearest(self.zone, tuple(scene.zones)))
        zone = scene.zones[self.zone]
        return scene.when_present(lambda robot: zone.contains(robot.pose.x_m, robot.pose.y_m))


@dataclass(frozen=True, slots=True)
class Touches:
    """The robot touches something, or the thing of a name."""

    what: Label = ""

    def watch(self, scene: Scene) -> Watch:
        """Bind it to an engine."""
        playground = scene.engine.world.playground
        names = [*(shape.name for shape in playground.shapes), *(robot.name for robot in playground.robots)]
        if self.what and self.what not in names:
            raise FieldError("what", f"'{self.what}'", fields.nearest(self.what, names))

        def touches(robot: Robot) -> bool:
            touching = robot.body.touching
            return bool(touching) and (not self.what or any(each.other == self.what for each in touching.values()))

        return scene.when_present(touches)


@dataclass(frozen=True, slots=True)
class Lights:
    """The lights of the body have a color."""

    color: ColorName
    group: Group = "top"

    def watch(self, scene: Scene) -> Watch:
        """Bind it to an engine."""
        wanted = LED_COLORS[self.color]

        def shines(robot: Robot) -> bool:
            levels = robot.state(LedState).levels[self.group]
            return all(abs(one - other) <= _LIGHT_TOLERANCE for one, other in zip(levels, wanted, strict=True))

        return scene.when_present(shines)


@dataclass(frozen=True, slots=True)
class Sound:
    """The loudspeaker of the robot sounds."""

    def watch(self, scene: Scene) -> Watch:
        """Bind it to an engine."""
        return scene.when_present(lambda robot: not robot.state(LoudspeakerState).is_silent)


@dataclass(frozen=True, slots=True)
class Still:
    """The robot stands still."""

    def watch(self, scene: Scene) -> Watch:
        """Bind it to an engine."""
        return scene.when_present(
            lambda robot: abs(robot.twist.linear_m_s) < _STILL_M_S and abs(robot.twist.angular_rad_s) < _STILL_RAD_S
        )


@dataclass(frozen=True, slots=True)
class Faster:
    """The robot is faster than a speed: forward, backward, or either if there is no direction."""

    speed_m_s: Speed
    direction: Way = ""

    def watch(self, scene: Scene) -> Watch:
        """Bind it to an engine."""

        def speed(robot: Robot) -> float:
            forward = robot.twist.linear_m_s
            return {"": abs(forward), "forward": forward, "backward": -forward}[self.direction]

        return scene.when_present(
            lambda robot: speed(robot) > self.speed_m_s,
            lambda robot: Measured(speed(robot), self.speed_m_s, "m/s"),
        )


@dataclass(frozen=True, slots=True)
class Turns:
    """The robot turns to a side."""

    direction: Side

    def watch(self, scene: Scene) -> Watch:
        """Bind it to an engine."""
        sign = 1.0 if self.direction == "left" else -1.0
        return scene.when_present(lambda robot: sign * robot.twist.angular_rad_s > _TURN_RAD_S)


@dataclass(frozen=True, slots=True)
class Heading:
    """The robot looks in a direction: 0° is to the right of the playground, 90° up."""

    direction_deg: Degrees
    tolerance_deg: Width = 10.0

    def watch(self, scene: Scene) -> Watch:
        """Bind it to an engine."""
        wanted, tolerance = math.radians(self.direction_deg), math.radians(self.tolerance_deg)
        return scene.when_present(
            lambda robot: abs(wrap_angle(robot.pose.yaw_rad - wanted)) <= tolerance,
            lambda robot: Measured(math.degrees(wrap_angle(robot.pose.yaw_rad)), self.direction_deg, "°"),
        )


@dataclass(frozen=True, slots=True)
class Fallen:
    """The robot has fallen off an edge."""

    def watch(self, scene: Scene) -> Watch:
        """Bind it to an engine."""
        return scene.when_present(lambda robot: robot.is_fallen)


@dataclass(frozen=True, slots=True)
class Driven:
    """The robot has driven so far since the start, forward and backward."""

    distance_m: Meters

    def watch(self, scene: Scene) -> Watch:
        """Bind it to an engine."""
        covered, last = 0.0, scene.engine.now_ns

        def has_driven(robot: Robot) -> bool:
            nonlocal covered, last
            now = scene.engine.now_ns
            covered += abs(robot.twist.linear_m_s) * (now - last) / 1e9
            last = now
            return covered >= self.distance_m

        return scene.when_present(has_driven, lambda _: Measured(covered, self.distance_m, "m"))


@dataclass(frozen=True, slots=True)
class Lap:
    """The robot has driven along a track for so many laps, in either direction."""

    laps: Laps = 1.0
    track: Label = ""

    def watch(self, scene: Scene) -> Watch:
        """Bind it to an engine."""
        sampled, progress = _progress(scene, self.track)
        return scene.when_present(
            lambda robot: sampled(robot).laps >= self.laps, lambda _: Measured(progress.laps, self.laps, "")
        )


@dataclass(frozen=True, slots=True)
class OffLine:
    """No ground sensor of the robot was above a track once."""

    track: Label = ""

    def watch(self, scene: Scene) -> Watch:
        """Bind it to an engine."""
        sampled, _ = _progress(scene, self.track)
        limit_m = TrackLine.of(scene.engine.world.playground, self.track)[1].width_m / 2 + SENSOR_OFFSET_M
        return scene.when_present(lambda robot: sampled(robot).farthest_m > limit_m)


@dataclass(frozen=True, slots=True)
class Emits:
    """The program of the robot emits an event, in this tick."""

    event: Word

    def watch(self, scene: Scene) -> Watch:
        """Bind it to an engine."""
        sent = scene.robot, self.event
        return Watch(lambda: any((robot, event.name) == sent for robot, event in scene.engine.emitted))


@dataclass(frozen=True, slots=True)
class Sends:
    """The robot sends a message by infrared, or that of a value."""

    value: Payload | None = None

    def watch(self, scene: Scene) -> Watch:
        """Bind it to an engine."""

        def sends(robot: Robot) -> bool:
            state = robot.state(CommState)
            return state.is_sending and (self.value is None or state.payload == self.value)

        return scene.when_present(sends)


@dataclass(frozen=True, slots=True)
class Receives:
    """The last message that the program of the robot has received by infrared is that of a value."""

    value: Payload

    def watch(self, scene: Scene) -> Watch:
        """Bind it to an engine."""
        return _reading(scene, "prox.comm.rx", 0, self.value, self.value)


@dataclass(frozen=True, slots=True)
class Hears:
    """The microphone of the robot hears a sound, such as a clap, or another robot."""

    loudness: Loudness = 50.0

    def watch(self, scene: Scene) -> Watch:
        """Bind it to an engine."""
        return _reading(scene, "mic.intensity", 0, self.loudness, math.inf)


@dataclass(frozen=True, slots=True)
class Reads:
    """A variable of the robot's program is in a range: a sensor, or a variable of the pupil."""

    variable: Word
    index: Index = 0.0
    at_least: Short = -32768.0
    at_most: Short = 32767.0

    def watch(self, scene: Scene) -> Watch:
        """Bind it to an engine."""
        if self.at_least > self.at_most:
            raise FieldError("at_least", f"{self.at_least:g}", f"at most {self.at_most:g}, which is at_most")
        return _reading(scene, self.variable, round(self.index), self.at_least, self.at_most)


def _reading(scene: Scene, variable: str, index: int, low: float, high: float) -> Watch:
    """A watch of a variable that may not be there: programs differ."""
    read = scene.variable(variable)

    def is_true() -> bool:
        words = read()
        return index < len(words) and low <= words[index] <= high

    def measure() -> Measured | None:
        words = read()
        return (
            Measured(words[index], low if words[index] < low else min(high, 32767), "") if index < len(words) else None
        )

    return Watch(is_true, measure)


def _progress(scene: Scene, track: str) -> _Sampled:
    """A function that samples the progress of the robot along a track as tests sample it, and that progress."""
    key = scene.robot, track
    if key not in scene.tracks:
        scene.tracks[key] = _sampled(scene, track)
    return scene.tracks[key]


def _sampled(scene: Scene, track: str) -> _Sampled:
    try:
        line, _ = TrackLine.of(scene.engine.world.playground, track)
    except ValueError as error:
        raise FieldError("track", f"'{track}'", str(error)) from error
    progress, ticks, last_ns = TrackProgress(line), 0, -1

    def sampled(robot: Robot) -> TrackProgress:
        nonlocal ticks, last_ns
        now_ns = scene.engine.now_ns
        if now_ns != last_ns:  # several facts ask in a tick
            last_ns = now_ns
            if ticks % EVERY == 0:
                progress.add(now_ns / 1e9, robot.pose)
            ticks += 1
        return progress

    return sampled, progress


FACTS: Mapping[str, type[Fact]] = {
    "inside": Inside,
    "touches": Touches,
    "lights": Lights,
    "sound": Sound,
    "still": Still,
    "faster": Faster,
    "turns": Turns,
    "heading": Heading,
    "fallen": Fallen,
    "driven": Driven,
    "lap": Lap,
    "off_line": OffLine,
    "emits": Emits,
    "sends": Sends,
    "receives": Receives,
    "hears": Hears,
    "reads": Reads,
}
"""The kinds of facts by the word of a mission file."""
