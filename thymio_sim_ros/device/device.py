"""The Aseba side of a robot: a machine with readings as input and commands and events as output.

An `EventQueue` decides the order of events. In addition, a global event ends a handler that has used up its budget of
instructions (docs/spec/aseba-bytecode-vm.md section 10.5). The firmware works beside the program: indicators on the
lights, button sounds, card, settings and radio. A reset clears all variables and switches the lights off.
"""

from __future__ import annotations

from collections.abc import Collection, Sequence
from dataclasses import dataclass

from aseba_vm import VirtualMachine
from aseba_vm.languages import LANGUAGES
from aseba_vm.machine.costs import NO_COSTS
from aseba_vm.machine.machine_messages import BadCode, DivisionByZero, Emitted, NodeSpecific, OutOfBounds
from thymio_sim_ros.device.costs import COSTS
from thymio_sim_ros.device.events import POLICIES, EventQueue, GlobalEvent
from thymio_sim_ros.device.firmware.indicators import PERIOD_NS, Indicators
from thymio_sim_ros.device.firmware.sd_card import SdCard
from thymio_sim_ros.device.firmware.services import RESTART, FirmwareServices
from thymio_sim_ros.device.firmware.settings import Settings
from thymio_sim_ros.device.inputs import Inputs
from thymio_sim_ros.device.layout import LAYOUTS, target
from thymio_sim_ros.device.natives import native_functions
from thymio_sim_ros.device.options import DEFAULTS, DeviceOptions
from thymio_sim_ros.device.outputs import Outputs
from thymio_sim_ros.device.programs.breakpoints import Breakpoints, LineDebugger
from thymio_sim_ros.device.programs.load import Load, LoadMeter
from thymio_sim_ros.device.programs.program import ThymioProgram, load_program
from thymio_sim_ros.device.programs.status import FAULT, INIT, OFF, PAUSED, RUNNING, STOPPED, DeviceStatus
from thymio_sim_ros.sim.audio.synthesis import SHUT_DOWN
from thymio_sim_ros.sim.commands import Command, PlaySystemSound

__all__ = ["AsebaDevice", "DeviceStatus", "EmittedEvent"]

_SOUND, _BATTERY = "sound", "battery"
"""Sensors used by the firmware: the first word of one is `mic.intensity`, the last of the other is 1 while charging."""
FAULTS = (OutOfBounds, DivisionByZero, NodeSpecific, BadCode)
"""Messages of the machine that end the program."""
INT16 = range(-0x8000, 0x8000)
MAX_NOTICES = 50
"""Limit of different notices of a device, since a program can cause any number of them."""


@dataclass(frozen=True, slots=True)
class EmittedEvent:
    """A global event emitted by the program."""

    name: str
    args: tuple[int, ...]


