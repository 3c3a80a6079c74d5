"""Run control of a remote robot: requests to the node, and the state that it reports."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from aseba_vm.bytecode import instructions
from aseba_vm.languages import LANGUAGES
from aseba_vm.machine import machine_messages as machine
from aseba_vm.protocol import (
    ArrayAccessOutOfBounds,
    ClearAllBreakpoints,
    DivisionByZero,
    EventExecutionKilled,
    NodeSpecificError,
    Pause,
    Reset,
    Run,
    SetBreakpoint,
    Step,
    Stop,
)
from aseba_vm.protocol.reports import ExecutionState, FaultMessage
from aseba_vm.vm import MAX_BREAKPOINTS
from thymio_sim_ros.device.layout import target
from thymio_sim_ros.device.programs.breakpoints import Breakpoints
from thymio_sim_ros.device.programs.program import load_program
from thymio_sim_ros.device.programs.status import FAULT, OFF, PAUSED, RUNNING, STOPPED, DeviceStatus
from thymio_sim_ros.device.remote.commands import LED_NATIVES, MOTORS
from thymio_sim_ros.device.remote.ros_handlers import RemoteProgram, extended
from thymio_sim_ros.device.remote.session import COMPUTER, Session

__all__ = ["RemoteRunControl"]

MAX_LINE_STEPS = 10_000
"""Instructions after which a step to the next line ends anyway."""

MOST_LIGHTS = 8
"""Lights of the largest group."""


@dataclass(slots=True)
class _LineStep:
    """A step to the next line that is being executed: the line where it began, and instructions so far.

    `others` is the number of reports to come that do not belong to a step.
    """

    line: int | None
    others: int
    count: int = 0


class RemoteRunControl:
    """State of the node's machine, and requests to change it, which the node confirms by reporting its state."""

    def __init__(self, session: Session) -> None:
        self._session = session
        self._state = RUNNING
        self._fault: DeviceStatus | None = None
        self.breakpoints = Breakpoints()
        """The breakpoints at lines."""
        self._line_step: _LineStep | None = None
        self._program: RemoteProgram | None = None
        """The program that runs when the robot is switched on again."""

    @property
    def status(self) -> DeviceStatus:
        """State of the machine; a robot that is not connected is off, for the reason in `fault`."""
        node = self._session.node
        if node is None:
            return DeviceStatus(OFF, fault=f"not connected: {self._session.problem}")
        if self._fault is not None:
            return self._fault
        if self._state == RUNNING or node.state is None or not node.state.is_active:
            return DeviceStatus(self._state)
        pc, program = node.state.pc, self._session.program
        return DeviceStatus(self._state, program.event_of(pc), program.line_of(pc), pc=pc)

    def load(self, program: RemoteProgram) -> None:
        """Stop the wheels, which a reset does not do on all robots, then load a program and start it."""
        self._stop_motors()
        self._session.load(program)
        self._begin()

    def resume(self) -> None:
        """Continue execution; switch the robot on if it is off."""
        program, node = self._program, self._session.node
        if program is not None:
            self.load(program)
            return
        if node is not None and node.state is not None and node.state.is_active and node.state.is_step_by_step:
            self._session.command(Step)  # leave a breakpoint
        self._session.command(Run)
        self._begin()

    def pause(self) -> None:
        """Stop execution until `step` or `resume`; wheels and lights keep their state."""
        if self._program is None:
            self._session.command(Pause)
            self._state, self._fault = PAUSED, None

    def step(self) -> None:
        """Execute one instruction; between events, the next event is prepared when it arrives."""
        if self._program is None:
            if self._state != PAUSED:
                self.pause()
            self._session.command(Step)

    def step_line(self) -> None:
        """Execute up to the next line or the end of the event."""
        if self._program is None:
            step = _LineStep(self.status.line, others=int(self._state != PAUSED))
            self.step()
            self._line_step = step

    def stop(self) -> None:
        """Abort the handler and stop the wheels."""
        if self._program is None:
            self._session.command(Stop)
            self._stop_motors()
            self._state, self._fault, self._line_step = STOPPED, None, None

    def reset(self) -> None:
        """Reset the node's machine, which waits before the start of the program."""
        if self._program is not None:
            self.resume()
        self._session.command(Reset)
        self._state, self._fault, self._line_step = PAUSED, None, None

    def switch_off(self) -> None:
        """Stop the program and the wheels until `resume`, `reset`, or the load of a program.

        The node gets a program of the appended handlers alone, so that commands still work.
        """
        if self._program is None:
            program = self._session.program
            layout = program.own.layout
            self._session.load(extended(load_program("", "none", layout), target(layout)))
            self._stop_motors()
            for native in LED_NATIVES.values():
                self._call(native, (0,) * MOST_LIGHTS)
            self._call("sound.freq", (0, -1))
            self._state, self._fault, self._line_step, self._program = OFF, None, None, program

    def release(self) -> None:
        """Note that another client controls the machine: its state is the one that the node reports."""
        self._fault, self._line_step, self._program = None, None, None
        if self._state != RUNNING:
            self._state = PAUSED

    def set_breakpoints(self, lines: Sequence[int]) -> Breakpoints:
        """Replace all breakpoints: lines of the program's file, from 1; a line without code becomes the next with code.

        Returns the lines where they are requested, at most 16.
        """
        places = self._places()
        moved: dict[int, int | None] = {}
        found: list[int] = []
        for line in sorted(set(lines)):
            place = min((known for known in places if known >= line), default=None)
            if line < self._session.program.own.lines[0] or (place not in found and len(found) >= MAX_BREAKPOINTS):
                place = None
            if place is not None and place not in found:
                found.append(place)
            if place != line:
                moved[line] = place
        if self._session.node is not None:
            number = self._session.node.number
            self._session.command(ClearAllBreakpoints)
            self._session.client.send(*(SetBreakpoint(COMPUTER, number, places[line]) for line in found))
        self.breakpoints = Breakpoints(tuple(found), moved)
        return self.breakpoints

    def on_state(self, state: ExecutionState) -> None:
        """Process a state that the node has reported: at a breakpoint, after a step, or for another client."""
        if self._state in (RUNNING, PAUSED) and self._fault is None:
            self._state = PAUSED if state.is_step_by_step else RUNNING
        step = self._line_step
        if step is None:
            return
        if step.others:
            step.others -= 1
            return
        step.count += 1
        line = self._session.program.line_of(state.pc)
        if not state.is_active or step.count >= MAX_LINE_STEPS or line not in (None, step.line):
            self._line_step = None
        else:
            self._session.command(Step)

    def on_fault(self, message: FaultMessage) -> None:
        """Process a fault: the node waits, and the wheels stop."""
        if isinstance(message, EventExecutionKilled):
            return
        fault = _fault(message)
        program = self._session.program
        translations = {language: fault.message_in(language) for language in LANGUAGES}
        event, line = program.event_of(message.pc), program.line_of(message.pc)
        self._fault = DeviceStatus(FAULT, event, line, fault.message, message.pc, translations)
        self._state, self._line_step = FAULT, None
        self._stop_motors()

    def _begin(self) -> None:
        self._state, self._fault, self._line_step, self._program = RUNNING, None, None, None

    def _places(self) -> dict[int, int]:
        """First address of the code of each line of the user's program."""
        program = self._session.program.program
        places: dict[int, int] = {}
        for pc, _ in instructions(program.words, 2 * len(program.events) + 1):
            line = self._session.program.line_of(pc)
            if line is not None:
                places.setdefault(line, pc)
        return places

    def _call(self, native: str, words: Sequence[int]) -> None:
        """Call a native function if an appended handler does."""
        number = self._session.program.numbers.get(native)
        if number is not None:
            self._session.emit(number, words)

    def _stop_motors(self) -> None:
        for name in MOTORS:
            self._session.write(name, (0,))


def _fault(message: ArrayAccessOutOfBounds | DivisionByZero | NodeSpecificError) -> machine.Fault:
    match message:
        case ArrayAccessOutOfBounds(pc=pc, size=size, index=index):
            return machine.OutOfBounds(pc, size, index & 0xFFFF) if size else machine.OutOfBounds(pc)
        case DivisionByZero(pc=pc):
            return machine.DivisionByZero(pc)
    return machine.NodeSpecific(message.pc, message.text)
