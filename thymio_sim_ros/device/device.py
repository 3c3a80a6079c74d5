"""An Aseba Thymio: readings in, machine, commands and events out. It knows no world and no ROS.

Events are delivered as the firmware does (thymio-robot.md section 3): one pending flag each, the lowest number first, a
running handler is never interrupted by a local event. A reset clears all variables and switches the lights off.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from aseba_vm import VirtualMachine
from aseba_vm.outbox import BadCode, DivisionByZero, Emitted, NodeSpecific, OutOfBounds
from thymio_sim_ros.device import bindings
from thymio_sim_ros.device.layout import FIRMWARE, PRODUCT_ID, target
from thymio_sim_ros.device.natives import native_functions
from thymio_sim_ros.device.program import ThymioProgram, load_program
from thymio_sim_ros.device.timers import Timer
from thymio_sim_ros.sim.commands import LED_GROUPS, Command, SetLeds

RUNNING, PAUSED, STOPPED, FAULT = "running", "paused", "stopped", "fault"

INT16 = range(-0x8000, 0x8000)
MOST_TIMER_EVENTS = 100
"""Timer events that may wait for a handler: what a very late turn makes up for."""


@dataclass(frozen=True, slots=True)
class EmittedEvent:
    """A global event that the program emitted."""

    name: str
    args: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class DeviceStatus:
    """State (`running`, `paused`, `stopped`, `fault`); event, line (from 1) and text of a fault."""

    state: str
    event: str = ""
    line: int | None = None
    fault: str = ""


class AsebaDevice:
    """One robot's machine with its variables. Invariant: between calls no instruction runs."""

    def __init__(self, *, node_id: int = 1) -> None:
        self.node_id = node_id
        self._target = target()
        self._addresses = self._target.addresses
        self._timers = (Timer(), Timer())
        self._timer_events = tuple(0xFFFE - self._target.local_event_number(name) for name in ("timer0", "timer1"))
        self._pending: dict[int, int] = {}
        self._commands: list[Command] = []
        self._events: list[EmittedEvent] = []
        self._notices: list[str] = []
        self._noticed: set[str] = set()
        self._sent: list[list[int]] = []
        self.status = DeviceStatus(RUNNING)
        self._vm = VirtualMachine(
            self._target, native_functions(self._send, self._tell), node_id, on_reset=self._on_reset
        )
        self.load(load_program("", "none"))

    @property
    def is_busy(self) -> bool:
        """Whether something waits for instructions: a handler that goes on, or an event."""
        if self._vm.is_step_by_step:
            return False
        return self._vm.is_active or bool(self._pending)

    def load(self, program: ThymioProgram) -> None:
        """Replace the program; the robot is reset and the next `run` begins with the initialisation."""
        self._program = program
        self._names = [name for name, _ in program.events]
        self._vm.load(program.program)
        self.status = DeviceStatus(RUNNING)

    def feed(self, sensor: str, words: Sequence[int]) -> None:
        """Store a reading's words and let its events wait. KeyError: no such sensor; ValueError: wrong words."""
        binding = bindings.sensors()[sensor]
        if len(words) != binding.size:
            raise ValueError(f"{len(words)} words found, expected {binding.size}")
        memory = self._vm.variables
        begin = 0
        for slot in binding.slots:
            new = [int(word) for word in words[begin : begin + slot.size]]
            begin += slot.size
            old = memory[slot.address : slot.address + slot.size]
            if new != old:
                self._vm.write_variables(slot.address, new)
                if slot.edge is not None:
                    self._pending[slot.edge] = 1
        if binding.event is not None:
            self._pending[binding.event] = 1

    def advance(self, now_ns: int) -> None:
        """Simulated time has come so far: timers whose period ended raise their events."""
        address, _ = self._addresses["timer.period"]
        for index, timer in enumerate(self._timers):
            ended = timer.elapsed(self._vm.variables[address + index], now_ns)
            if ended:
                event = self._timer_events[index]
                self._pending[event] = min(self._pending.get(event, 0) + ended, MOST_TIMER_EVENTS)

    def run(self, budget: int) -> None:
        """Execute handlers until nothing waits, or about so many instructions were executed."""
        left = budget
        while left > 0 and self.is_busy:
            if not self._vm.is_active:
                self._start_lowest()
            before = self._vm.instructions
            self._vm.run(left)
            left -= max(1, self._vm.instructions - before)
            self._listen()

    def declares(self, event: str) -> bool:
        """Whether the program knows a global event of this name."""
        return event in self._names

    def receive_event(self, name: str, args: Sequence[int], *, source: int = 0) -> None:
        """A global event arrives, as on the Aseba network: it ends a running handler. KeyError: not declared."""
        if name not in self._names:
            raise KeyError(name)
        self._vm.receive(self._names.index(name), source, args)
        self._listen()

    def resume(self) -> None:
        """Let events run (again)."""
        self._vm.resume()
        self.status = DeviceStatus(RUNNING)

    def pause(self) -> None:
        """Execute nothing until `step` or `resume`; wheels and lights stay as they are."""
        self._vm.pause()
        self.status = DeviceStatus(PAUSED)

    def step(self) -> None:
        """Execute one instruction; between events, begin the next one that waits."""
        self.pause()
        if not self._vm.is_active and self._pending:
            self._start_lowest()
        self._vm.step()
        self._listen()

    def stop(self) -> None:
        """Abandon the handler; wheels stand still."""
        self._vm.stop()
        self._pending.clear()
        self._halt()
        self.status = DeviceStatus(STOPPED)

    def reset(self) -> None:
        """As the robot's reset: variables cleared, lights off, ready to begin anew, paused."""
        self._vm.reset()
        self.status = DeviceStatus(PAUSED)

    def take_commands(self) -> list[Command]:
        """What the program told the actuators since the last time: native calls, then changed variables."""
        commands, self._commands = self._commands, []
        for output, sent in zip(bindings.outputs(), self._sent, strict=True):
            words = self._words(output)
            if words != sent:
                sent[:] = words
                commands.append(output.command(words))
        return commands

    def take_events(self) -> list[EmittedEvent]:
        """What the program emitted since the last time, in order."""
        events, self._events = self._events, []
        return events

    def take_notices(self) -> list[str]:
        """What the user should know, each thing once."""
        notices, self._notices = self._notices, []
        return notices

    def variables(self) -> dict[str, tuple[int, int]]:
        """Address and size of every variable, those of the program included."""
        return self._addresses | self._program.program.addresses

    def get_variable(self, name: str) -> tuple[int, ...]:
        """Words of a variable; KeyError when there is none of that name."""
        address, size = self.variables()[name]
        return tuple(self._vm.variables[address : address + size])

    def set_variable(self, name: str, words: Sequence[int]) -> None:
        """Write a whole variable. KeyError: no such name; ValueError: wrong size or range."""
        address, size = self.variables()[name]
        if len(words) != size:
            raise ValueError(f"{name}: {len(words)} words found, expected {size}")
        wrong = [word for word in words if word not in INT16]
        if wrong:
            raise ValueError(f"{name}: {wrong[0]} found, expected -32768 to 32767")
        self._vm.write_variables(address, words)

    def _start_lowest(self) -> None:
        index = min(self._pending)
        self._pending[index] -= 1
        if self._pending[index] <= 0:
            del self._pending[index]
        self._vm.start_local(index)

    def _listen(self) -> None:
        for message in self._vm.take_messages():
            if isinstance(message, Emitted):
                if message.number < len(self._names):
                    self._events.append(EmittedEvent(self._names[message.number], message.arguments))
            elif isinstance(message, OutOfBounds | DivisionByZero | NodeSpecific | BadCode):
                segment = self._program.program.segment_of(message.pc)
                name = segment.name if segment is not None else ""
                self.status = DeviceStatus(FAULT, name, self._program.line_of(message.pc), message.reason)
                self._pending.clear()
                self._halt()

    def _halt(self) -> None:
        for name in ("motor.left.target", "motor.right.target"):
            self.set_variable(name, (0,))

    def _send(self, command: Command, variable: str | None, words: Sequence[int]) -> None:
        self._commands.append(command)
        if variable is None:
            return
        address, _ = self._addresses[variable]
        self._vm.write_variables(address, words)
        for output, sent in zip(bindings.outputs(), self._sent, strict=True):
            if output.slots[0].address == address:
                sent[:] = self._words(output)

    def _words(self, output: bindings.OutputBinding) -> list[int]:
        """What the variables of an output hold."""
        memory = self._vm.variables
        return [word for slot in output.slots for word in memory[slot.address : slot.address + slot.size]]

    def _tell(self, notice: str) -> None:
        if notice not in self._noticed:
            self._noticed.add(notice)
            self._notices.append(notice)

    def _on_reset(self, vm: VirtualMachine) -> None:
        """The robot's share in a reset (thymio-robot.md section 4)."""
        vm.variables[:] = [0] * len(vm.variables)
        for name, words in (("_id", (self.node_id,)), ("_productId", (PRODUCT_ID,)), ("_fwversion", FIRMWARE)):
            vm.write_variables(self._addresses[name][0], words)
        self._pending.clear()
        for timer in self._timers:
            timer.reset()
        self._sent = [self._words(output) for output in bindings.outputs()]
        at_rest = [output.command(words) for output, words in zip(bindings.outputs(), self._sent, strict=True)]
        dark: list[Command] = [SetLeds(group, (0,) * size) for group, size in LED_GROUPS.items()]
        self._commands = at_rest + [command for command in dark if command not in at_rest]
