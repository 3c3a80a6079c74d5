"""Run control of a device: run, pause, steps, breakpoints, stop, reset, power; faults of its program.

Source: docs/aseba_ros.md, "Run control and breakpoints".
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

from aseba_vm import VirtualMachine
from aseba_vm.languages import LANGUAGES
from aseba_vm.machine.machine_messages import (
    BadCode,
    DivisionByZero,
    Emitted,
    Fault,
    Message,
    NodeSpecific,
    OutOfBounds,
)
from aseba_vm.vm import MAX_BREAKPOINTS
from thymio_sim_ros.device.event_queue import EventQueue
from thymio_sim_ros.device.firmware.services import RESTART, FirmwareServices
from thymio_sim_ros.device.handler_scheduler import HandlerScheduler
from thymio_sim_ros.device.network_events import NetworkEvents
from thymio_sim_ros.device.outputs import Outputs
from thymio_sim_ros.device.programs.breakpoints import Breakpoints, LineDebugger
from thymio_sim_ros.device.programs.program import ThymioProgram
from thymio_sim_ros.device.programs.status import FAULT, OFF, PAUSED, RUNNING, STOPPED, DeviceStatus
from thymio_sim_ros.device.variables import DeviceVariables
from thymio_sim_ros.sim.audio.synthesis import SHUT_DOWN
from thymio_sim_ros.sim.commands import PlaySystemSound

__all__ = ["RunControl"]


class RunControl:
    """State of one machine, and all that changes it. Invariant: a machine that is not `running` is step by step."""

    def __init__(
        self,
        vm: VirtualMachine,
        program: ThymioProgram,
        queue: EventQueue,
        scheduler: HandlerScheduler,
        network_events: NetworkEvents,
        variables: DeviceVariables,
        services: FirmwareServices,
        outputs: Outputs,
    ) -> None:
        """Create the control of a machine that is running `program`, or is about to."""
        self._vm, self._queue, self._scheduler = vm, queue, scheduler
        self._network_events, self._variables = network_events, variables
        self._services, self._outputs = services, outputs
        self.observe: Callable[[Message], None] | None = None
        """Called with each message of the machine that is processed."""
        self.stops_at_events = False
        """Whether the next event is started as soon as it arrives while the machine is paused between events.

        It then waits before its first instruction, as tools of a network expect it; until the machine runs again.
        """
        self.breakpoints = Breakpoints()
        """The breakpoints at lines."""
        self._state = RUNNING
        self._fault: DeviceStatus | None = None
        self._addresses: list[int] = []
        """Breakpoints at addresses, in addition to those at lines."""
        self.set_program(program)

    @property
    def status(self) -> DeviceStatus:
        """State of the machine, with the position in the program while an event is handled."""
        if self._fault is not None:
            return self._fault
        if not self._vm.is_active:
            return DeviceStatus(self._state)
        pc = self._vm.pc
        return DeviceStatus(self._state, self._scheduler.event, self._program.line_of(pc), pc=pc)

    @property
    def machine_state(self) -> tuple[int, int]:
        """Address and flags of the machine (docs/spec/aseba-protocol.md section 1.4)."""
        return self._vm.pc, self._vm.flags

    @property
    def is_off(self) -> bool:
        """Whether the robot is switched off."""
        return self._state == OFF

    @property
    def accepts_events(self) -> bool:
        """Whether an event from the network is queued: not after a stop or fault, nor while paused in a handler."""
        return not self._vm.is_step_by_step or (self._state == PAUSED and not self._vm.is_active)

    def set_program(self, program: ThymioProgram) -> None:
        """Replace the program to which lines refer, and remove all breakpoints at lines."""
        self._program = program
        self._debugger = LineDebugger(self._vm, program)
        self.set_breakpoints(())

    def resume(self) -> None:
        """Continue execution; switch the robot on if it is off."""
        if self._state == OFF:
            self._restart()
            return
        self._variables.refresh()
        if self._debugger.leave_breakpoint():
            self._variables.count_write()
            self.process_messages()
            if self._state == FAULT:
                return
        self.start()

    def start(self) -> None:
        """Execute from where the machine is, without the step that leaves a breakpoint."""
        self._vm.resume()
        self._state, self._fault, self.stops_at_events = RUNNING, None, False
        self._scheduler.invalidate_timer_periods()

    def pause(self) -> None:
        """Stop execution until `step` or `resume`; wheels and lights keep their state."""
        if self._state != OFF:
            self._vm.pause()
            self._state, self._fault = PAUSED, None

    def step(self) -> None:
        """Execute one instruction; between events, start the next pending event first."""
        if self._state != OFF:
            self.pause()
            self._scheduler.start_next_if_idle()
            self._step(self._vm.step)

    def step_line(self) -> None:
        """Execute up to the next line; between events, stop before the first line of the next pending event."""
        if self._state != OFF:
            self.pause()
            if not self._scheduler.start_next_if_idle():
                self._step(self._debugger.step_line)

    def step_instruction(self) -> None:
        """Execute one instruction, as the *step* message of a network does, and report the state.

        Between events, stop before the first instruction of the next pending event.
        """
        if self._state == OFF:
            return
        if not self._vm.is_step_by_step:
            self._vm.pause()
        self._state, self._fault = PAUSED, None
        was_active = self._vm.is_active
        if was_active:
            self._step(self._vm.step)
        if self._state == PAUSED and not self._scheduler.start_next_if_idle() and not was_active:
            self._vm.report_state()

    def prepare_event(self) -> None:
        """Start the next pending event if the machine waits for one (`stops_at_events`); it executes nothing."""
        if self.stops_at_events and self._state == PAUSED and self._scheduler.start_next_if_idle():
            self._variables.count_write()

    def set_breakpoints(self, lines: Sequence[int]) -> Breakpoints:
        """Replace all breakpoints at lines of the program's file, from 1. Returns the lines where they were set."""
        self.breakpoints = self._debugger.set_breakpoints(lines)
        for pc in self._addresses:
            self._vm.set_breakpoint(pc)
        return self.breakpoints

    def add_breakpoint(self, pc: int) -> bool:
        """Add a breakpoint at an address; return False if there are 16 already, or no such address."""
        if pc in self._addresses:
            return True
        if len(self._vm.breakpoints) >= MAX_BREAKPOINTS or not 0 <= pc < len(self._vm.code):
            return False
        self._addresses.append(pc)
        self._vm.set_breakpoint(pc)
        return True

    def remove_breakpoint(self, pc: int) -> None:
        """Remove the breakpoint that `add_breakpoint` has set at an address, if any."""
        if pc in self._addresses:
            self._addresses.remove(pc)
            self._vm.clear_breakpoint(pc)

    def stop(self) -> None:
        """Abort the handler and stop the wheels."""
        if self._state != OFF:
            self._abort()
            self._state, self._fault = STOPPED, None

    def reset(self) -> None:
        """Reset the robot: clear the variables, switch the lights off, and pause before the start of the program."""
        self._vm.reset()
        self._state, self._fault = PAUSED, None

    def clear_breakpoints(self) -> None:
        """Remove all breakpoints, at lines and at addresses."""
        self._addresses.clear()
        self._vm.clear_breakpoints()

    def write_bytecode(self, words: Sequence[int], start: int) -> None:
        """Write words of bytecode, which must fit, and reset the robot as `reset` does."""
        self._vm.set_bytecode(words, start)
        self._state, self._fault = PAUSED, None

    def switch_off(self) -> None:
        """Switch wheels and lights off; nothing is executed until `resume`, `reset`, or the load of a program."""
        self._abort()
        self._services.stop_recording()
        self._outputs.switch_off_lights()
        self._outputs.queue(PlaySystemSound(SHUT_DOWN))
        self._state, self._fault = OFF, None

    def process_messages(self) -> bool:
        """Process the messages of the machine; return whether they restarted the robot or switched it off."""
        # The natives that request a restart or power-off raise NativeFault only to end the handler at once.
        requested, self._services.requested = self._services.requested, ""
        for message in self._vm.pop_messages():
            if self.observe is not None:
                self.observe(message)
            if isinstance(message, Emitted):
                self._network_events.add_emitted(message)
            elif isinstance(message, OutOfBounds | DivisionByZero | NodeSpecific | BadCode) and not requested:
                self._stop_on(message)
        if self._state == RUNNING and self._vm.is_step_by_step:
            self._state = PAUSED  # at a breakpoint
        if requested == RESTART:
            self._restart()
        elif requested:
            self.switch_off()
        return bool(requested)

    def _step(self, execute: Callable[[], object]) -> None:
        self._variables.refresh()
        execute()
        self._variables.count_write()
        self.process_messages()

    def _stop_on(self, fault: Fault) -> None:
        self._state = FAULT
        line = self._program.line_of(fault.pc)
        translations = {language: fault.message_in(language) for language in LANGUAGES}
        self._fault = DeviceStatus(FAULT, self._scheduler.event, line, fault.message, fault.pc, translations)
        self._queue.clear()
        self._stop_motors()

    def _abort(self) -> None:
        """Abort the handler, drop the pending events and stop the wheels."""
        self._vm.stop()
        self._queue.clear()
        self._stop_motors()

    def _stop_motors(self) -> None:
        for name in ("motor.left.target", "motor.right.target"):
            self._variables.set(name, (0,))

    def _restart(self) -> None:
        """Restart as after switching off and on: drop unsaved settings and start the program again."""
        self._services.settings.restart()
        self._vm.reset()
        self.start()
