"""Layout and bindings follow from firmware 14 and from what the plug-ins declare."""

from __future__ import annotations

import pytest

from aseba_vm.targets import THYMIO_II
from thymio_sim_ros.device import bindings
from thymio_sim_ros.device.layout import extend, target
from thymio_sim_ros.sim.actuators import Actuator
from thymio_sim_ros.sim.commands import MotorTargets, SetLeds
from thymio_sim_ros.sim.plugin_api.aseba_binding import ActuatorFace, AsebaFace, Native, Output
from thymio_sim_ros.sim.sensors import Sensor, all_sensors


def test_every_sensor_that_aseba_sees_is_bound():
    seen = tuple(sensor.name for sensor in all_sensors() if sensor.aseba.variables or sensor.aseba.event)
    assert bindings.sensor_names() == seen
    assert {"buttons", "ground", "motor", "proximity", "sound_finished"} <= set(seen)


def test_proximity_words_go_to_prox_horizontal_and_raise_prox():
    binding = bindings.sensors()["proximity"]
    (slot,) = binding.slots
    assert (slot.address, slot.size) == target().addresses["prox.horizontal"]
    assert target().local_events[binding.event].name == "prox"


def test_buttons_raise_an_event_of_their_own_when_they_change():
    binding = bindings.sensors()["buttons"]
    names = [target().local_events[slot.edge].name for slot in binding.slots]
    assert names == ["button.backward", "button.left", "button.center", "button.forward", "button.right"]
    assert target().local_events[binding.event].name == "buttons"


def test_motor_targets_and_lights_are_outputs():
    commands = [output.command([1] * sum(slot.size for slot in output.slots)) for output in bindings.outputs()]
    assert MotorTargets(1, 1) in commands
    assert SetLeds("circle", (1,) * 8) in commands


def test_natives_of_the_lights_exist_in_the_firmware():
    firmware = {native.name: len(native.parameters) for native in target().natives}
    for name, native in bindings.natives().items():
        assert firmware[name] == len(native.parameters)


def test_what_only_plug_ins_know_comes_after_the_firmware_and_takes_no_room_from_programs():
    sensor = Sensor("radar", 1, lambda view: None, AsebaFace((("radar.echo", 3),), "radar", edge_events=True))
    face = ActuatorFace(
        (Output((("arm.angle", 1),), lambda words: MotorTargets(0, 0)),),
        (Native("arm.wave", ("times",), lambda words: MotorTargets(0, 0)),),
    )
    arm = Actuator("arm", (), dict, lambda state, command, now_ns: None, aseba=face)
    wider = extend(THYMIO_II, [sensor], [arm])
    assert wider.addresses["radar.echo"] == (128, 3)
    assert wider.addresses["arm.angle"] == (131, 1)
    assert wider.variables_size == THYMIO_II.variables_size + 4
    assert [event.name for event in wider.local_events[17:]] == ["radar.echo", "radar"]
    assert [native.name for native in wider.natives[60:]] == ["arm.wave"]


def test_a_plug_in_that_contradicts_the_firmware_is_refused():
    sensor = Sensor("acc", 1, lambda view: None, AsebaFace((("acc", 4),)))
    with pytest.raises(ValueError, match="acc: a plug-in declares 4 words, expected 3"):
        extend(THYMIO_II, [sensor], [])
