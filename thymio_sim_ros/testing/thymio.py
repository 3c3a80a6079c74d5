"""A robot in a test: its observed state, the actions of an operator, and its program."""

from __future__ import annotations

import difflib
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any, Protocol

from thymio_sim_ros.device.programs.program import ThymioProgram
from thymio_sim_ros.device.programs.status import DeviceStatus
from thymio_sim_ros.device.robot_device import RobotDevice
from thymio_sim_ros.engine.engine import Engine
from thymio_sim_ros.sim.actuators.leds import LedState
from thymio_sim_ros.sim.actuators.pen import PenState
from thymio_sim_ros.sim.audio.propagation import FULL_LEVEL
from thymio_sim_ros.sim.commands import (
    BUTTONS,
    LED_GROUPS,
    Clap,
    Command,
    Lift,
    MoveRobot,
    PressButton,
    RemoteKey,
    SetPen,
    Tap,
    Tilt,
)
from thymio_sim_ros.sim.model.fields import as_color
from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.model.primitives import Stroke
from thymio_sim_ros.sim.world import World
from thymio_sim_ros.testing.record import Event, Moment, Record, Touch

__all__ = ["RobotMachine", "Stage", "Thymio"]


class RobotMachine(Protocol):
    """A robot's Aseba machine and the program that it runs."""

    @property
    def device(self) -> RobotDevice:
        """The machine."""

    @property
    def program(self) -> ThymioProgram:
        """Its program."""


class Stage(Protocol):
    """The environment of robots: a classroom without ROS, or a simulator node."""

    @property
    def world(self) -> World:
        """The world as it is now."""

    @property
    def engine(self) -> Engine:
        """World and devices, to which commands are posted."""

    def run(self, seconds: float) -> None:
        """Let simulated time pass."""

    def until(self, condition: Callable[[], Any], seconds: float = 60.0, *, what: str = "") -> Any:
        """Let simulated time pass until a condition is true."""

    def machine(self, robot: str) -> RobotMachine | None:
        """The machine of a robot, or None where it has none."""

    def load(self, robot: str, program: str | Path | ThymioProgram) -> None:
        """Give a robot a program."""

    def set_variable(self, robot: str, variable: str, words: Sequence[int]) -> None:
        """Write a variable of a program."""

    def emit(self, event: str, args: Sequence[int]) -> None:
        """Send an event to all robots that declare it."""


