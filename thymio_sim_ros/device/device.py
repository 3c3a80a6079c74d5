"""The Aseba side of a robot: a machine with readings and events as input, and commands and events as output.

`AsebaDevice` connects the parts and has what a loop over robots calls in each tick: inputs, `run`, outputs. The parts
have one concern each: `DeviceVariables` the memory by name, `HandlerScheduler` the order and length of handlers,
`RunControl` state, steps and faults, `LocalEvents` and `NetworkEvents` the events, `Inputs` and `Outputs` the way
between the memory and the robot. The firmware works beside the program: indicators on the lights, button sounds, card,
settings and radio. A reset clears all variables and switches the lights off.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable, Sequence

from aseba_vm import VirtualMachine
from aseba_vm.machine.costs import NO_COSTS
from thymio_sim_ros.device.costs import COSTS
from thymio_sim_ros.device.due_time import DueTime
from thymio_sim_ros.device.event_queue import POLICIES, EventQueue, GlobalEvent
from thymio_sim_ros.device.firmware.indicators import PERIOD_NS, Indicators
from thymio_sim_ros.device.firmware.sd_card import SdCard
from thymio_sim_ros.device.firmware.services import FirmwareServices
from thymio_sim_ros.device.firmware.settings import Settings
from thymio_sim_ros.device.handler_scheduler import HandlerScheduler
from thymio_sim_ros.device.inputs import Inputs
from thymio_sim_ros.device.layout import LAYOUTS, target
from thymio_sim_ros.device.local_events import FIRST_LOCAL_EVENT, LocalEvents
from thymio_sim_ros.device.natives import native_functions
from thymio_sim_ros.device.network_events import EmittedEvent, NetworkEvents
from thymio_sim_ros.device.notices import Notices
from thymio_sim_ros.device.options import DEFAULTS, DeviceOptions
from thymio_sim_ros.device.outputs import Outputs
from thymio_sim_ros.device.programs.load import LoadMeter
from thymio_sim_ros.device.programs.program import ThymioProgram, load_program
from thymio_sim_ros.device.programs.status import DeviceStatus
from thymio_sim_ros.device.run_control import RunControl
from thymio_sim_ros.device.variables import DeviceVariables
from thymio_sim_ros.sim.commands import Command
from thymio_sim_ros.sim.model.clock import NEVER_NS, TICK_NS

__all__ = ["AsebaDevice"]

_SOUND, _BATTERY = "sound", "battery"
"""Sensors used by the firmware: the first word of one is `mic.intensity`, the last of the other is 1 while charging."""


class AsebaDevice:
    """The machine of one robot with its variables. Invariant: instructions are executed only during calls."""

    def __init__(self, *, node_id: int = 1, options: DeviceOptions = DEFAULTS) -> None:
        """Create a device that runs an empty program.

        Raises SdCardError or SettingsError if a folder of the options cannot be used.
        """
        self.layout = options.layout
        """Name of the memory layout."""
        described = target(self.layout)
        self.due = due = DueTime()
        """The time from which `run` or `pop_commands` has anything to do, if the device is left alone until then."""
        queue = EventQueue(
            POLICIES[options.events],
            [FIRST_LOCAL_EVENT - described.local_event_number(name) for name in ("timer0", "timer1")],
            due,
        )
        self.notices = Notices()
        """Messages for the user."""
        self.load_meter = LoadMeter()
        """Counts of native calls and events."""
        settings = Settings(options.settings_file)
        indicators = Indicators(described.addresses)
        outputs = Outputs(self.layout, settings, indicators)
        self.services = FirmwareServices(
            node_id,
            card=None if options.card is None else SdCard(options.card),
            settings=settings,
            send=outputs.send,
            notify=self.notices.add,
            recalibrate=outputs.resend_motor_targets,
        )
        vm = VirtualMachine(
            described,
            native_functions(outputs.send, self.services, self.load_meter),
            node_id,
            on_reset=self._on_reset,
            costs=NO_COSTS if queue.policy.interrupts else COSTS,
        )
        network_events = NetworkEvents(self.load_meter)
        self.variables = DeviceVariables(vm, due)
        """The variables by name."""
        self.local_events = LocalEvents(described, queue, indicators, outputs)
        """The local events that a user watches."""
        scheduler = HandlerScheduler(
            vm, queue, self.variables, self.local_events, network_events, self.services, self.load_meter, due
        )
        program = load_program("", "none", self.layout)
        self.run_control = RunControl(
            vm, program, queue, scheduler, network_events, self.variables, self.services, outputs
        )
        """Run, pause, step, stop, reset, power."""
        self._vm, self._queue, self._network_events, self._scheduler = vm, queue, network_events, scheduler
        self._indicators, self._outputs = indicators, outputs
        self._inputs = Inputs(self.layout, queue.policy.periods_ns, vm, self.variables, self.local_events)
        self._intensity, _ = described.addresses["mic.intensity"]
        self._initial_event: GlobalEvent | None = None
        self._indicated_sensors = self._inputs.sensors_of(indicators.addresses)
        self._now_ns = 0
        self._indicators_ns = 0
        """Time of the next update of the indicators; NEVER_NS while nothing has changed that they show."""
        self._indicators_free_ns = 0
        """Time from which they may be updated again: once per period."""
        self._sent_writes: int | None = None
        """Number of writes when variables were last compared with the commands sent."""
        self.load(program)

    @property
    def node_id(self) -> int:
        """Number of the robot on its network."""
        return self.services.node_id

    @property
    def radio(self) -> tuple[int, int]:
        """Channel and network of the radio: robots receive events of their own network only."""
        return self.services.network

    @property
    def status(self) -> DeviceStatus:
        """State of the machine."""
        return self.run_control.status

    @property
    def is_busy(self) -> bool:
        """Whether `run` has work: an unfinished handler or a pending event."""
        return self._scheduler.is_busy

    @property
    def is_due(self) -> bool:
        """Whether `run` or `pop_commands` has anything to do."""
        return self.due.ns <= self._now_ns

    @property
    def has_emitted(self) -> bool:
        """Whether `pop_events` would return events."""
        return self._network_events.has_emitted

    def load(self, program: ThymioProgram, *, warm: bool = False, initial_event: EmittedEvent | None = None) -> None:
        """Replace the program and reset the robot; the next `run` starts with the initialization.

        A button that is still held causes no event. With `warm`, as when the firmware changes its behavior, the
        variables of sensors keep their values. `initial_event` is sent to the program after each start if it declares
        that event. Raises ValueError for a program of another layout.
        """
        if program.layout != self.layout:
            raise ValueError(f"a program for the layout {program.layout} found, expected {self.layout}")
        self.adopt(program)
        if initial_event is not None and self.declares(initial_event.name):
            self._initial_event = self._network_events.encode(initial_event.name, initial_event.args, self.node_id)
        self.run_control.clear_breakpoints()
        words = program.program.words
        self._vm.set_bytecode((*words, *[0] * (self._vm.target.bytecode_size - len(words))))
        if warm:
            self._inputs.restore()
        self.run_control.start()

    def adopt(self, program: ThymioProgram) -> None:
        """Note that the bytecode in the memory is that of `program`: its names and lines apply from now on."""
        for part in (self._network_events, self.local_events, self.variables, self.run_control):
            part.set_program(program)
        self._initial_event = None

    def write_bytecode(self, words: Sequence[int], start: int) -> None:
        """Write words of bytecode, which must fit, and reset the robot; nothing runs until it is resumed.

        `adopt` follows with the program that the memory then contains.
        """
        self._initial_event = None
        self.run_control.write_bytecode(words, start)

    @property
    def bytecode(self) -> tuple[int, ...]:
        """The bytecode memory, unsigned words."""
        return self._vm.bytecode

    def reinitialize(self) -> None:
        """Return to the state of a new robot, to be called before `load`: drop unsaved settings, radio and readings."""
        self.services.reinitialize()
        self._inputs.clear()

    def feed(self, sensor: str, words: Sequence[int], now_ns: int | None = None) -> None:
        """Store the words of a reading (int16) and queue the events that it causes.

        `now_ns` is its time; None: that of the last `advance`. Raises KeyError for an unknown sensor and ValueError for
        a wrong number of words.
        """
        now_ns = self._now_ns if now_ns is None else now_ns
        has_changed = self._inputs.feed(sensor, words, now_ns)
        if sensor == _SOUND:
            self._indicators.record_intensity(words[0])
        elif sensor == _BATTERY:
            self._indicators.set_charging(is_charging=bool(words[-1]))
        address = self._indicated_sensors.get(sensor) if has_changed else None
        if self._indicators.is_animated or (address is not None and self._indicators.is_outdated(address, words)):
            self._plan_indicators(now_ns)

    def wants_event(self, sensor: str) -> bool:
        """Whether the event of a sensor has a receiver. Raises KeyError for an unknown sensor."""
        return self._inputs.wants_event(sensor)

    def measure_on_read(
        self, sensors: Collection[str], measure: Callable[[], Iterable[tuple[str, Sequence[int]]]]
    ) -> None:
        """Store the readings of `measure` whenever variables may be read.

        `measure` returns (sensor, words) for those of `sensors` that are not fed. It causes no events.
        """

        def store() -> None:
            for sensor, words in measure():
                self._inputs.store(sensor, words)

        self.variables.measure_on_read(self._inputs.addresses_of(sensors), store)

    def declares(self, event: str) -> bool:
        """Whether the program declares a global event of this name."""
        return self._network_events.declares(event)

    def receive_event(self, name: str, args: Sequence[int], *, source: int = 0) -> None:
        """Queue a global event for `run`; a machine that is not running ignores it.

        Raises KeyError if the program does not declare the event.
        """
        self._queue_global(self._network_events.encode(name, args, source), name)

    def receive_number(self, number: int, args: Sequence[int], *, source: int) -> None:
        """Queue the global event with a number instead of a name, as `receive_event` does."""
        event = GlobalEvent(number, source, tuple(args))
        self._queue_global(event, self._network_events.name_of(event))

    def advance(self, now_ns: int) -> None:
        """Advance simulated time; the next `run` handles the timer events that are due."""
        before_ns = now_ns - TICK_NS
        if self._scheduler.has_stale_periods and self._now_ns < before_ns < self._queue.next_timer_ns:
            self._queue.advance(before_ns)  # a timer whose period was changed since counts from then
        if now_ns < self._now_ns:
            self._indicators_ns = self._indicators_free_ns = 0
            self.due.set_now()
        self._queue.advance(now_ns)
        self._outputs.advance(now_ns)
        self.services.advance(now_ns, self._vm.variables.words[self._intensity])
        self._now_ns = now_ns

    def run(self, budget: int) -> int:
        """Execute handlers until no event is pending or the budget of instructions is used up.

        Native calls and events count as several instructions (`costs`). Returns the number of instructions.
        """
        before = self._vm.instructions
        self._scheduler.run(budget, self.run_control.process_messages)
        self.run_control.prepare_event()
        return self._vm.instructions - before

    def pop_commands(self) -> list[Command]:
        """Return and clear the commands for the actuators.

        The order is: native calls; indicators of the firmware, because a native call may just have taken over their
        lights; changed variables.
        """
        is_off, writes, now_ns = self.run_control.is_off, self.variables.writes, self._now_ns
        are_written = self._sent_writes != writes
        if are_written:
            self._plan_indicators(now_ns)
        if self._indicators_ns <= now_ns:
            self._indicators_ns = NEVER_NS
            if not is_off:
                self._outputs.queue(*self._indicators.update(self._vm.variables.words, self._inputs.is_measured))
        self.end_tick(now_ns)
        if self._indicators.is_animated and not is_off:
            self._plan_indicators(now_ns)
        changed: list[Command] = []
        if are_written:
            self._sent_writes = writes
            if not is_off:
                changed = self._outputs.pop_changes()
        self.due.ns = self._next_due_ns()
        return self._outputs.pop() + changed

    def end_tick(self, now_ns: int) -> None:
        """Note that all that was due at this time is done."""
        self._indicators_free_ns = now_ns - now_ns % PERIOD_NS + PERIOD_NS

    def pop_events(self) -> list[EmittedEvent]:
        """Return and clear the emitted events, in order."""
        return self._network_events.pop()

    def _queue_global(self, event: GlobalEvent, name: str) -> None:
        if self.run_control.accepts_events and not self._queue.add_global(event):
            self.load_meter.count_lost(name)
            self.notices.add(f"more events arrive than the program can handle: {name} is lost")

    def _plan_indicators(self, now_ns: int) -> None:
        """Update the indicators at the next multiple of their period."""
        if self._indicators_ns > now_ns:
            self._indicators_ns = max(-(-now_ns // PERIOD_NS) * PERIOD_NS, self._indicators_free_ns)
            self.due.bring_forward(self._indicators_ns)

    def _next_due_ns(self) -> int:
        if self.is_busy or self.services.is_recording:
            return 0
        return min(self._indicators_ns, self._queue.next_timer_ns)

    def _on_reset(self, vm: VirtualMachine) -> None:
        """Set the robot's variables after a reset of the machine (docs/spec/thymio-robot.md section 4)."""
        vm.node_id = self.node_id
        has_card = int(self.services.card is not None)
        own = {"_id": (self.node_id,), "event.source": (self.node_id,), "sd.present": (has_card,)}
        self.variables.clear({**own, **LAYOUTS[self.layout].initial_values})
        vm.random_state = (self.node_id - 1) * 25173 & 0xFFFF  # differs between robots, repeatable between runs
        self._scheduler.reset()
        if self._initial_event is not None:
            self._queue.add_global(self._initial_event)
        self._indicators.reset()
        self._outputs.reset(vm)
        self.services.reset()
