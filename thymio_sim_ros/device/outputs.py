"""Commands for the actuators: from native calls at once, from variables when their values change."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType

from aseba_vm import VirtualMachine
from thymio_sim_ros.device import bindings
from thymio_sim_ros.device.firmware.indicators import Indicators
from thymio_sim_ros.device.firmware.settings import Settings
from thymio_sim_ros.device.layout import target
from thymio_sim_ros.sim.commands import (
    LED_GROUPS,
    LEDS_GIVEN_BACK,
    Command,
    EnableComm,
    MotorTargets,
    PlaySamples,
    PlaySystemSound,
    PlayTone,
    SetLed,
    SetLeds,
    ShowOnLeds,
    StopSound,
)

__all__ = ["Outputs"]

_SOUNDS = frozenset({PlayTone, PlaySystemSound, PlaySamples, StopSound})
"""Commands that count as use of sound by a program."""
LIGHT_REPEAT_NS = 500_000_000
"""Period in which a repeated setting of lights to the same levels is sent once."""
_NOTHING: Mapping[str, Sequence[int]] = MappingProxyType({})


class Outputs:
    """Queued commands of one device. Invariant: `_sent` has the words of the last command of each output."""

    def __init__(self, layout: str, settings: Settings, indicators: Indicators) -> None:
        """`settings` calibrate the motors; `indicators` release the lights and sounds that a program uses."""
        self.has_used_sound = False
        """Whether the program has used sound since the reset."""
        self._addresses = target(layout).addresses
        self._outputs = bindings.outputs(layout)
        self._by_address = {output.slots[0].address: number for number, output in enumerate(self._outputs)}
        """Index of each output by the address of its first variable."""
        self._settings = settings
        self._indicators = indicators
        self._vm: VirtualMachine | None = None
        self._queued: list[Command] = []
        self._sent: list[list[int]] = []
        self._light_levels: dict[str, tuple[int, ...]] = {}
        self._light_period = 0
        """Number of the period of `LIGHT_REPEAT_NS` to which `_light_levels` belongs."""

    def reset(self, vm: VirtualMachine) -> None:
        """Queue the commands of a reset: those of variables that are 0, and those of all actuators."""
        self._vm = vm
        self._light_levels.clear()
        self.has_used_sound = False
        self._sent = [self._words(output) for output in self._outputs]
        at_rest = [output.command(words) for output, words in zip(self._outputs, self._sent, strict=True)]
        self._queued = at_rest + [command for command in bindings.at_reset() if command not in at_rest]

    def queue(self, *commands: Command) -> None:
        """Queue commands of the firmware."""
        self._queued += commands

    def send(self, command: Command, writes: Mapping[str, Sequence[int]] = _NOTHING) -> None:
        """Queue the command of a native call and write the variables that the call sets.

        The variables cause no command of their own. A program that keeps setting lights to the same levels causes a
        command every `LIGHT_REPEAT_NS` only; it is repeated because a ROS topic may have set the lights meanwhile.
        """
        if isinstance(command, SetLeds):
            if self._light_levels.get(command.group) != command.levels:
                self._queued.append(self._claim_lights(command))
        else:
            self._queued.append(command)
            if type(command) in _SOUNDS:
                self.has_used_sound = True
                self._indicators.mute_buttons()
            elif isinstance(command, SetLed):
                self._light_levels.clear()
        for variable, words in writes.items():
            self._write(variable, words)

    def advance(self, now_ns: int) -> None:
        """Advance simulated time."""
        period = max(0, now_ns - 1) // LIGHT_REPEAT_NS
        if period != self._light_period:
            self._light_period = period
            self._light_levels.clear()

    def pop(self) -> list[Command]:
        """Return and clear the queued commands."""
        commands, self._queued = self._queued, []
        return commands

    def switch_off_lights(self) -> None:
        """Queue the commands of switching off: pending changes of variables, then lights and radio off."""
        self._queued += self.pop_changes()
        self._queued += (EnableComm(False), *LEDS_GIVEN_BACK)

    def pop_changes(self) -> list[Command]:
        """Return the commands of variables that changed since the last call."""
        commands: list[Command] = []
        for number, output in enumerate(self._outputs):
            words = self._words(output)
            if words != self._sent[number]:
                self._sent[number] = words
                commands.append(self._adjusted(output.command(words)))
        return commands

    def resend_motor_targets(self) -> None:
        """Send the motor targets again, because their calibration has changed."""
        for output, sent in zip(self._outputs, self._sent, strict=True):
            if isinstance(output.command(self._words(output)), MotorTargets):
                sent.clear()

    def _adjusted(self, command: Command) -> Command:
        """Calibrate a command for motors; claim the lights of a command for lights."""
        if isinstance(command, MotorTargets):
            return self._settings.calibrate(command)
        return self._claim_lights(command) if isinstance(command, SetLeds) else command

    def _claim_lights(self, command: SetLeds) -> SetLeds:
        self._light_levels[command.group] = command.levels
        for group in self._indicators.claim(command.group):
            self._queued.append(ShowOnLeds(group, (0,) * LED_GROUPS[group]))
        return command

    def _write(self, variable: str, words: Sequence[int]) -> None:
        """Write a variable of the machine, if its layout has it, without causing a command."""
        assert self._vm is not None
        if variable not in self._addresses:
            return
        address, size = self._addresses[variable]
        number = self._by_address.get(address)
        if number is not None and self._sent[number] == words == self._vm.variables.words[address : address + size]:
            return
        self._vm.write_variables(address, words)
        if number is not None:
            self._sent[number] = self._words(self._outputs[number])

    def _words(self, output: bindings.OutputBinding) -> list[int]:
        """Words of the variables of an output."""
        assert self._vm is not None
        memory = self._vm.variables.words
        words: list[int] = []
        for address, address_end, _, _ in output.runs:
            words += memory[address:address_end]
        return words