class Thymio:
    """A robot of a world. Reading `thymio["name"]` gives a variable of its program, writing sets it."""

    def __init__(self, name: str, stage: Stage) -> None:
        self.name = name
        self.stage = stage
        self.record = Record()

    def __repr__(self) -> str:
        return f"<Thymio {self.name}>"

    # --- time ---

    def run(self, seconds: float) -> None:
        """Let so many simulated seconds pass for the whole world."""
        self.stage.run(seconds)

    def until(self, condition: Callable[[], Any], seconds: float = 60.0, *, what: str = "") -> Any:
        """Let time pass until the condition is true, at most so many simulated seconds; returns its value."""
        __tracebackhide__ = True
        return self.stage.until(condition, seconds, what=what)

    # --- what can be seen ---

    @property
    def pose(self) -> Pose:
        """Its true pose."""
        return self.stage.world.robots[self.name].pose

    @property
    def speed(self) -> float:
        """Its true speed along its heading, m/s."""
        return self.stage.world.robots[self.name].twist.linear_m_s

    @property
    def path(self) -> list[Moment]:
        """Its motion: a moment for each tick that the test has executed."""
        return self.record.moments

    @property
    def touches(self) -> list[Touch]:
        """The objects that it began to touch, and the times."""
        return self.record.touches

    @property
    def touching(self) -> tuple[str, ...]:
        """The names of what it touches now."""
        touching = self.stage.world.robots[self.name].body.touching.values()
        return tuple(sorted({contact.other for contact in touching}))

    @property
    def leds(self) -> Mapping[str, tuple[int, ...]]:
        """Brightness of each light, 0…32, by group: "top", "circle", …"""
        return self.stage.world.robots[self.name].state(LedState).levels

    @property
    def drawing(self) -> tuple[Stroke, ...]:
        """The strokes of its pen."""
        return self.stage.world.robots[self.name].state(PenState).strokes

    # --- its program ---

    def load(self, program: str | Path | ThymioProgram) -> None:
        """Give it a program: an .aesl file, a built-in behaviour's name, or the text. It begins at once."""
        __tracebackhide__ = True
        self.stage.load(self.name, program)

    @property
    def events(self) -> list[Event]:
        """The global events that its program emitted."""
        return self.record.events

    def emit(self, event: str, *args: int) -> None:
        """Send an event to all robots, as if another node of the Aseba network had emitted it."""
        __tracebackhide__ = True
        self.stage.emit(event, args)

    @property
    def status(self) -> DeviceStatus:
        """Whether its program runs, and what went wrong where."""
        return self._machine().device.status

    @property
    def program(self) -> ThymioProgram | None:
        """Its program, if it has a machine."""
        machine = self.stage.machine(self.name)
        return None if machine is None else machine.program

    @property
    def variables(self) -> dict[str, int | tuple[int, ...]]:
        """All variables of its program and of the robot by name."""
        return {name: self[name] for name in self._machine().device.variables.addresses()}

    def __getitem__(self, variable: str) -> int | tuple[int, ...]:
        """A variable: a number, or the numbers of an array."""
        device = self._machine().device
        self._check_variable(device, variable)
        words = device.variables.get(variable)
        return words[0] if len(words) == 1 else words

    def __setitem__(self, variable: str, value: int | Sequence[int]) -> None:
        device = self._machine().device
        self._check_variable(device, variable)
        self.stage.set_variable(self.name, variable, [value] if isinstance(value, int) else value)

    # --- what people do to it ---

    def press(self, button: str) -> None:
        """Press and hold a button: "forward", "backward", "left", "right" or "center"."""
        self._press(button, pressed=True)

    def release(self, button: str) -> None:
        """Release a button."""
        self._press(button, pressed=False)

    def touch(self, *buttons: str, seconds: float = 0.1) -> None:
        """Press buttons together, advance time, release them, and advance time again."""
        for pressed in (True, False):
            for button in buttons:
                self._press(button, pressed=pressed)
            self.run(seconds)

    def clap(self, loudness: int = FULL_LEVEL) -> None:
        """Clap beside it; `loudness` is in units of mic.intensity, 0…255. The clap row of VPL needs more than 250."""
        self.post(Clap(loudness))

    def tap(self) -> None:
        """Knock on it."""
        self.post(Tap())

    def tilt(self, roll_rad: float = 0.0, pitch_rad: float = 0.0) -> None:
        """Tilt it until the next `tilt`; positive roll lifts the left side, positive pitch lowers the front."""
        self.post(Tilt(roll_rad, pitch_rad))

    def lift(self) -> None:
        """Lift it off the floor."""
        self.post(Lift(is_lifted=True))

    def put_down(self) -> None:
        """Put it down where it is. Raises PlacementError if something is in the way."""
        self.post(Lift(is_lifted=False))

    def key(self, command: int, address: int = 0) -> None:
        """Press a key of a remote control."""
        self.post(RemoteKey(address, command))

    def place(self, x_m: float, y_m: float, yaw_rad: float = 0.0) -> None:
        """Move it to a pose."""
        self.post(MoveRobot(x_m, y_m, yaw_rad))

    def draw(self, color: str = "#000000", width_m: float = 0.003) -> None:
        """Put a pen of a color '#rrggbb' into it: from now on it draws where it goes."""
        self.post(SetPen(down=True, color=as_color(color), width_m=width_m, erase=False))

    def lift_pen(self) -> None:
        """Lift the pen."""
        self.post(SetPen(down=False))

    def post(self, command: Command) -> None:
        """Post a command of `thymio_sim_ros.sim.commands`; it takes effect in the next tick."""
        self.stage.engine.post(self.name, command)

    def level(self, group: str) -> tuple[int, ...]:
        """Brightness of the lights of a group, 0…32. Raises KeyError, which names the groups, for an unknown one."""
        if group not in LED_GROUPS:
            raise KeyError(f"no lights '{group}': expected one of {', '.join(LED_GROUPS)}")
        return self.leds[group]

    def _press(self, button: str, *, pressed: bool) -> None:
        if button not in BUTTONS:
            raise ValueError(f"no button '{button}': expected one of {', '.join(BUTTONS)}")
        self.post(PressButton(button, pressed))

    def _machine(self) -> RobotMachine:
        machine = self.stage.machine(self.name)
        if machine is None:
            raise LookupError(f"no Aseba machine runs for {self.name}: start one with the fixture `runtime`")
        return machine

    def _check_variable(self, device: RobotDevice, variable: str) -> None:
        names = device.variables.addresses()
        if variable not in names:
            near = difflib.get_close_matches(variable, names, 3)
            hint = f"; did you mean {' or '.join(near)}?" if near else ""
            raise KeyError(f"{self.name}: its program has no variable '{variable}'{hint}")
