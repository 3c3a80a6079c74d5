"""Native functions of the Thymio as the machine calls them.

Those that reach an actuator become commands. The others of the firmware that this simulator does not model yet do
nothing, say so once, and leave in their arguments what a robot without a card answers (thymio-robot.md section 6.3).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from aseba_vm import Native, NativeCall
from aseba_vm.nativecall import NativeFault
from thymio_sim_ros.device import bindings
from thymio_sim_ros.device.layout import target
from thymio_sim_ros.sim import aseba_face
from thymio_sim_ros.sim.commands import Command

STANDARD = ("math.", "deque.")
"""Families that the machine itself knows."""

ANSWERS = {"sd.open": (1, -1), "sd.write": (1, 0), "sd.read": (1, 0), "sd.seek": (1, -1), "sound.duration": (1, 0)}
"""Native → the argument it answers in, and what a robot without a card says."""


def native_functions(
    send: Callable[[Command, Mapping[str, Sequence[int]]], None], tell: Callable[[str], None]
) -> dict[str, Native]:
    """Functions by name: `send` takes a command and the variables that the call sets; `tell` a sentence."""
    functions: dict[str, Native] = {}
    reaching = bindings.natives()
    for native in target().natives:
        if native.name in reaching:
            functions[native.name] = _reaching(reaching[native.name], send)
        elif not native.name.startswith(STANDARD):
            functions[native.name] = _without_effect(native.name, tell)
    return functions


def _reaching(native: aseba_face.Native, send: Callable[[Command, Mapping[str, Sequence[int]]], None]) -> Native:
    def call_native(call: NativeCall) -> None:
        words = [word for argument in range(len(call.sizes)) for word in call.read(argument)]
        try:
            command = native.command(words)
        except ValueError as error:
            raise NativeFault(str(error)) from error
        send(command, native.writes(words))

    return call_native


def _without_effect(name: str, tell: Callable[[str], None]) -> Native:
    def call_native(call: NativeCall) -> None:
        if name in ANSWERS:
            argument, answer = ANSWERS[name]
            call.write(argument, [answer])
        tell(f"{name} has no effect in this simulator yet")

    return call_native
