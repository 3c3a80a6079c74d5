"""What an operator may say: ranges are checked where a command is made, with what was found and expected."""

from __future__ import annotations

import math
from collections.abc import Callable

import pytest

from thymio_sim_ros.sim import commands
from thymio_sim_ros.sim.commands import (
    Clap,
    RemoteKey,
    SetAmbientLight,
    SetBattery,
    SetCommPayload,
    SetNoiseLevel,
    SetSoundThreshold,
    SetTemperature,
    Tilt,
)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: Clap(256), "Clap: intensity 256 found, expected 0 to 255"),
        (lambda: Clap(-1), "intensity -1"),
        (lambda: SetNoiseLevel(256), "SetNoiseLevel: intensity 256 found, expected 0 to 255"),
        (lambda: SetAmbientLight(1024), "SetAmbientLight: level 1024 found, expected 0 to 1023"),
        (lambda: Tilt(3.2, 0.0), "Tilt: roll_rad 3.2 found, expected -3.14159 to 3.14159"),
        (lambda: Tilt(0.0, math.nan), "pitch_rad nan"),
        (lambda: SetTemperature(85.1), "SetTemperature: celsius 85.1 found, expected -40 to 85"),
        (lambda: SetTemperature(math.nan), "celsius nan"),
        (lambda: RemoteKey(32, 0), "RemoteKey: address 32 found, expected 0 to 31"),
        (lambda: RemoteKey(0, 128), "RemoteKey: command 128 found, expected 0 to 127"),
        (lambda: SetBattery(math.inf), "SetBattery: volts inf found, expected 0 to 5"),
        (lambda: SetSoundThreshold(32768), "SetSoundThreshold: level 32768 found, expected -32768 to 32767"),
        (lambda: SetCommPayload(-32769), "SetCommPayload: value -32769 found, expected -32768 to 32767"),
    ],
)
def test_what_is_out_of_range_is_refused(make: Callable[[], commands.Command], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        make()


def test_the_limits_themselves_are_fine() -> None:
    for lowest, highest in (
        (Clap(0), Clap(255)),
        (Tilt(-math.pi, -math.pi), Tilt(math.pi, math.pi)),
        (SetTemperature(-40.0), SetTemperature(85.0)),
        (RemoteKey(0, 0), RemoteKey(31, 127)),
        (SetBattery(0.0), SetBattery(5.0)),
        (SetSoundThreshold(-32768), SetSoundThreshold(32767)),
    ):
        assert lowest != highest
