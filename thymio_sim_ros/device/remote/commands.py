"""Commands for the actuators of a remote robot: written variables, and native functions called by appended handlers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from thymio_sim_ros.device.remote.ros_handlers import RemoteProgram
from thymio_sim_ros.device.remote.session import Session
from thymio_sim_ros.sim.actuators.motors import wheel_speeds
from thymio_sim_ros.sim.commands import (
    BodyTwist,
    Command,
    EnableComm,
    MotorTargets,
    PlaySystemSound,
    PlayTone,
    SetCommPayload,
    SetLed,
    SetLeds,
    SetSoundThreshold,
    StopSound,
    WheelVelocities,
)
from thymio_sim_ros.sim.model import units

__all__ = ["LED_NATIVES", "MOTORS", "RemoteCommands"]

MOTORS = ("motor.left.target", "motor.right.target")

LED_NATIVES = {
    "top": "leds.top",
    "bottom_left": "leds.bottom.left",
    "bottom_right": "leds.bottom.right",
    "circle": "leds.circle",
    "buttons": "leds.buttons",
    "proximity": "leds.prox.h",
    "ground": "leds.prox.v",
    "remote": "leds.rc",
    "microphone": "leds.sound",
    "temperature": "leds.temperature",
}
"""Native function of each group of lights; battery and card have none (docs/spec/thymio-robot.md section 6.3)."""

_TICKS_PER_S = 60
"""Unit of the duration of `sound.freq` (docs/spec/thymio-robot.md section 6.3)."""
_NEWER = 2
"""Consecutive readings with other targets that show that the program has set new ones: one may be the answer to an
earlier request of another client."""


@dataclass(slots=True)
class _Override:
    """Wheel targets that ROS has set beside a program for a time: those before, those now, and when they end."""

    program: RemoteProgram
    before: tuple[int, int]
    targets: tuple[int, int]
    ends_ns: int | None
    others: int = 0
    """Number of consecutive readings with other targets."""


class RemoteCommands:
    """Executes commands on a robot. A velocity holds until its time-out; then the program's last targets hold again."""

    def __init__(self, session: Session) -> None:
        self._session = session
        self._override: _Override | None = None

    def execute(self, command: Command, now_ns: int) -> None:
        """Execute a command. Raises ValueError if the robot cannot do that, or cannot do it now."""
        if self._session.node is None:
            raise ValueError(f"the robot is not connected ({self._session.problem})")
        match command:
            case MotorTargets() | BodyTwist() | WheelVelocities() if missing := self._missing_motors:
                raise ValueError(f"the robot cannot drive: it has no variable {' and no '.join(missing)} of one word")
            case MotorTargets(left, right):
                self._override = None
                self._drive((left, right))
            case BodyTwist() | WheelVelocities():
                self._drive_for(command, now_ns)
            case SetLeds(group, levels) if group in LED_NATIVES:
                self._call(LED_NATIVES[group], levels)
            case SetLeds(levels=levels) if not any(levels):
                pass  # the lights of battery and card are the robot's own
            case SetLed(number, level):
                self._call("_leds.set", (number, level))
            case PlayTone(frequency_hz, duration_ns):
                ticks = 0 if duration_ns is None else max(1, round(duration_ns * _TICKS_PER_S / 1e9))
                self._call("sound.freq", (round(frequency_hz), min(ticks, 0x7FFF)))
            case StopSound():
                self._call("sound.freq", (0, -1))
            case PlaySystemSound(number):
                self._call("sound.system", (number,))
            case EnableComm(is_enabled):
                self._call("prox.comm.enable", (int(is_enabled),))
            case SetCommPayload(value):
                self._write("prox.comm.tx", (value,))
            case SetSoundThreshold(level):
                self._write("mic.threshold", (level,))
            case _:
                raise ValueError(f"{type(command).__name__}: a real robot cannot do this")

    def advance(self, now_ns: int) -> None:
        """End a velocity whose time is over."""
        override = self._running_override
        if override is not None and override.ends_ns is not None and now_ns >= override.ends_ns:
            self._override = None
            self._drive(override.before)

    def on_read(self, start: int, values: Sequence[int]) -> None:
        """Compare the targets if these words include them: those of the program end a velocity at once."""
        override, targets, node = self._running_override, self._targets, self._session.node
        if override is None or targets is None or node is None or self._missing_motors:
            return
        address, _ = node.addresses[MOTORS[0]]
        if start == address and len(values) == len(MOTORS):  # requested by `_drive_for` just before it set others
            override.before = (values[0], values[1])
        if not start <= address < start + len(values):
            return
        override.others = 0 if targets == override.targets else override.others + 1
        if override.others >= _NEWER:
            self._override = None
            left, right = zip(targets, override.targets, override.before, strict=True)
            self._drive((_of_program(*left), _of_program(*right)))

    def forget(self) -> None:
        """Forget a velocity, because the robot is gone."""
        self._override = None

    @property
    def _running_override(self) -> _Override | None:
        """The velocity that drives the wheels; the start of a program ends it."""
        if self._override is not None and self._override.program is not self._session.program:
            self._override = None
        return self._override

    @property
    def _missing_motors(self) -> tuple[str, ...]:
        """The wheels' variables that the robot lacks, or has with another size: not every Aseba robot is a Thymio."""
        addresses = {} if self._session.node is None else self._session.node.addresses
        return tuple(name for name in MOTORS if addresses.get(name, (0, 0))[1] != 1)

    @property
    def can_drive(self) -> bool:
        """Whether the robot is connected and has wheels."""
        return self._session.node is not None and not self._missing_motors

    @property
    def _targets(self) -> tuple[int, int] | None:
        left, right = (self._session.value(name) for name in MOTORS)
        return None if left is None or right is None else (left[0], right[0])

    def _drive_for(self, command: BodyTwist | WheelVelocities, now_ns: int) -> None:
        left, right = (round(speed / units.units_to_speed(1)) for speed in wheel_speeds(command))
        ends_ns = now_ns + command.timeout_ns if command.timeout_ns else None
        override, node = self._running_override, self._session.node
        if override is not None and override.targets == (left, right):
            override.ends_ns = ends_ns  # velocities may come faster than a robot can take them
            return
        if override is None and node is not None:
            self._session.client.read(node.number, MOTORS)  # the last reading may be older than the program's targets
        before = override.before if override is not None else self._targets or (0, 0)
        self._override = _Override(self._session.program, before, (left, right), ends_ns)
        self._drive((left, right))

    def _drive(self, targets: tuple[int, int]) -> None:
        for name, value in zip(MOTORS, targets, strict=True):
            self._write(name, (value,))

    def _write(self, name: str, words: Sequence[int]) -> None:
        node = self._session.node
        if node is None or name not in node.addresses:
            raise ValueError(f"the robot has no variable {name}")
        self._session.write(name, words)

    def _call(self, native: str, words: Sequence[int]) -> None:
        program = self._session.program
        if native not in program.numbers:
            reason = program.problem or f"it has no native function {native}"
            raise ValueError(f"the robot cannot do this: {reason}")
        self._session.emit(program.numbers[native], words)


def _of_program(target: int, own: int, before: int) -> int:
    """The program's target of a wheel, which is another than our own if the program has set a new one."""
    return before if target == own else target