class AsebaDevice:
    """The machine of one robot with its variables. Invariant: instructions are executed only during calls."""

    def __init__(self, *, node_id: int = 1, options: DeviceOptions = DEFAULTS) -> None:
        """SdCardError or SettingsError when a folder of the options cannot be used."""
        self.layout = options.layout
        self._target = target(self.layout)
        self._addresses = self._target.addresses
        self._initial_values = LAYOUTS[self.layout].initial_values
        self._timer_events = tuple(map(self._event_index, ("timer0", "timer1")))
        self._queue = EventQueue(POLICIES[options.events], self._timer_events)
        self._periods = self._addresses["timer.period"]
        self._intensity = self._addresses["mic.intensity"][0]
        self._sound_finished = self._event_index("sound.finished")
        self._rc5 = self._event_index("rc5")
        self._indicators = Indicators(self._addresses, lambda address: self._inputs.is_measured(address))
        self._indicators_ns = 0
        self._now_ns = 0
        self._event = ""
        self._handler_start = 0
        self._events: list[EmittedEvent] = []
        self._watched: frozenset[int] = frozenset()
        self._local_events: list[str] = []
        self._initial_event: GlobalEvent | None = None
        self._notices: list[str] = []
        self._noticed: set[str] = set()
        self._are_periods_changed = False
        """Whether the periods of timers may have been changed from outside the program."""
        self._is_changed = True
        """Whether the memory may have been written since the outputs were last compared."""
        self._state = RUNNING
        self._fault: DeviceStatus | None = None
        settings = Settings(options.settings_file)
        self._outputs = Outputs(self.layout, settings, self._indicators)
        self.services = FirmwareServices(
            node_id,
            card=None if options.card is None else SdCard(options.card),
            settings=settings,
            send=self._outputs.send,
            notify=self._notify,
            recalibrate=self._outputs.resend_motor_targets,
        )
        self._meter = LoadMeter()
        self._vm = VirtualMachine(
            self._target,
            native_functions(self._outputs.send, self.services, self._meter),
            node_id,
            on_reset=self._on_reset,
            costs=NO_COSTS if self._queue.policy.interrupts else COSTS,
        )
        self._inputs = Inputs(self.layout, self._queue.policy.periods_ns, self._vm, self._raise_local_event)
        self.load(load_program("", "none", self.layout))

    @property
    def node_id(self) -> int:
        """Number of the robot on its network."""
        return self.services.node_id

    @property
    def is_busy(self) -> bool:
        """Whether `run` has work: an unfinished handler or a pending event."""
        vm = self._vm
        return (vm.is_active or self._queue.has_events or self._are_periods_changed) and not vm.is_step_by_step

    @property
    def is_due(self) -> bool:
        """Whether `run` or `pop_commands` has anything to do."""
        return self.is_busy or self._is_changed or self._is_indicator_update_due

    @property
    def _is_indicator_update_due(self) -> bool:
        """Whether the indicators have not been updated in the current period."""
        return not 0 <= self._now_ns - self._indicators_ns < PERIOD_NS

    @property
    def status(self) -> DeviceStatus:
        """State of the machine."""
        if self._fault is not None:
            return self._fault
        if not self._vm.is_active:
            return DeviceStatus(self._state)
        return DeviceStatus(self._state, self._event, self._program.line_of(self._vm.pc), pc=self._vm.pc)

    def load(self, program: ThymioProgram, *, warm: bool = False, initial_event: EmittedEvent | None = None) -> None:
        """Replace the program and reset the robot; the next `run` starts with the initialization.

        A button that is still held causes no event. With `warm`, as when the firmware changes its behavior, the
        variables of sensors keep their values. `initial_event` is sent to the program after each start if it declares
        that event. Raises ValueError for a program of another layout.
        """
        if program.layout != self.layout:
            raise ValueError(f"a program for the layout {program.layout} found, expected {self.layout}")
        self._program = program
        self._names = [name for name, _ in program.events]
        self._initial_event = None
        if initial_event is not None and initial_event.name in self._names:
            self._initial_event = GlobalEvent(self._names.index(initial_event.name), self.node_id, initial_event.args)
        self._handled = frozenset(0xFFFE - event.number for event in program.program.events)
        self._inputs.wanted = self._handled | self._watched | {self._rc5}
        self._vm.clear_breakpoints()
        self._debugger = LineDebugger(self._vm, program)
        words = program.program.words
        self._vm.set_bytecode((*words, *[0] * (self._target.bytecode_size - len(words))))
        if warm:
            self._inputs.restore()
        self._resume()

    def reinitialize(self) -> None:
        """Return to the state of a new robot, to be called before `load`: drop unsaved settings, radio and readings."""
        self.services.reinitialize()
        self._inputs.clear()

    def feed(self, sensor: str, words: Sequence[int]) -> None:
        """Store the words of a reading (int16) and queue the events that it causes.

        Raises KeyError for an unknown sensor and ValueError for a wrong number of words.
        """
        self._inputs.feed(sensor, words, self._now_ns)
        if sensor == _SOUND:
            self._indicators.record_intensity(words[0])
        elif sensor == _BATTERY:
            self._indicators.set_charging(is_charging=bool(words[-1]))

    def advance(self, now_ns: int) -> None:
        """Advance simulated time; the next `run` handles the timer events that are due."""
        self._queue.advance(now_ns)
        self.services.advance(now_ns, self._vm.variables.words[self._intensity])
        self._now_ns = now_ns

    def run(self, budget: int) -> None:
        """Execute handlers until no event is pending or the budget of instructions is used up.

        Native calls and events count as several instructions (`costs`). With a policy that interrupts handlers, the
        reference counts a native call as one instruction to decide when; there the extra costs are compared with the
        budget only between handlers.
        """
        if not self.is_busy:
            return
        self._mark_memory_changed()
        vm, queue, meter = self._vm, self._queue, self._meter
        handler_budget = queue.policy.handler_budget
        end, charged = vm.instructions + budget, meter.charged
        while (
            self.is_busy
            and vm.instructions < end
            and not (queue.policy.interrupts and meter.charged - charged >= budget)
        ):
            if not vm.is_active or (
                queue.policy.interrupts and queue.has_events and vm.instructions > self._handler_start
            ):
                self._start_next()
            elif queue.has_global and vm.instructions - self._handler_start >= handler_budget:
                self._start_global(queue.pop_global())
            vm.run(min(handler_budget, end - vm.instructions))
            if self._process_messages():
                break  # a robot that restarts takes a while
            if queue.policy.interrupts and vm.is_active and not queue.has_events:
                break  # the rest of a long handler belongs to the next step
        meter.count_run(is_cut=self.is_busy and meter.charged - charged >= budget // 2)
        if not vm.is_active:
            self._update_timer_periods()

    def receives_from(self, sender: AsebaDevice) -> bool:
        """Whether the radios of both devices are set to the same network."""
        return self.services.network == sender.services.network

    def declares(self, event: str) -> bool:
        """Whether the program declares a global event of this name."""
        return event in self._names

    def receive_event(self, name: str, args: Sequence[int], *, source: int = 0) -> None:
        """Queue a global event for `run`; a machine that is not running ignores it.

        Raises KeyError if the program does not declare the event.
        """
        if name not in self._names:
            raise KeyError(name)
        if self._vm.is_step_by_step and (self._vm.is_active or self._state != PAUSED):
            return
        if not self._queue.add_global(GlobalEvent(self._names.index(name), source, tuple(args))):
            self._meter.count_lost(name)
            self._notify(f"more events arrive than the program can handle: {name} is lost")

    def resume(self) -> None:
        """Continue execution; switch the robot on if it is off."""
        if self._state == OFF:
            self._restart()
        elif self._debugger.leave_breakpoint():
            self._mark_memory_changed()
            self._process_messages()
            if self._state != FAULT:
                self._resume()
        else:
            self._resume()

    def pause(self) -> None:
        """Stop execution until `step` or `resume`; wheels and lights keep their state."""
        if self._state != OFF:
            self._vm.pause()
            self._state, self._fault = PAUSED, None

    def step(self) -> None:
        """Execute one instruction; between events, start the next pending event."""
        if self._state == OFF:
            return
        self.pause()
        self._start_if_idle()
        self._vm.step()
        self._mark_memory_changed()
        self._process_messages()

    def step_line(self) -> None:
        """Execute up to the next line; between events, stop before the first line of the next pending event."""
        if self._state == OFF:
            return
        self.pause()
        if self._start_if_idle():
            return
        self._debugger.step_line()
        self._mark_memory_changed()
        self._process_messages()

    def set_breakpoints(self, lines: Sequence[int]) -> Breakpoints:
        """Replace all breakpoints: lines of the program's file, from 1. Returns the lines where they were set."""
        return self._debugger.set_breakpoints(lines)

    def stop(self) -> None:
        """Abort the handler and stop the wheels."""
        if self._state != OFF:
            self._vm.stop()
            self._queue.clear()
            self._stop_motors()
            self._state, self._fault = STOPPED, None

    def reset(self) -> None:
        """Reset the robot: clear the variables, switch the lights off, and pause before the start of the program."""
        self._vm.reset()
        self._state, self._fault = PAUSED, None

    def switch_off(self) -> None:
        """Switch wheels and lights off; nothing is executed until `resume`, `reset` or `load`."""
        self._vm.stop()
        self._queue.clear()
        self._stop_motors()
        self.services.stop_recording()
        self._outputs.switch_off_lights()
        self._outputs.queue(PlaySystemSound(SHUT_DOWN))
        self._state, self._fault = OFF, None

    def pop_commands(self) -> list[Command]:
        """Return and clear the commands for the actuators.

        The order is: native calls; indicators of the firmware, because a native call may just have taken over their
        lights; changed variables.
        """
        if self._is_indicator_update_due:
            self._indicators_ns = self._now_ns - self._now_ns % PERIOD_NS
            if self._state != OFF and (self._inputs.is_memory_changed or self._indicators.is_animated):
                self._inputs.is_memory_changed = False
                self._outputs.queue(*self._indicators.update(self._vm.variables.words))
        changes: list[Command] = []
        if self._is_changed:
            self._is_changed = False
            if self._state != OFF:
                changes = self._outputs.pop_changes()
        return self._outputs.pop(self._now_ns) + changes

    @property
    def has_emitted(self) -> bool:
        """Whether `pop_events` would return events."""
        return bool(self._events)

    def pop_events(self) -> list[EmittedEvent]:
        """Return and clear the emitted events, in order."""
        events, self._events = self._events, []
        return events

    def watch_events(self, names: Collection[str]) -> None:
        """Select the local events that `pop_local_events` returns, whether or not the program handles them."""
        self._watched = frozenset(index for index, event in enumerate(self._target.local_events) if event.name in names)
        self._inputs.wanted = self._handled | self._watched | {self._rc5}

    def pop_local_events(self) -> list[str]:
        """Return and clear the watched local events that occurred, in order."""
        happened, self._local_events = self._local_events, []
        return happened

    def pop_load(self) -> Load:
        """Return and clear the counts of native calls and events."""
        return self._meter.pop()

    def pop_notices(self) -> list[str]:
        """Return and clear the notices for the user; each text occurs once."""
        notices, self._notices = self._notices, []
        return notices

    def variables(self) -> dict[str, tuple[int, int]]:
        """Address and size of every variable, including those of the program."""
        return self._addresses | self._program.program.addresses

    def memory(self) -> list[int]:
        """Words of all variables in order of address."""
        return list(self._vm.variables.words[: self._program.program.allocated])

    def get_variable(self, name: str) -> tuple[int, ...]:
        """Words of a variable. Raises KeyError for an unknown name."""
        address, size = self.variables()[name]
        return tuple(self._vm.variables[address : address + size])

    def set_variable(self, name: str, words: Sequence[int]) -> None:
        """Write a whole variable. Raises KeyError for an unknown name, ValueError for a wrong size or value."""
        address, size = self.variables()[name]
        if len(words) != size:
            raise ValueError(f"{name}: {len(words)} words found, expected {size}")
        wrong = [word for word in words if word not in INT16]
        if wrong:
            raise ValueError(f"{name}: {wrong[0]} found, expected -32768 to 32767")
        self._vm.write_variables(address, words)
        self._mark_memory_changed()
        self._are_periods_changed = True

    def _mark_memory_changed(self) -> None:
        """Note that the memory may have been written."""
        self._is_changed = True
        self._inputs.mark_changed()

    def _raise_local_event(self, index: int) -> None:
        """Handle a local event caused by a reading."""
        if index == self._rc5:
            self._indicators.flash_remote()
        if index == self._sound_finished and not self._outputs.has_used_sound:
            return
        if index in self._handled:
            self._queue.add_local(index)
        if index in self._watched:
            self._local_events.append(self._target.local_events[index].name)

    def _start_if_idle(self) -> bool:
        """Start the next event if no handler is active; return whether one was started."""
        if self._vm.is_active:
            return False
        while not self._vm.is_active and self._queue.has_events:
            self._start_next()
        return self._vm.is_active

    def _resume(self) -> None:
        self._vm.resume()
        self._state, self._fault = RUNNING, None
        self._are_periods_changed = True

    def _restart(self) -> None:
        """Restart as after switching off and on: drop unsaved settings and start the program again."""
        self.services.settings.restart()
        self._vm.reset()
        self._resume()

    def _start_next(self) -> None:
        """Start the handler of the next event, if any."""
        if not self._vm.is_active:
            self._update_timer_periods()
        event = self._queue.pop()
        if isinstance(event, GlobalEvent):
            self._start_global(event)
        elif event is not None:
            self._begin_handler(self._target.local_events[event].name)
            if event in self._watched and event in self._timer_events:
                self._local_events.append(self._event)
            self._vm.receive(0xFFFE - event, self.node_id, ())

    def _start_global(self, event: GlobalEvent) -> None:
        self._begin_handler(self._names[event.number])
        self._vm.receive(event.number, event.source, event.args)

    def _begin_handler(self, event: str) -> None:
        if self._queue.policy.interrupts and self._vm.is_active:
            budget = self._queue.policy.handler_budget
            self._notify(f"{event} cuts off {self._event}, which takes more than {budget} instructions")
        self._event, self._handler_start = event, self._vm.instructions

    def _event_index(self, name: str) -> int:
        return 0xFFFE - self._target.local_event_number(name)

    def _process_messages(self) -> bool:
        """Process the messages of the machine; return whether they restarted the robot or switched it off."""
        for message in self._vm.pop_messages():
            if isinstance(message, Emitted):
                if message.number < len(self._names):
                    self._meter.count_event(self._names[message.number], len(message.arguments))
                    self._events.append(EmittedEvent(self._names[message.number], message.arguments))
            elif (
                isinstance(message, OutOfBounds | DivisionByZero | NodeSpecific | BadCode)
                and not self.services.requested
            ):
                line = self._program.line_of(message.pc)
                self._state = FAULT
                translations = {language: message.message_in(language) for language in LANGUAGES}
                self._fault = DeviceStatus(FAULT, self._event, line, message.message, message.pc, translations)
                self._queue.clear()
                self._stop_motors()
        if self._state == RUNNING and self._vm.is_step_by_step:
            self._state = PAUSED  # at a breakpoint
        wanted, self.services.requested = self.services.requested, ""
        if wanted == RESTART:
            self._restart()
        elif wanted:
            self.switch_off()
        return bool(wanted)

    def _stop_motors(self) -> None:
        for name in ("motor.left.target", "motor.right.target"):
            self.set_variable(name, (0,))

    def _notify(self, notice: str) -> None:
        if notice not in self._noticed and len(self._noticed) < MAX_NOTICES:
            self._noticed.add(notice)
            self._notices.append(notice)

    def _update_timer_periods(self) -> None:
        address, size = self._periods
        self._queue.set_timer_periods(list(self._vm.variables.words[address : address + size]))
        self._are_periods_changed = False

    def _on_reset(self, vm: VirtualMachine) -> None:
        """Set the robot's variables after a reset of the machine (docs/spec/thymio-robot.md section 4)."""
        vm.variables[:] = [0] * len(vm.variables)
        vm.node_id = self.node_id
        has_card = int(self.services.card is not None)
        own = {"_id": (self.node_id,), "event.source": (self.node_id,), "sd.present": (has_card,)}
        for name, words in (own | dict(self._initial_values)).items():
            vm.write_variables(self._addresses[name][0], words)
        self._is_changed = True
        self._inputs.mark_cleared()
        vm.random_state = (self.node_id - 1) * 25173 & 0xFFFF  # differs between robots, repeatable between runs
        self._event, self._handler_start = INIT, vm.instructions
        self._queue.reset()
        if self._initial_event is not None:
            self._queue.add_global(self._initial_event)
        self._indicators.reset()
        self._outputs.reset(vm)
        self.services.reset()
