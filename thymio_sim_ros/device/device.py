"""An Aseba Thymio: readings in, machine, commands and events out. It knows no world and no ROS.

How events meet is decided by an `EventQueue`; here a global event also ends a handler that has had its turn of
instructions (docs/spec/aseba-bytecode-vm.md section 10.5). Beside the program runs what the robot does by itself: its
own rules for lights and button sounds, its card, settings and radio. A reset clears all variables and switches the
lights off.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass

from aseba_vm import VirtualMachine
from aseba_vm.machine.costs import NO_COSTS
from aseba_vm.machine.machine_messages import BadCode, DivisionByZero, Emitted, NodeSpecific, OutOfBounds
from aseba_vm.messages import LANGUAGES
from thymio_sim_ros.device.costs import COSTS
from thymio_sim_ros.device.events import POLICIES, EventQueue, GlobalEvent
from thymio_sim_ros.device.firmware.indicators import PERIOD_NS, OwnRules
from thymio_sim_ros.device.firmware.sd_card import Card
from thymio_sim_ros.device.firmware.services import RESTART, Body
from thymio_sim_ros.device.firmware.settings import Settings
from thymio_sim_ros.device.inputs import Inputs
from thymio_sim_ros.device.layout import LAYOUTS, target
from thymio_sim_ros.device.natives import native_functions
from thymio_sim_ros.device.options import DEFAULTS, DeviceOptions
from thymio_sim_ros.device.outputs import Outputs
from thymio_sim_ros.device.programs.breakpoints import Breakpoints, LineDebugger
from thymio_sim_ros.device.programs.load import Load, Meter
from thymio_sim_ros.device.programs.program import ThymioProgram, load_program
from thymio_sim_ros.device.programs.status import FAULT, INIT, OFF, PAUSED, RUNNING, STOPPED, DeviceStatus
from thymio_sim_ros.sim.audio.synthesis import SHUT_DOWN
from thymio_sim_ros.sim.commands import Command, PlaySystemSound

__all__ = ["AsebaDevice", "DeviceStatus", "EmittedEvent"]

_SOUND, _BATTERY = "sound", "battery"
"""The sensors whose first word is `mic.intensity`, and whose last tells whether a charger is connected."""
INT16 = range(-0x8000, 0x8000)
MOST_NOTICES = 50
"""Different notices of a device; a program can make ever new ones."""


@dataclass(frozen=True, slots=True)
class EmittedEvent:
    """A global event that the program emitted."""

    name: str
    args: tuple[int, ...]


class AsebaDevice:
    """One robot's machine with its variables. Invariant: between calls no instruction runs."""

    def __init__(self, *, node_id: int = 1, options: DeviceOptions = DEFAULTS) -> None:
        """CardError or SettingsError when a folder of the options cannot be used."""
        self.layout = options.layout
        self._target = target(self.layout)
        self._addresses = self._target.addresses
        self._first_values = LAYOUTS[self.layout].first_values
        self._timer_events = tuple(map(self._event_index, ("timer0", "timer1")))
        self._queue = EventQueue(POLICIES[options.events], self._timer_events)
        self._periods = self._addresses["timer.period"]
        self._intensity = self._addresses["mic.intensity"][0]
        self._sound_finished = self._event_index("sound.finished")
        self._rc5 = self._event_index("rc5")
        self._rules = OwnRules(self._addresses, lambda address: self._inputs.knows(address))
        self._rules_ns = 0
        self._now_ns = 0
        self._event = ""
        self._begun = 0
        self._events: list[EmittedEvent] = []
        self._watched: frozenset[int] = frozenset()
        self._happened: list[str] = []
        self._greeting: GlobalEvent | None = None
        self._notices: list[str] = []
        self._noticed: set[str] = set()
        self._are_periods_new = False
        """Whether somebody else than the program may have changed the periods of timers."""
        self._is_changed = True
        """Whether the program, or somebody else, may have written to the memory since outputs looked at it."""
        self._state = RUNNING
        self._fault: DeviceStatus | None = None
        settings = Settings(options.settings_file)
        self._outputs = Outputs(self.layout, settings, self._rules)
        self.body = Body(
            node_id,
            card=None if options.card is None else Card(options.card),
            settings=settings,
            send=self._outputs.send,
            tell=self._tell,
            recalibrate=self._outputs.tell_motors_again,
        )
        self._meter = Meter()
        self._vm = VirtualMachine(
            self._target,
            native_functions(self._outputs.send, self.body, self._meter),
            node_id,
            on_reset=self._on_reset,
            costs=NO_COSTS if self._queue.policy.kills else COSTS,
        )
        self._inputs = Inputs(self.layout, self._queue.policy.periods_ns, self._vm, self._happen)
        self.load(load_program("", "none", self.layout))

    @property
    def node_id(self) -> int:
        """Number of the robot in its network."""
        return self.body.node_id

    @property
    def is_busy(self) -> bool:
        """Whether something waits for instructions: a handler that goes on, or an event."""
        vm = self._vm
        return (vm.is_active or self._queue.waits or self._are_periods_new) and not vm.is_step_by_step

    @property
    def is_due(self) -> bool:
        """Whether `run` or `take_commands` has anything to do."""
        return self.is_busy or self._is_changed or self._are_rules_due

    @property
    def _are_rules_due(self) -> bool:
        """Whether the robot's own rules look at its variables in this period of theirs still."""
        return not 0 <= self._now_ns - self._rules_ns < PERIOD_NS

    @property
    def status(self) -> DeviceStatus:
        """How the machine is."""
        if self._fault is not None:
            return self._fault
        if not self._vm.is_active:
            return DeviceStatus(self._state)
        return DeviceStatus(self._state, self._event, self._program.line_of(self._vm.pc), pc=self._vm.pc)

    def load(self, program: ThymioProgram, *, warm: bool = False, greeting: EmittedEvent | None = None) -> None:
        """Replace the program; the robot is reset and the next `run` begins with the initialisation.

        A button that is still held is no news. `warm`, as the robot changes its own behaviours: the variables of
        sensors hold, too. `greeting` is an event that the program, if it declares it, hears whenever it has begun.
        """
        if program.layout != self.layout:
            raise ValueError(f"a program for the layout {program.layout} found, expected {self.layout}")
        self._program = program
        self._names = [name for name, _ in program.events]
        self._greeting = None
        if greeting is not None and greeting.name in self._names:
            self._greeting = GlobalEvent(self._names.index(greeting.name), self.node_id, greeting.args)
        self._handled = frozenset(0xFFFE - event.number for event in program.program.events)
        self._inputs.wanted = self._handled | self._watched | {self._rc5}
        self._vm.clear_breakpoints()
        self._debugger = LineDebugger(self._vm, program)
        words = program.program.words
        self._vm.set_bytecode((*words, *[0] * (self._target.bytecode_size - len(words))))
        if warm:
            self._inputs.restore()
        self._run_again()

    def renew(self) -> None:
        """Become a new robot before `load`: unsaved settings and the radio's are forgotten, and what was sensed."""
        self.body.renew()
        self._inputs.forget()

    def feed(self, sensor: str, words: Sequence[int]) -> None:
        """Store a reading's words (int16) and let the events that the program handles wait.

        KeyError: no such sensor; ValueError: wrong number of words.
        """
        self._inputs.feed(sensor, words, self._now_ns)
        if sensor == _SOUND:
            self._rules.hear(words[0])
        elif sensor == _BATTERY:
            self._rules.charge(is_charging=bool(words[-1]))

    def advance(self, now_ns: int) -> None:
        """Simulated time has come so far; `run` raises the events of timers whose period ended on the way."""
        self._queue.advance(now_ns)
        self.body.advance(now_ns, self._vm.variables.words[self._intensity])
        self._now_ns = now_ns

    def run(self, budget: int) -> None:
        """Execute handlers until nothing waits, or so many instructions were executed; natives and events count more.

        Where events end handlers, the reference counts a native as one instruction to decide when: there the charges
        are compared with the budget between handlers.
        """
        if not self.is_busy:
            return
        self._note_writing()
        vm, queue, meter = self._vm, self._queue, self._meter
        turn = queue.policy.turn
        end, charged = vm.instructions + budget, meter.charged
        while self.is_busy and vm.instructions < end and not (queue.policy.kills and meter.charged - charged >= budget):
            if not vm.is_active or (queue.policy.kills and queue.waits and vm.instructions > self._begun):
                self._start_next()
            elif queue.has_incoming and vm.instructions - self._begun >= turn:
                self._start_global(queue.take_incoming())
            vm.run(min(turn, end - vm.instructions))
            if self._listen():
                break  # a robot that restarts takes a while
            if queue.policy.kills and vm.is_active and not queue.waits:
                break  # the rest of a long handler belongs to the next step
        meter.count_run(is_cut=self.is_busy and meter.charged - charged >= budget // 2)
        if not vm.is_active:
            self._notice_periods()

    def hears(self, sender: AsebaDevice) -> bool:
        """Whether the radios of the two are set to the same network."""
        return self.body.network == sender.body.network

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
        if not self._queue.receive(GlobalEvent(self._names.index(name), source, tuple(args))):
            self._meter.count_lost(name)
            self._tell(f"more events arrive than the program can handle: {name} is lost")

    def resume(self) -> None:
        """Let events run (again); a robot that is off is switched on."""
        if self._state == OFF:
            self._restart()
        elif self._debugger.leave_breakpoint():
            self._note_writing()
            self._listen()
            if self._state != FAULT:
                self._run_again()
        else:
            self._run_again()

    def pause(self) -> None:
        """Execute nothing until `step` or `resume`; wheels and lights stay as they are."""
        if self._state != OFF:
            self._vm.pause()
            self._state, self._fault = PAUSED, None

    def step(self) -> None:
        """Execute one instruction; between events, begin the next one that waits."""
        if self._state == OFF:
            return
        self.pause()
        self._start_if_idle()
        self._vm.step()
        self._note_writing()
        self._listen()

    def step_line(self) -> None:
        """Execute up to the next line; between events, stand before the first line of the next event that waits."""
        if self._state == OFF:
            return
        self.pause()
        if self._start_if_idle():
            return
        self._debugger.step_line()
        self._note_writing()
        self._listen()

    def set_breakpoints(self, lines: Sequence[int]) -> Breakpoints:
        """Stop before these lines of the program's file (from 1) and no others; what became of each."""
        return self._debugger.set_breakpoints(lines)

    def stop(self) -> None:
        """Abandon the handler; wheels stand still."""
        if self._state != OFF:
            self._vm.stop()
            self._queue.clear()
            self._halt()
            self._state, self._fault = STOPPED, None

    def reset(self) -> None:
        """As the robot's reset: variables cleared, lights off, ready to begin anew, paused."""
        self._vm.reset()
        self._state, self._fault = PAUSED, None

    def switch_off(self) -> None:
        """Wheels and lights off, nothing runs until `resume`, `reset` or `load`."""
        self._vm.stop()
        self._queue.clear()
        self._halt()
        self.body.stop_recording()
        self._outputs.darken()
        self._outputs.tell(PlaySystemSound(SHUT_DOWN))
        self._state, self._fault = OFF, None

    def take_commands(self) -> list[Command]:
        """What the program and the robot itself told the actuators since the last time.

        First native calls, then what the robot's own rules show, since a program may just have taken them over, then
        changed variables.
        """
        if self._are_rules_due:
            self._rules_ns = self._now_ns - self._now_ns % PERIOD_NS
            if self._state != OFF and (self._inputs.is_news or self._rules.is_moving):
                self._inputs.is_news = False
                self._outputs.tell(*self._rules.look(self._vm.variables.words))
        changes: list[Command] = []
        if self._is_changed:
            self._is_changed = False
            if self._state != OFF:
                changes = self._outputs.take_changes()
        return self._outputs.take(self._now_ns) + changes

    @property
    def has_emitted(self) -> bool:
        """Whether there are events to take."""
        return bool(self._events)

    def take_events(self) -> list[EmittedEvent]:
        """What the program emitted since the last time, in order."""
        events, self._events = self._events, []
        return events

    def watch_events(self, names: Collection[str]) -> None:
        """Remember when these local events happen, whether the program handles them or not."""
        self._watched = frozenset(index for index, event in enumerate(self._target.local_events) if event.name in names)
        self._inputs.wanted = self._handled | self._watched | {self._rc5}

    def take_local_events(self) -> list[str]:
        """Those watched events that happened since the last time, in order."""
        happened, self._happened = self._happened, []
        return happened

    def take_load(self) -> Load:
        """How much the program asked of the robot since the last time."""
        return self._meter.take()

    def take_notices(self) -> list[str]:
        """What the user should know, each thing once."""
        notices, self._notices = self._notices, []
        return notices

    def variables(self) -> dict[str, tuple[int, int]]:
        """Address and size of every variable, those of the program included."""
        return self._addresses | self._program.program.addresses

    def memory(self) -> list[int]:
        """Words of all variables, one after the other in order of address."""
        return list(self._vm.variables.words[: self._program.program.allocated])

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
        self._note_writing()
        self._are_periods_new = True

    def _note_writing(self) -> None:
        """The program, or somebody else, may have written to the memory."""
        self._is_changed = True
        self._inputs.note_writing()

    def _happen(self, index: int) -> None:
        """A reading raises a local event."""
        if index == self._rc5:
            self._rules.flash_remote()
        if index == self._sound_finished and not self._outputs.has_used_sound:
            return
        if index in self._handled:
            self._queue.arrive(index)
        if index in self._watched:
            self._happened.append(self._target.local_events[index].name)

    def _start_if_idle(self) -> bool:
        """Start the next event if none is being handled; whether one was started."""
        if self._vm.is_active:
            return False
        while not self._vm.is_active and self._queue.waits:
            self._start_next()
        return self._vm.is_active

    def _run_again(self) -> None:
        self._vm.resume()
        self._state, self._fault = RUNNING, None
        self._are_periods_new = True

    def _restart(self) -> None:
        """As after a switch off and on: unsaved settings are lost, the program begins anew."""
        self.body.settings.restart()
        self._vm.reset()
        self._run_again()

    def _start_next(self) -> None:
        """Start the next event, if there is one."""
        if not self._vm.is_active:
            self._notice_periods()
        event = self._queue.take()
        if isinstance(event, GlobalEvent):
            self._start_global(event)
        elif event is not None:
            self._begin(self._target.local_events[event].name)
            if event in self._watched and event in self._timer_events:
                self._happened.append(self._event)
            self._vm.receive(0xFFFE - event, self.node_id, ())

    def _start_global(self, event: GlobalEvent) -> None:
        self._begin(self._names[event.number])
        self._vm.receive(event.number, event.source, event.args)

    def _begin(self, event: str) -> None:
        if self._queue.policy.kills and self._vm.is_active:
            self._tell(f"{event} cuts off {self._event}, which takes more than {self._queue.policy.turn} instructions")
        self._event, self._begun = event, self._vm.instructions

    def _event_index(self, name: str) -> int:
        return 0xFFFE - self._target.local_event_number(name)

    def _listen(self) -> bool:
        """Take what the machine has said; whether the robot began anew or was switched off by it."""
        for message in self._vm.pop_messages():
            if isinstance(message, Emitted):
                if message.number < len(self._names):
                    self._meter.count_event(self._names[message.number], len(message.arguments))
                    self._events.append(EmittedEvent(self._names[message.number], message.arguments))
            elif isinstance(message, OutOfBounds | DivisionByZero | NodeSpecific | BadCode) and not self.body.wanted:
                line = self._program.line_of(message.pc)
                self._state = FAULT
                told = {language: message.message_in(language) for language in LANGUAGES}
                self._fault = DeviceStatus(FAULT, self._event, line, message.message, message.pc, told)
                self._queue.clear()
                self._halt()
        if self._state == RUNNING and self._vm.is_step_by_step:
            self._state = PAUSED  # at a breakpoint
        wanted, self.body.wanted = self.body.wanted, ""
        if wanted == RESTART:
            self._restart()
        elif wanted:
            self.switch_off()
        return bool(wanted)

    def _halt(self) -> None:
        for name in ("motor.left.target", "motor.right.target"):
            self.set_variable(name, (0,))

    def _tell(self, notice: str) -> None:
        if notice not in self._noticed and len(self._noticed) < MOST_NOTICES:
            self._noticed.add(notice)
            self._notices.append(notice)

    def _notice_periods(self) -> None:
        address, size = self._periods
        self._queue.notice(list(self._vm.variables.words[address : address + size]))
        self._are_periods_new = False

    def _on_reset(self, vm: VirtualMachine) -> None:
        """The robot's share in a reset (docs/spec/thymio-robot.md section 4)."""
        vm.variables[:] = [0] * len(vm.variables)
        vm.node_id = self.node_id
        has_card = int(self.body.card is not None)
        own = {"_id": (self.node_id,), "event.source": (self.node_id,), "sd.present": (has_card,)}
        for name, words in (own | dict(self._first_values)).items():
            vm.write_variables(self._addresses[name][0], words)
        self._is_changed = True
        self._inputs.note_clearing()
        vm.random_state = (self.node_id - 1) * 25173 & 0xFFFF  # robots differ, a run repeats itself
        self._event, self._begun = INIT, vm.instructions
        self._queue.reset()
        if self._greeting is not None:
            self._queue.receive(self._greeting)
        self._rules.reset()
        self._outputs.reset(vm)
        self.body.reset()
