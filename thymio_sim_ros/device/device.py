"""An Aseba Thymio: readings in, machine, commands and events out. It knows no world and no ROS.

Events are delivered as the firmware does (thymio-robot.md section 3): one pending flag each, the lowest number first, a
running handler is never interrupted by a local event. Global events wait in line; one that finds a handler which has
had its turn of instructions ends it (aseba-bytecode-vm.md section 10.5). What is fed belongs to the present: timers
that fired before come first. A reset clears all variables and switches the lights off.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from aseba_vm import VirtualMachine
from aseba_vm.outbox import BadCode, DivisionByZero, Emitted, NodeSpecific, OutOfBounds
from thymio_sim_ros.device import bindings
from thymio_sim_ros.device.layout import FIRMWARE, PRODUCT_ID, target
from thymio_sim_ros.device.natives import native_functions
from thymio_sim_ros.device.program import ThymioProgram, load_program
from thymio_sim_ros.device.status import FAULT, INIT, PAUSED, RUNNING, STOPPED, DeviceStatus, sentence
from thymio_sim_ros.device.timers import Timers
from thymio_sim_ros.sim.commands import Command

__all__ = ["AsebaDevice", "DeviceStatus", "EmittedEvent"]

INT16 = range(-0x8000, 0x8000)
TURN = 65535
"""Instructions after which a handler can be ended by a global event (thymio-robot.md section 3)."""
MOST_WAITING = 100
"""Global events that may wait for a machine; more are lost, and said so."""


@dataclass(frozen=True, slots=True)
class EmittedEvent:
    """A global event that the program emitted."""

    name: str
    args: tuple[int, ...]


class AsebaDevice:
    """One robot's machine with its variables. Invariant: between calls no instruction runs."""

    def __init__(self, *, node_id: int = 1) -> None:
        self.node_id = node_id
        self._target = target()
        self._addresses = self._target.addresses
        self._timers = Timers()
        self._timer_events = tuple(0xFFFE - self._target.local_event_number(name) for name in ("timer0", "timer1"))
        self._pending: set[int] = set()
        self._arrived: set[int] = set()
        self._incoming: deque[tuple[int, int, tuple[int, ...]]] = deque()
        self._last: dict[str, list[int]] = {}
        self._event = ""
        self._begun = 0
        self._commands: list[Command] = []
        self._events: list[EmittedEvent] = []
        self._notices: list[str] = []
        self._noticed: set[str] = set()
        self._is_changed = True
        self._sent: list[list[int]] = []
        self._state = RUNNING
        self._fault: DeviceStatus | None = None
        self._vm = VirtualMachine(
            self._target, native_functions(self._send, self._tell), node_id, on_reset=self._on_reset
        )
        self.load(load_program("", "none"))

    @property
    def is_busy(self) -> bool:
        """Whether something waits for instructions: a handler that goes on, or an event."""
        if self._vm.is_step_by_step:
            return False
        return self._vm.is_active or self._waits

    @property
    def status(self) -> DeviceStatus:
        """How the machine is."""
        if self._fault is not None:
            return self._fault
        if not self._vm.is_active:
            return DeviceStatus(self._state)
        return DeviceStatus(self._state, self._event, self._program.line_of(self._vm.pc))

    def load(self, program: ThymioProgram, *, warm: bool = False) -> None:
        """Replace the program; the robot is reset and the next `run` begins with the initialisation.

        `warm`, as the robot changes its own behaviours: the variables of sensors hold, and a button that is still held
        is no news.
        """
        readings = self._last.copy() if warm else {}
        self._program = program
        self._names = [name for name, _ in program.events]
        self._handled = frozenset(0xFFFE - event.number for event in program.program.events)
        self._last.clear()
        words = program.program.words
        self._vm.set_bytecode((*words, *[0] * (self._target.bytecode_size - len(words))))
        for sensor, reading in readings.items():
            self.feed(sensor, reading)
        self._arrived.clear()
        self.resume()

    def feed(self, sensor: str, words: Sequence[int]) -> None:
        """Store a reading's words (int16) and let the events that the program handles wait.

        KeyError: no such sensor; ValueError: wrong number of words.
        """
        binding = bindings.sensors()[sensor]
        if len(words) != binding.size:
            raise ValueError(f"{len(words)} words found, expected {binding.size}")
        new = list(words)
        memory, old, handled = self._vm.variables, self._last.get(sensor), self._handled
        begin = 0
        for slot in binding.slots:
            end = begin + slot.size
            part = new[begin:end]
            memory[slot.address : slot.address + slot.size] = part
            if slot.edge in handled and part != (old[begin:end] if old else [0] * slot.size):
                self._arrived.add(slot.edge)
            begin = end
        self._last[sensor] = new
        if binding.event in handled and (binding.above is None or new[0] > memory[binding.above] != 0):
            self._arrived.add(binding.event)

    def advance(self, now_ns: int) -> None:
        """Simulated time has come so far; `run` raises the events of timers whose period ended on the way."""
        self._pending.update(self._timer_events[index] for index in self._timers.set_clock(now_ns))

    def run(self, budget: int) -> None:
        """Execute handlers until nothing waits, or so many instructions were executed."""
        if not self.is_busy:
            return
        self._is_changed = True
        vm = self._vm
        end = vm.instructions + budget
        while self.is_busy and vm.instructions < end:
            if not vm.is_active:
                self._start_next()
            elif self._incoming and vm.instructions - self._begun >= TURN:
                self._start_incoming()
            vm.run(min(TURN, end - vm.instructions))
            self._listen()
        if not vm.is_active:
            self._notice_periods()

    def declares(self, event: str) -> bool:
        """Whether the program knows a global event of this name."""
        return event in self._names

    def receive_event(self, name: str, args: Sequence[int], *, source: int = 0) -> None:
        """A global event arrives and waits for `run`; a machine that is not running does not hear it.

        KeyError: the program does not declare it.
        """
        if name not in self._names:
            raise KeyError(name)
        if self._vm.is_step_by_step and (self._vm.is_active or self._state != PAUSED):
            return
        if len(self._incoming) >= MOST_WAITING:
            self._tell(f"more events arrive than the program can handle: {name} is lost")
            return
        self._incoming.append((self._names.index(name), source, tuple(args)))

    def resume(self) -> None:
        """Let events run (again)."""
        self._vm.resume()
        self._state, self._fault = RUNNING, None

    def pause(self) -> None:
        """Execute nothing until `step` or `resume`; wheels and lights stay as they are."""
        self._vm.pause()
        self._state, self._fault = PAUSED, None

    def step(self) -> None:
        """Execute one instruction; between events, begin the next one that waits."""
        self.pause()
        while not self._vm.is_active and self._waits:
            self._start_next()
        self._vm.step()
        self._is_changed = True
        self._listen()

    def stop(self) -> None:
        """Abandon the handler; wheels stand still."""
        self._vm.stop()
        self._forget_events()
        self._halt()
        self._state, self._fault = STOPPED, None

    def reset(self) -> None:
        """As the robot's reset: variables cleared, lights off, ready to begin anew, paused."""
        self._vm.reset()
        self._state, self._fault = PAUSED, None

    def take_commands(self) -> list[Command]:
        """What the program told the actuators since the last time: native calls, then changed variables."""
        commands, self._commands = self._commands, []
        if not self._is_changed:
            return commands
        self._is_changed = False
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
        self._is_changed = True

    @property
    def _waits(self) -> bool:
        """Whether an event, or time that is not counted yet, waits for the machine."""
        return bool(self._pending or self._arrived or self._incoming or self._timers.lag_ms)

    def _start_next(self) -> None:
        """Start the next event, or count time up to the next timer event; at the end comes what belongs to now."""
        self._notice_periods()
        if not self._pending and self._timers.lag_ms:
            self._pending.update(self._timer_events[index] for index in self._timers.next_firing())
        elif not self._timers.lag_ms:
            self._pending |= self._arrived
            self._arrived.clear()
            if self._incoming:
                self._start_incoming()
                return
        if self._pending:
            index = min(self._pending)
            self._pending.remove(index)
            self._begin(self._target.local_events[index].name)
            self._vm.start_local(index)

    def _start_incoming(self) -> None:
        number, source, args = self._incoming.popleft()
        self._begin(self._names[number])
        self._vm.receive(number, source, args)

    def _begin(self, event: str) -> None:
        self._event, self._begun = event, self._vm.instructions

    def _notice_periods(self) -> None:
        address, size = self._addresses["timer.period"]
        self._timers.notice(self._vm.variables[address : address + size])

    def _forget_events(self) -> None:
        self._pending.clear()
        self._arrived.clear()
        self._incoming.clear()

    def _listen(self) -> None:
        for message in self._vm.take_messages():
            if isinstance(message, Emitted):
                if message.number < len(self._names):
                    self._events.append(EmittedEvent(self._names[message.number], message.arguments))
            elif isinstance(message, OutOfBounds | DivisionByZero | NodeSpecific | BadCode):
                line = self._program.line_of(message.pc)
                self._state = FAULT
                self._fault = DeviceStatus(FAULT, self._event, line, sentence(message.reason))
                self._forget_events()
                self._halt()

    def _halt(self) -> None:
        for name in ("motor.left.target", "motor.right.target"):
            self.set_variable(name, (0,))

    def _send(self, command: Command, writes: Mapping[str, Sequence[int]]) -> None:
        """A native's command and the variables that it sets; what they mean is told by the command already."""
        self._commands.append(command)
        for variable, words in writes.items():
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
        self._is_changed = True
        vm.random_state = (self.node_id - 1) * 25173 & 0xFFFF  # robots differ, a run repeats itself
        self._begin(INIT)
        self._forget_events()
        self._timers.reset()
        self._sent = [self._words(output) for output in bindings.outputs()]
        at_rest = [output.command(words) for output, words in zip(bindings.outputs(), self._sent, strict=True)]
        self._commands = at_rest + [command for command in bindings.at_reset() if command not in at_rest]
