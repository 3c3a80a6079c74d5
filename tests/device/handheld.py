"""A robot without a world: a device with its host, fingers for its buttons, and what it shows. One `tick` is 20 ms."""

from __future__ import annotations

from thymio_sim_ros.device.behavior_host import BehaviorHost
from thymio_sim_ros.device.device import AsebaDevice
from thymio_sim_ros.device.network_events import EmittedEvent
from thymio_sim_ros.device.programs.program import ThymioProgram
from thymio_sim_ros.sim.commands import (
    BUTTONS,
    LED_GROUPS,
    Command,
    MotorTargets,
    PlaySystemSound,
    ReleaseLeds,
    SetLeds,
    ShowOnLeds,
)

TICK_NS = 20_000_000
BUDGET = 20_000


class HandheldRobot:
    """`leds` by group, `targets` of the wheels, `sounds` that began and `events` that others hear, in order."""

    def __init__(self) -> None:
        self.host = BehaviorHost(AsebaDevice())
        self.now_ns = 0
        self.leds = {group: (0,) * size for group, size in LED_GROUPS.items()}
        self.targets = (0, 0)
        self.sounds: list[int] = []
        self.events: list[EmittedEvent] = []
        self._pressed: set[str] = set()

    @classmethod
    def switched_on(cls, behaviour: str, own: ThymioProgram | None = None) -> HandheldRobot:
        """One that was switched on a tick ago."""
        robot = cls()
        robot.host.start(behaviour, own)
        robot.tick()
        return robot

    @property
    def device(self) -> AsebaDevice:
        return self.host.device

    @property
    def running(self) -> str:
        """Name of the program."""
        return self.host.program.name.removesuffix(".aesl")

    @property
    def top(self) -> tuple[int, ...]:
        return self.leds["top"]

    def tick(self, count: int = 1) -> None:
        """Let time pass."""
        for _ in range(count):
            self.now_ns += TICK_NS
            self.device.feed("buttons", [int(button in self._pressed) for button in BUTTONS])
            self.device.advance(self.now_ns)
            while self.device.is_busy:
                self.device.run(BUDGET)
                self.events += self.host.pop_events()
            for command in self.device.pop_commands():
                self._obey(command)

    def press(self, *buttons: str) -> None:
        """Put fingers on buttons, and leave them there."""
        self._pressed.update(buttons)

    def release(self, *buttons: str) -> None:
        self._pressed.difference_update(buttons)

    def touch(self, *buttons: str, ticks: int = 3) -> None:
        """Put fingers on buttons for so long, then take them off."""
        self.press(*buttons)
        self.tick(ticks)
        self.release(*buttons)
        self.tick(2)

    def _obey(self, command: Command) -> None:
        match command:
            case SetLeds(group, levels) | ShowOnLeds(group, levels):
                self.leds[group] = levels
            case ReleaseLeds(group):
                self.leds[group] = (0,) * LED_GROUPS[group]
            case MotorTargets(left, right):
                self.targets = (left, right)
            case PlaySystemSound(number):
                self.sounds.append(number)
