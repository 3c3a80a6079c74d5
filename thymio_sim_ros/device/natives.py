"""Native functions of the Thymio as the machine calls them (docs/spec/thymio-robot.md section 6).

The machine implements `math.*` and `deque.*`. Native functions that an actuator declares become its commands; the
others call services of the firmware (`SERVICE_NATIVES`).
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence

from aseba_vm import Native, NativeCall, NativeFault
from thymio_sim_ros.device import bindings
from thymio_sim_ros.device.costs import BYTES_PER_INSTRUCTION, COSTS
from thymio_sim_ros.device.firmware.services import RESTART, SWITCH_OFF, FirmwareServices
from thymio_sim_ros.device.programs.load import LoadMeter
from thymio_sim_ros.sim.commands import Command
from thymio_sim_ros.sim.plugin_api import aseba_binding

__all__ = ["SERVICE_NATIVES", "native_functions"]

Send = Callable[[Command, Mapping[str, Sequence[int]]], None]
"""Sends a command and writes the variables (words by name) that the call sets."""

DONE, FAILED = 0, -1
"""Results of `sd.open` and `sd.seek`."""


def native_functions(send: Send, services: FirmwareServices, meter: LoadMeter) -> dict[str, Native]:
    """Return the functions that the machine does not implement, by name; `meter` counts their calls."""
    actuators = {native.name: _commanding(native, send, meter) for native in bindings.natives().values()}
    return actuators | {name: _serving(name, serve, services, meter) for name, serve in SERVICE_NATIVES.items()}


def _commanding(native: aseba_binding.Native, send: Send, meter: LoadMeter) -> Native:
    name, make_command, writes = native.name, native.command, native.writes
    charge = COSTS.of(name).of(sum(size for _, size in native.signature))

    def call_native(call: NativeCall) -> None:
        meter.count_call(name, charge)
        words = call.words()
        try:
            command = make_command(words)
        except ValueError as error:
            raise NativeFault(str(error)) from error
        send(command, writes(words))

    return call_native


def _serving(
    name: str, serve: Callable[[NativeCall, FirmwareServices], None], services: FirmwareServices, meter: LoadMeter
) -> Native:
    cost = COSTS.of(name)

    def call_native(call: NativeCall) -> None:
        meter.count_call(name, cost.of(sum(call.sizes)))
        serve(call, services)

    return call_native


def _charge_bytes(call: NativeCall, count: int) -> None:
    call.charge(count // BYTES_PER_INSTRUCTION)


def _reboot(_call: NativeCall, services: FirmwareServices) -> None:
    services.requested = RESTART
    raise NativeFault(RESTART)


def _power_off(_call: NativeCall, services: FirmwareServices) -> None:
    services.requested = SWITCH_OFF
    raise NativeFault(SWITCH_OFF)


def _read_setting(call: NativeCall, services: FirmwareServices) -> None:
    call.write(1, [services.settings[_setting(call, services)]])


def _write_setting(call: NativeCall, services: FirmwareServices) -> None:
    services.change_setting(_setting(call, services), call.value(1))


def _setting(call: NativeCall, services: FirmwareServices) -> int:
    address = call.value(0)
    if not 0 <= address < len(services.settings):
        raise NativeFault(f"out of settings: address {address} found, expected 0 to {len(services.settings) - 1}")
    return address


def _flash_settings(_call: NativeCall, services: FirmwareServices) -> None:
    services.flash_settings()


def _record(call: NativeCall, services: FirmwareServices) -> None:
    _charge_bytes(call, services.record(call.value(0)))


def _play(call: NativeCall, services: FirmwareServices) -> None:
    _charge_bytes(call, services.play("p", call.value(0)))


def _replay(call: NativeCall, services: FirmwareServices) -> None:
    _charge_bytes(call, services.play("r", call.value(0)))


def _system_sound(call: NativeCall, services: FirmwareServices) -> None:
    _charge_bytes(call, services.play_system_sound(call.value(0)))


def _duration(call: NativeCall, services: FirmwareServices) -> None:
    """Write the length in tenths of a second; a recording has 7812 samples per second."""
    call.write(1, [min(32767, services.recorded_bytes(call.value(0)) * 5 // 3906)])


def _open(call: NativeCall, services: FirmwareServices) -> None:
    number, card = call.value(0), services.card
    if card is not None and number == -1:
        card.close()
        call.write(1, [DONE])
    else:
        call.write(1, [DONE if card is not None and card.open(number) else FAILED])
        services.notify_card_full()


def _write(call: NativeCall, services: FirmwareServices) -> None:
    call.write(1, [0 if services.card is None else services.card.write(call.read(0))])
    services.notify_card_full()


def _read(call: NativeCall, services: FirmwareServices) -> None:
    words = [] if services.card is None else services.card.read(call.sizes[0])
    call.write(0, words)
    call.write(1, [len(words)])


def _seek(call: NativeCall, services: FirmwareServices) -> None:
    """Positions are unsigned, so that the second half of a large file can be reached."""
    done = services.card is not None and services.card.seek(call.value(0) & 0xFFFF)
    call.write(1, [DONE if done else FAILED])


def _set_node_id(call: NativeCall, services: FirmwareServices) -> None:
    number = call.value(0)
    if number > 0:
        services.node_id = number


def _set_network(call: NativeCall, services: FirmwareServices) -> None:
    services.network = (call.value(0), call.value(1))


SERVICE_NATIVES: Mapping[str, Callable[[NativeCall, FirmwareServices], None]] = {
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
