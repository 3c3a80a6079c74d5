"""Lights and notes of a Create 3, shown and played by a Thymio."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from thymio_sim_ros.ros.profiles import Ended, ProfileRobot, ProfileWorld
from thymio_sim_ros.sim.commands import (
    COLORED_GROUPS,
    LED_FULL,
    Command,
    PlayTone,
    ReleaseLeds,
    SetLeds,
    ShowOnLeds,
    StopSound,
)

if TYPE_CHECKING:
    from thymio_sim_ros.ros.interface.robot_inputs import InputContext

__all__ = ["Animation", "Melody", "lights", "notes", "play_notes"]

_SECOND_NS = 1_000_000_000
_NOTES = "create3.notes"


def lights(message: Any, _context: InputContext, _robot: ProfileRobot) -> Sequence[Command]:
    """Front and back of the ring are the top of a Thymio, its left and right side the sides."""
    if not message.override_system:
        return _no_lights()
    return _colors(message.leds)


def _no_lights() -> list[Command]:
    """Return the colors to the firmware, which shows none."""
    return [
        *(ShowOnLeds(group, (0, 0, 0)) for group in COLORED_GROUPS),
        *(ReleaseLeds(group) for group in COLORED_GROUPS),
    ]


def _colors(leds: Sequence[Any]) -> list[SetLeds]:
    pairs = {"top": (2, 5), "bottom_left": (3, 4), "bottom_right": (0, 1)}
    return [
        SetLeds(
            group,
            tuple(
                round(sum(getattr(leds[at], shade) for at in pair) / 510 * LED_FULL)
                for shade in ("red", "green", "blue")
            ),
        )
        for group, pair in pairs.items()
    ]


def notes(message: Any, _context: InputContext, robot: ProfileRobot) -> Sequence[Command]:
    """Queue notes, which `play_notes` plays one after the other."""
    found = [(note.frequency, _nanoseconds(note.max_runtime)) for note in message.notes]
    now_ns = robot.world.now_ns
    waiting = robot.memory.get(_NOTES, [])
    if not message.append or not waiting:
        waiting = []
    at_ns = max([now_ns, *(end_ns for _, _, end_ns in waiting)])
    for frequency, length_ns in found:
        waiting.append((at_ns, frequency, at_ns + length_ns))
        at_ns += length_ns
    robot.memory[_NOTES] = waiting
    return () if found else (StopSound(),)


def _nanoseconds(duration: Any) -> int:
    return int(duration.sec * _SECOND_NS + duration.nanosec)


def play_notes(world: ProfileWorld) -> None:
    """Begin the notes that are due; called after each tick."""
    for robot in world.robots.values():
        waiting = robot.memory.get(_NOTES)
        while waiting and waiting[0][0] <= world.now_ns:
            _, frequency, end_ns = waiting.pop(0)
            if end_ns > world.now_ns:
                robot.post(PlayTone(float(frequency), end_ns - world.now_ns) if frequency else StopSound())


class Melody:
    """Plays a sequence of notes some times, or until it is canceled."""

    def __init__(self, goal: Any, robot: ProfileRobot) -> None:
        self._robot, self._notes, self._wanted = robot, goal.note_sequence, goal.iterations
        self._length_ns = sum(_nanoseconds(note.max_runtime) for note in self._notes.notes)
        if self._length_ns <= 0:
            raise ValueError("note_sequence has no notes with a max_runtime above 0")
        if self._wanted < -1:
            raise ValueError(f"iterations is {self._wanted}, expected -1 (without end) or more")
        self._start_ns, self._begun = robot.world.now_ns, 0

    @property
    def _passed_ns(self) -> int:
        return self._robot.world.now_ns - self._start_ns

    @property
    def _played(self) -> int:
        return min(self._passed_ns // self._length_ns, self._begun)

    def step(self) -> Ended | None:
        """See `Motion`."""
        if self._wanted != -1 and self._played >= self._wanted:
            return Ended()
        if self._passed_ns >= self._begun * self._length_ns:
            self._begun += 1
            notes(_Sequence(self._notes.notes), None, self._robot)  # type: ignore[arg-type]
        return None

    def feedback(self, kind: type[Any]) -> Any:
        """See `Motion`."""
        message = kind(iterations_played=self._played)
        runtime = message.current_runtime
        runtime.sec, runtime.nanosec = divmod(self._passed_ns, _SECOND_NS)
        return message

    def result(self, kind: type[Any]) -> Any:
        """See `Motion`."""
        message = kind(complete=self._wanted != -1 and self._played >= self._wanted, iterations_played=self._played)
        message.runtime.sec, message.runtime.nanosec = divmod(self._passed_ns, _SECOND_NS)
        return message

    def stop(self) -> None:
        """See `Motion`."""
        self._robot.memory.pop(_NOTES, None)
        self._robot.post(StopSound())


class _Sequence:
    """Notes that replace those that are playing."""

    append = False

    def __init__(self, notes: Sequence[Any]) -> None:
        self.notes = notes


class Animation:
    """Blinks or spins the colors of a ring of lights for a time."""

    _STEP_NS = 250_000_000

    def __init__(self, goal: Any, robot: ProfileRobot) -> None:
        self._robot, self._leds = robot, list(goal.lightring.leds)
        self._is_spinning = goal.animation_type == 2
        self._runtime_ns = _nanoseconds(goal.max_runtime)
        if goal.animation_type not in (1, 2):
            raise ValueError(f"animation_type is {goal.animation_type}, expected 1 (blink) or 2 (spin)")
        if self._runtime_ns <= 0:
            raise ValueError(f"max_runtime is {self._runtime_ns / _SECOND_NS:g} s, expected a time above 0")
        self._start_ns, self._shown = robot.world.now_ns, -1

    @property
    def _passed_ns(self) -> int:
        return self._robot.world.now_ns - self._start_ns

    def step(self) -> Ended | None:
        """See `Motion`."""
        if self._passed_ns >= self._runtime_ns:
            return Ended()
        number = self._passed_ns // self._STEP_NS
        if number != self._shown:
            self._shown = number
            turned = number % len(self._leds)
            for command in _colors(self._leds[turned:] + self._leds[:turned] if self._is_spinning else self._leds):
                is_dark = not self._is_spinning and number % 2 == 1
                self._robot.post(SetLeds(command.group, (0, 0, 0)) if is_dark else command)
        return None

    def feedback(self, kind: type[Any]) -> Any:
        """See `Motion`."""
        message = kind()
        left_ns = max(0, self._runtime_ns - self._passed_ns)
        message.remaining_runtime.sec, message.remaining_runtime.nanosec = divmod(left_ns, _SECOND_NS)
        return message

    def result(self, kind: type[Any]) -> Any:
        """See `Motion`."""
        message = kind()
        message.runtime.sec, message.runtime.nanosec = divmod(self._passed_ns, _SECOND_NS)
        return message

    def stop(self) -> None:
        """See `Motion`. The firmware shows the sensors again."""
        for command in _no_lights():
            self._robot.post(command)
