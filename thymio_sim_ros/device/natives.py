"""Native functions of the Thymio as the machine calls them (docs/spec/thymio-robot.md section 6).

The machine itself knows `math.*` and `deque.*`. Natives that actuators declare become their commands; the others
reach the parts of the robot's body by the table at the end.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from aseba_vm import Native, NativeCall
from aseba_vm.machine.native_call import NativeFault
from thymio_sim_ros.device import bindings
from thymio_sim_ros.device.costs import BYTES_PER_INSTRUCTION
from thymio_sim_ros.device.firmware.services import RESTART, SWITCH_OFF, Body
from thymio_sim_ros.device.programs.load import Meter
from thymio_sim_ros.sim.commands import Command
from thymio_sim_ros.sim.plugin_api import aseba_binding

__all__ = ["BODY_NATIVES", "native_functions"]

Send = Callable[[Command, Mapping[str, Sequence[int]]], None]
"""Takes a command and the variables that the call sets."""

DONE, FAILED = 0, -1
"""What `sd.open` and `sd.seek` answer."""


def native_functions(send: Send, body: Body, meter: Meter) -> dict[str, Native]:
    """All functions that are not the machine's own, by name; `meter` counts their calls."""
    actuators = {native.name: _commanding(native, send, meter) for native in bindings.natives().values()}
    return actuators | {name: _serving(name, serve, body, meter) for name, serve in BODY_NATIVES.items()}


def _commanding(native: aseba_binding.Native, send: Send, meter: Meter) -> Native:
    def call_native(call: NativeCall) -> None:
        meter.count_call(native.name, sum(call.sizes))
        words = call.words()
        try:
            command = native.command(words)
        except ValueError as error:
            raise NativeFault(str(error)) from error
        send(command, native.writes(words))

    return call_native


def _serving(name: str, serve: Callable[[NativeCall, Body], None], body: Body, meter: Meter) -> Native:
    def call_native(call: NativeCall) -> None:
        meter.count_call(name, sum(call.sizes))
        serve(call, body)

    return call_native


def _charge_bytes(call: NativeCall, count: int) -> None:
    call.charge(count // BYTES_PER_INSTRUCTION)


def _reboot(_call: NativeCall, body: Body) -> None:
    body.wanted = RESTART
    raise NativeFault(RESTART)


def _power_off(_call: NativeCall, body: Body) -> None:
    body.wanted = SWITCH_OFF
    raise NativeFault(SWITCH_OFF)


def _read_setting(call: NativeCall, body: Body) -> None:
    call.write(1, [body.settings[_setting(call, body)]])


def _write_setting(call: NativeCall, body: Body) -> None:
    body.change_setting(_setting(call, body), call.value(1))


def _setting(call: NativeCall, body: Body) -> int:
    address = call.value(0)
    if not 0 <= address < len(body.settings):
        raise NativeFault(f"out of settings: address {address} found, expected 0 to {len(body.settings) - 1}")
    return address


def _flash_settings(_call: NativeCall, body: Body) -> None:
    body.flash_settings()


def _record(call: NativeCall, body: Body) -> None:
    _charge_bytes(call, body.record(call.value(0)))


def _play(call: NativeCall, body: Body) -> None:
    _charge_bytes(call, body.play("p", call.value(0)))


def _replay(call: NativeCall, body: Body) -> None:
    _charge_bytes(call, body.play("r", call.value(0)))


def _system_sound(call: NativeCall, body: Body) -> None:
    _charge_bytes(call, body.play_system_sound(call.value(0)))


def _duration(call: NativeCall, body: Body) -> None:
    """Tenths of a second."""
    call.write(1, [min(32767, body.recorded_bytes(call.value(0)) * 5 // 3906)])


def _open(call: NativeCall, body: Body) -> None:
    number, card = call.value(0), body.card
    if card is not None and number == -1:
        card.close()
        call.write(1, [DONE])
    else:
        call.write(1, [DONE if card is not None and card.open(number) else FAILED])
        body.tell_full_card()


def _write(call: NativeCall, body: Body) -> None:
    call.write(1, [0 if body.card is None else body.card.write(call.read(0))])
    body.tell_full_card()


def _read(call: NativeCall, body: Body) -> None:
    words = [] if body.card is None else body.card.read(call.sizes[0])
    call.write(0, words)
    call.write(1, [len(words)])


def _seek(call: NativeCall, body: Body) -> None:
    """Positions are words without sign, so that the second half of a large file can be reached."""
    done = body.card is not None and body.card.seek(call.value(0) & 0xFFFF)
    call.write(1, [DONE if done else FAILED])


def _set_node_id(call: NativeCall, body: Body) -> None:
    number = call.value(0)
    if number > 0:
        body.node_id = number


def _set_network(call: NativeCall, body: Body) -> None:
    body.network = (call.value(0), call.value(1))


BODY_NATIVES: Mapping[str, Callable[[NativeCall, Body], None]] = {
    "_system.reboot": _reboot,
    "_system.settings.read": _read_setting,
    "_system.settings.write": _write_setting,
    "_system.settings.flash": _flash_settings,
    "sound.record": _record,
    "sound.play": _play,
    "sound.replay": _replay,
    "sound.system": _system_sound,
    "sound.duration": _duration,
    "sd.open": _open,
    "sd.write": _write,
    "sd.read": _read,
    "sd.seek": _seek,
    "_rf.nodeid": _set_node_id,
    "_rf.setup": _set_network,
    "_poweroff": _power_off,
}
