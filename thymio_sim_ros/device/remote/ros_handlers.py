"""Handlers that are appended to the program of a remote robot, so that its native functions can be called from outside.

A node executes native functions only for its program. Each native function that a command needs gets an event, whose
number follows those of the user's program, and a handler that calls it with the arguments of the event::

    onevent _ros.leds.top
    call leds.top(event.args[0], event.args[1], event.args[2])

The names are never shown. Such commands have no effect while the program is paused, stopped or after a fault.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

from aseba_vm import CompileError, Program, TargetDescription, compile
from thymio_sim_ros.device.programs.program import ThymioProgram

__all__ = ["PREFIX", "RemoteProgram", "extended", "served_natives"]

PREFIX = "_ros."
"""Begin of the names of the appended events."""

_WANTED = (
    *("leds.top", "leds.bottom.left", "leds.bottom.right", "leds.circle", "leds.buttons", "leds.prox.h", "leds.prox.v"),
    *("leds.rc", "leds.sound", "leds.temperature", "_leds.set", "sound.freq", "sound.system", "prox.comm.enable"),
)
"""Native functions that commands call; all their parameters are single words."""


@dataclass(frozen=True, slots=True)
class RemoteProgram:
    """A program as a remote robot runs it: `numbers` has the event of each native function that can be called.

    `own` is the user's program. `problem` says why no native function can be called; empty if there is no problem.
    """

    own: ThymioProgram
    program: Program
    numbers: Mapping[str, int] = field(default_factory=dict)
    problem: str = ""

    def line_of(self, pc: int) -> int | None:
        """Line in the file, from 1, of an address of the bytecode; None for appended handlers."""
        row = self.program.row_of(pc)
        return self.own.lines[row] if row is not None and row < len(self.own.lines) else None

    def event_of(self, pc: int) -> str:
        """Name of the event or subroutine with this address; empty for appended handlers and unknown addresses."""
        segment = self.program.segment_of(pc)
        return "" if segment is None or segment.name.startswith(PREFIX) else segment.name or "init"


def served_natives(target: TargetDescription) -> dict[str, int]:
    """Return the native functions that commands can call on a robot, with their numbers of arguments."""
    known = {native.name: [parameter.size for parameter in native.parameters] for native in target.natives}
    return {name: len(known[name]) for name in _WANTED if name in known and set(known[name]) == {1}}


def extended(own: ThymioProgram, target: TargetDescription) -> RemoteProgram:
    """Return a program, which is compiled for this target, with the appended handlers if they fit into the memory."""
    natives = served_natives(target)
    numbers = {name: len(own.events) + index for index, name in enumerate(natives)}
    events = [*own.events, *((PREFIX + name, count) for name, count in natives.items())]
    text = "\n".join([own.source, *(_handler(name, count) for name, count in natives.items())])
    try:
        return RemoteProgram(own, compile(text, target, events=events, constants=own.constants), numbers)
    except CompileError as error:
        return RemoteProgram(own, own.program, problem=str(error))


def _handler(native: str, arguments: int) -> str:
    words = ", ".join(f"event.args[{index}]" for index in range(arguments))
    return f"onevent {PREFIX}{native}\ncall {native}({words})"
