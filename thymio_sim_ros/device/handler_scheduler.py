"""Starts the handlers of pending events and executes them within a budget of instructions.

An `EventQueue` decides the order of events. In addition, a global event ends a handler that has used up the budget of
its policy (docs/spec/aseba-bytecode-vm.md section 10.5).
"""

from __future__ import annotations

from collections.abc import Callable

from aseba_vm import VirtualMachine
from thymio_sim_ros.device.due_time import DueTime
from thymio_sim_ros.device.event_queue import EventQueue, GlobalEvent
from thymio_sim_ros.device.firmware.services import FirmwareServices
from thymio_sim_ros.device.local_events import FIRST_LOCAL_EVENT, LocalEvents
from thymio_sim_ros.device.network_events import NetworkEvents
from thymio_sim_ros.device.programs.load import LoadMeter
from thymio_sim_ros.device.programs.status import INIT
from thymio_sim_ros.device.variables import DeviceVariables

__all__ = ["HandlerScheduler"]


class HandlerScheduler:
    """Decides which handler a machine executes, and for how long. Invariant: executes only during its own calls."""

    def __init__(
        self,
        vm: VirtualMachine,
        queue: EventQueue,
        variables: DeviceVariables,
        local_events: LocalEvents,
        network_events: NetworkEvents,
        services: FirmwareServices,
        meter: LoadMeter,
        due: DueTime,
    ) -> None:
        """`services` have the number of the robot, `meter` the costs of native calls and events.

        Periods of timers to be read make `due` now.
        """
        self.event = ""
        """Name of the event of the last handler started, or INIT."""
        self._vm, self._queue, self._variables = vm, queue, variables
        self._local_events, self._network_events = local_events, network_events
        self._services, self._meter, self._due = services, meter, due
        self._handler_start = 0
        """Value of `vm.instructions` at the start of the handler."""
        self._periods = vm.target.addresses["timer.period"]
        self._are_periods_read = False
        self._sets_at_reading = 0
        """Value of `variables.sets` when the periods of the timers were last read."""

    @property
    def is_busy(self) -> bool:
        """Whether `run` has work: an unfinished handler, a pending event, or periods of timers to read."""
        vm = self._vm
        return not vm.is_step_by_step and (vm.is_active or self._queue.has_events or self.has_stale_periods)

    @property
    def has_stale_periods(self) -> bool:
        """Whether the periods of the timers may have been changed from outside the program."""
        return not self._are_periods_read or self._variables.sets != self._sets_at_reading

    def run(self, budget: int, process_messages: Callable[[], bool]) -> None:
        """Execute handlers until no event is pending or the budget of instructions is used up.

        Native calls and events count as several instructions (`costs`). With a policy that interrupts handlers, the
        reference counts a native call as one instruction to decide when; there the extra costs are compared with the
        budget only between handlers.

        `process_messages` is called after each slice of a handler; it returns whether the robot was restarted or
        switched off, which ends the run.
        """
        if not self.is_busy:
            return
        self._variables.prepare_run()
        vm, queue, meter = self._vm, self._queue, self._meter
        handler_budget = queue.policy.handler_budget
        end, charged, is_busy = vm.instructions + budget, meter.charged, True
        while is_busy and vm.instructions < end and not (queue.policy.interrupts and meter.charged - charged >= budget):
            if not vm.is_active or (
                queue.policy.interrupts and queue.has_events and vm.instructions > self._handler_start
            ):
                self._start_next()
            elif queue.has_global and vm.instructions - self._handler_start >= handler_budget:
                self._start_global(queue.pop_global())
            vm.run(min(handler_budget, end - vm.instructions))
            is_restarted = process_messages()
            if not vm.is_active:
                self._read_timer_periods()
            if is_restarted:
                break  # a robot that restarts takes a while
            if queue.policy.interrupts and vm.is_active and not queue.has_events:
                break  # the rest of a long handler belongs to the next step
            is_busy = self.is_busy
        meter.count_run(is_cut=meter.charged - charged >= budget // 2 and self.is_busy)

    def start_next_if_idle(self) -> bool:
        """Start the handler of the next event if no handler is active; return whether one was started."""
        if self._vm.is_active:
            return False
        while not self._vm.is_active and self._queue.has_events:
            self._read_timer_periods()
            self._start_next()
        return self._vm.is_active

    def invalidate_timer_periods(self) -> None:
        """Make the next `run` read the periods of the timers, even if no event is pending."""
        self._are_periods_read = False
        self._due.set_now()

    def reset(self) -> None:
        """Drop all pending events, stop all timers, and note that the initialization starts."""
        self.event, self._handler_start = INIT, self._vm.instructions
        self._queue.reset()

    def _start_next(self) -> None:
        """Start the handler of the next event, if any."""
        if not self._vm.is_active and self.has_stale_periods:
            self._read_timer_periods()
        event = self._queue.pop()
        if isinstance(event, GlobalEvent):
            self._start_global(event)
        elif event is not None:
            self._begin_handler(self._local_events.names[event])
            if self._queue.is_timer(event):  # all other local events were recorded when a reading caused them
                self._local_events.record(event)
            self._vm.receive(FIRST_LOCAL_EVENT - event, self._services.node_id, ())

    def _start_global(self, event: GlobalEvent) -> None:
        self._begin_handler(self._network_events.name_of(event))
        self._vm.receive(event.number, event.source, event.args)

    def _begin_handler(self, event: str) -> None:
        if self._queue.policy.interrupts and self._vm.is_active:
            budget = self._queue.policy.handler_budget
            self._services.notify(f"{event} cuts off {self.event}, which takes more than {budget} instructions")
        self.event, self._handler_start = event, self._vm.instructions

    def _read_timer_periods(self) -> None:
        address, size = self._periods
        self._queue.set_timer_periods(list(self._vm.variables.words[address : address + size]))
        self._are_periods_read, self._sets_at_reading = True, self._variables.sets
