"""What the actuators are told: by natives at once, by variables that a program wrote when they differ from before."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import MappingProxyType

from aseba_vm import VirtualMachine
from thymio_sim_ros.device import bindings
from thymio_sim_ros.device.firmware.indicators import OwnRules
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
"""Commands with which a program uses sound."""
LIT_NS = 500_000_000
"""For so long lights that a program sets to the same again are not told again."""
_NOTHING: Mapping[str, Sequence[int]] = MappingProxyType({})


class Outputs:
    """Commands of one device that wait to be taken. Invariant: `_sent` is what the variables told last."""

    def __init__(self, layout: str, settings: Settings, rules: OwnRules) -> None:
        """`settings` correct the wheels; `rules` lose the lights and the sounds that a program uses."""
        self.has_used_sound = False
        """Whether the program has used sound since the reset."""
        self._addresses = target(layout).addresses
        self._outputs = bindings.outputs(layout)
        self._by_address = {output.slots[0].address: number for number, output in enumerate(self._outputs)}
        """Output by where its first variable lies."""
        self._settings = settings
        self._rules = rules
        self._vm: VirtualMachine | None = None
        self._waiting: list[Command] = []
        self._sent: list[list[int]] = []
        self._lit: dict[str, tuple[int, ...]] = {}
        self._lit_ns = 0

    def reset(self, vm: VirtualMachine) -> None:
        """All variables are 0: tell what that means, and what a reset tells every actuator."""
        self._vm = vm
        self._lit.clear()
        self.has_used_sound = False
        self._sent = [self._words(output) for output in self._outputs]
        at_rest = [output.command(words) for output, words in zip(self._outputs, self._sent, strict=True)]
        self._waiting = at_rest + [command for command in bindings.at_reset() if command not in at_rest]

    def tell(self, *commands: Command) -> None:
        """Commands of the robot itself."""
        self._waiting += commands

    def send(self, command: Command, writes: Mapping[str, Sequence[int]] = _NOTHING) -> None:
        """A native's command and the variables that it sets; what they mean is told by the command already.

        Lights that a program sets again and again to the same are told every `LIT_NS`: somebody else may have set them.
        """
        if isinstance(command, SetLeds):
            if self._lit.get(command.group) != command.levels:
                self._waiting.append(self._taken_over(command))
        else:
            self._waiting.append(command)
            if type(command) in _SOUNDS:
                self.has_used_sound = True
                self._rules.silence()
            elif isinstance(command, SetLed):
                self._lit.clear()
        for variable, words in writes.items():
            self._write(variable, words)

    def take(self, now_ns: int) -> list[Command]:
        """What was sent since the last time."""
        if not 0 <= now_ns - self._lit_ns < LIT_NS:
            self._lit_ns = now_ns
            self._lit.clear()
        commands, self._waiting = self._waiting, []
        return commands

    def darken(self) -> None:
        """The robot is switched off: tell what variables say now, then that lights and radio rest."""
        self._waiting += self.take_changes()
        self._waiting += (EnableComm(False), *LEDS_GIVEN_BACK)

    def take_changes(self) -> list[Command]:
        """What variables say that changed since the last time."""
        commands: list[Command] = []
        for number, output in enumerate(self._outputs):
            words = self._words(output)
            if words != self._sent[number]:
                self._sent[number] = words
                commands.append(self._meant(output.command(words)))
        return commands

    def tell_motors_again(self) -> None:
        """The same targets are another command now."""
        for output, sent in zip(self._outputs, self._sent, strict=True):
            if isinstance(output.command(self._words(output)), MotorTargets):
                sent.clear()

    def _meant(self, command: Command) -> Command:
        """What a command of variables comes to: wheels are corrected, lights taken over."""
        if isinstance(command, MotorTargets):
            return self._settings.calibrate(command)
        return self._taken_over(command) if isinstance(command, SetLeds) else command

    def _taken_over(self, command: SetLeds) -> SetLeds:
        self._lit[command.group] = command.levels
        for group in self._rules.take(command.group):
            self._waiting.append(ShowOnLeds(group, (0,) * LED_GROUPS[group]))
        return command

    def _write(self, variable: str, words: Sequence[int]) -> None:
        """Set a variable of the machine, if its layout has it, as if it had been told."""
        assert self._vm is not None
        if variable not in self._addresses:
            return
        address, _ = self._addresses[variable]
        self._vm.write_variables(address, words)
        number = self._by_address.get(address)
        if number is not None:
            self._sent[number] = self._words(self._outputs[number])

    def _words(self, output: bindings.OutputBinding) -> list[int]:
        """What the variables of an output hold."""
        assert self._vm is not None
        memory = self._vm.variables.words
        words: list[int] = []
        for address, address_end, _, _ in output.runs:
            words += memory[address:address_end]
        return words
