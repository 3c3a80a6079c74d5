"""Commands to the world: one frozen dataclass per kind of command.

Commands are posted at any time and take effect at the next tick, in the order of arrival
(`World.post`). They carry SI units, except where a field is a Thymio integer by name.
"""

from __future__ import annotations

from thymio_sim_ros.sim.commands.driving import (
    MOTOR_MODELS,
    BodyTwist,
    Driving,
    MotorTargets,
    ResetOdometry,
    SetMotorModel,
    SetOdometry,
    WheelVelocities,
)
from thymio_sim_ros.sim.commands.lights import (
    COLORED_GROUPS,
    LED_COLORS,
    LED_FULL,
    LED_GESTURES,
    LED_GROUPS,
    LEDS_GIVEN_BACK,
    Lighting,
    PlayGesture,
    ReleaseLeds,
    SetLed,
    SetLeds,
    ShowOnLeds,
    StopGesture,
)
from thymio_sim_ros.sim.commands.operator import (
    BUTTONS,
    Clap,
    ConnectCharger,
    DrawJumps,
    Lift,
    MoveObject,
    MoveRobot,
    Operating,
    PressButton,
    RemoteKey,
    SetAmbientLight,
    SetBattery,
    SetGround,
    SetNoiseLevel,
    SetPen,
    SetProximity,
    SetTemperature,
    Tap,
    Tilt,
)
from thymio_sim_ros.sim.commands.senses import EnableComm, Sensing, SetCommPayload, SetSoundThreshold
from thymio_sim_ros.sim.commands.sounds import (
    PlaySamples,
    PlaySystemSound,
    PlayTone,
    SetAlarm,
    SetVolume,
    SetWave,
    Sounding,
    StopSound,
)

__all__ = [
    "BUTTONS",
    "COLORED_GROUPS",
    "LEDS_GIVEN_BACK",
    "LED_COLORS",
    "LED_FULL",
    "LED_GESTURES",
    "LED_GROUPS",
    "MOTOR_MODELS",
    "BodyTwist",
    "Clap",
    "Command",
    "ConnectCharger",
    "DrawJumps",
    "EnableComm",
    "Lift",
    "MotorTargets",
    "MoveObject",
    "MoveRobot",
    "PlayGesture",
    "PlaySamples",
    "PlaySystemSound",
    "PlayTone",
    "PluginCommand",
    "PressButton",
    "ReleaseLeds",
    "RemoteKey",
    "ResetOdometry",
    "SetAlarm",
    "SetAmbientLight",
    "SetBattery",
    "SetCommPayload",
    "SetGround",
    "SetLed",
    "SetLeds",
    "SetMotorModel",
    "SetNoiseLevel",
    "SetOdometry",
    "SetPen",
    "SetProximity",
    "SetSoundThreshold",
    "SetTemperature",
    "SetVolume",
    "SetWave",
    "ShowOnLeds",
    "StopGesture",
    "StopSound",
    "Tap",
    "Tilt",
    "WheelVelocities",
]


class PluginCommand:
    """Base of the commands that a plug-in defines (docs/plugins.md)."""

    __slots__ = ()


Command = Driving | Lighting | Sounding | Operating | Sensing | PluginCommand
"""Any command that a world accepts."""
