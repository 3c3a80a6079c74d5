"""The plug-ins that exist, and toys from a temporary folder that join them without an edit anywhere."""

from __future__ import annotations

import importlib
import sys
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from types import ModuleType

import pytest

from tests.sim.builders import FLOOR, make, run, send
from thymio_sim_ros.files import registry
from thymio_sim_ros.files.registry import RegistryError
from thymio_sim_ros.sim import actuators, sensors, shapes, stimuli
from thymio_sim_ros.sim.commands import BUTTONS, LED_GROUPS, MotorTargets
from thymio_sim_ros.sim.playground import reader
from thymio_sim_ros.sim.world import World

TOY_SENSOR = """
from thymio_sim_ros.sim.plugin_api.aseba_binding import AsebaFace
from thymio_sim_ros.sim.model.readings import ButtonsReading
from thymio_sim_ros.sim.sensors import Sensor

SENSOR = Sensor(
    name="turn_sensor",
    period_ns=500_000_000,
    measure=lambda view: ButtonsReading(view.now_ns, (round(100 * view.pose.yaw_rad),)),
    aseba=AsebaFace(variables=(("turn_sensor.angle", 1),), event="turn_sensor"),
)
"""

TOY_WOKEN_SENSOR = """
from thymio_sim_ros.sim.commands import MotorTargets
from thymio_sim_ros.sim.model.readings import ButtonsReading
from thymio_sim_ros.sim.sensors import NEVER_NS, Sensor

SENSOR = Sensor("ear", NEVER_NS, lambda view: ButtonsReading(view.now_ns, ()), wakes_on=(MotorTargets,))
"""

TOY_FEELING_SENSOR = """
from thymio_sim_ros.sim.commands import MotorTargets
from thymio_sim_ros.sim.model.readings import ButtonsReading
from thymio_sim_ros.sim.sensors import Sensor

SENSOR = Sensor(
    name="skin",
    period_ns=100_000_000,
    measure=lambda view: ButtonsReading(view.now_ns, (view.memory["felt"],)),
    wakes_on=(MotorTargets,),
    on_wake=lambda view: view.memory.update(felt=view.memory.get("felt", 0) + 1),
)
"""

TOY_SHAPE = """
from dataclasses import dataclass

from thymio_sim_ros.sim.model.fields import Coordinate, Extent
from thymio_sim_ros.sim.model.geometry import Pose
from thymio_sim_ros.sim.model.primitives import Disc, Primitive, Solid
from thymio_sim_ros.sim.shapes import ShapeKind


@dataclass(frozen=True, slots=True)
class Gate:
    x_m: Coordinate
    width_m: Extent = 0.3

    def primitives(self, name: str) -> tuple[Primitive, ...]:
        sides = (self.width_m / 2, -self.width_m / 2)
        return tuple(Solid(name, Pose(self.x_m, y, 0.0), Disc(0.01), 0.2, (1.0, 0.0, 0.0)) for y in sides)


SHAPE = ShapeKind("gate", Gate)
"""

TOY_ACTUATOR = """
from dataclasses import dataclass

from thymio_sim_ros.sim.actuators import Actuator
from thymio_sim_ros.sim.commands import MotorTargets
from thymio_sim_ros.sim.model.geometry import Pose


@dataclass(frozen=True)
class Jump:
    x_m: float


class Spring:
    target = None


def apply(state, command, now_ns):
    state.target = command.x_m


def update(state, view, dt_s):
    if state.target is not None:
        view.place(Pose(state.target, 0.0, 0.0))
        state.target = None


ACTUATOR = Actuator("spring", (Jump,), Spring, apply, update)
"""


TOY_STIMULUS = """
from dataclasses import dataclass

from thymio_sim_ros.sim.model.geometry import Tilt
from thymio_sim_ros.sim.stimuli import Stimulus


@dataclass(frozen=True)
class Lean:
    roll_rad: float


class Leaning:
    def __init__(self):
        self.tilt = Tilt(0.0, 0.0)

    def sound_level(self, now_ns):
        return 40.0


def apply(state, command, now_ns):
    state.tilt = Tilt(command.roll_rad, 0.0)


STIMULUS = Stimulus("lean", (Lean,), Leaning, apply, shows=lambda state: {"lean": state.tilt.roll_rad})
"""


@pytest.fixture
def add_plugin(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Callable[[ModuleType, str, str], None]]:
    """Puts a module of some text into a plug-in folder for the time of a test."""
    added = []

    def add(package: ModuleType, name: str, text: str) -> None:
        (tmp_path / f"{name}.py").write_text(text)
        monkeypatch.setattr(package, "__path__", [*package.__path__, str(tmp_path)])
        added.append(f"{package.__name__}.{name}")
        importlib.invalidate_caches()

    yield add
    for module in added:
        sys.modules.pop(module, None)


PLUGINS: dict[str, tuple[ModuleType, Callable[[], Sequence[registry.Named]]]] = {
    "sensors": (sensors, sensors.all_sensors),
    "actuators": (actuators, actuators.all_actuators),
    "stimuli": (stimuli, stimuli.all_stimuli),
    "shapes": (shapes, shapes.all_shapes),
}


@pytest.mark.parametrize(("package", "plugins"), PLUGINS.values(), ids=PLUGINS.keys())
def test_every_plug_in_is_named_after_its_module(
    package: ModuleType, plugins: Callable[[], Sequence[registry.Named]]
) -> None:
    modules = sorted(path.stem for path in Path(package.__path__[0]).glob("[a-z]*.py"))
    assert modules
    assert [plugin.name for plugin in plugins()] == modules


def test_a_command_has_one_plug_in() -> None:
    accepted = [kind for plugin in (*actuators.all_actuators(), *stimuli.all_stimuli()) for kind in plugin.accepts]
    assert len(accepted) == len(set(accepted))


def test_programs_see_the_variables_and_events_of_the_firmware() -> None:
    faces = {sensor.name: sensor.aseba for sensor in sensors.all_sensors()}
    assert faces["proximity"].variables == (("prox.horizontal", 7),)
    assert [name for name, _ in faces["buttons"].variables] == [f"button.{button}" for button in BUTTONS]
    events = {name: face.event for name, face in faces.items() if face.event}
    assert (
        events.items()
        >= {
            "accelerometer": "acc",
            "buttons": "buttons",
            "comm": "prox.comm",
            "motor": "motor",
            "proximity": "prox",
            "remote": "rc5",
            "sound": "mic",
            "sound_finished": "sound.finished",
            "tap": "tap",
            "temperature": "temperature",
        }.items()
    )
    assert faces["buttons"].edge_events


def test_readings_have_as_many_words_as_their_variables() -> None:
    declared = {sensor.name: sensor.aseba.size for sensor in sensors.all_sensors()}
    world = World(make([FLOOR]))
    found = {name: len(reading.words) for step in run(world, 0.2) for _, name, reading in step.readings}
    assert found == {name: declared[name] for name in found}


def test_every_light_can_be_reached_by_a_program() -> None:
    natives = [native for actuator in actuators.all_actuators() for native in actuator.aseba.natives]
    sizes = [len(native.parameters) for native in natives if native.name.startswith("leds.")]
    without = ("battery", "sd")  # these are set one by one, with _leds.set
    assert sorted(sizes) == sorted(size for group, size in LED_GROUPS.items() if group not in without)


def test_a_new_sensor_file_is_enough(add_plugin: Callable[[ModuleType, str, str], None]) -> None:
    add_plugin(sensors, "turn_sensor", TOY_SENSOR)
    world = World(make([FLOOR]), noise=False)
    send(world, MotorTargets(-100, 100))
    words = [reading.words for step in run(world, 1.0) for _, name, reading in step.readings if name == "turn_sensor"]
    assert words == [(35,), (71,)]


def test_a_new_sensor_does_not_change_what_the_others_read(add_plugin: Callable[[ModuleType, str, str], None]) -> None:
    def ground() -> list[object]:
        steps = run(World(make([FLOOR]), seed=1), 1.0)
        return [reading for step in steps for _, name, reading in step.readings if name == "ground"]

    before = ground()
    add_plugin(sensors, "turn_sensor", TOY_SENSOR)
    assert ground() == before


def test_a_sensor_that_is_woken_measures_in_that_tick_only(add_plugin: Callable[[ModuleType, str, str], None]) -> None:
    add_plugin(sensors, "ear", TOY_WOKEN_SENSOR)
    world = World(make([FLOOR]), noise=False)
    run(world, 0.1)
    send(world, MotorTargets(0, 0))
    names = [[name for _, name, _ in world.step().readings].count("ear") for _ in range(2)]
    assert names == [1, 0]


def test_a_sensor_that_feels_what_wakes_it_measures_at_its_own_time(
    add_plugin: Callable[[ModuleType, str, str], None],
) -> None:
    add_plugin(sensors, "skin", TOY_FEELING_SENSOR)
    world = World(make([FLOOR]), noise=False)
    for _ in range(3):
        send(world, MotorTargets(0, 0))
        world.step()
    words = [reading.words for step in run(world, 0.1) for _, name, reading in step.readings if name == "skin"]
    assert words == [(3,)]


def test_a_new_shape_file_is_enough(add_plugin: Callable[[ModuleType, str, str], None]) -> None:
    add_plugin(shapes, "gate", TOY_SHAPE)
    loaded = make([FLOOR, {"kind": "gate", "x_m": 0.3}])
    assert [solid.pose.y_m for solid in loaded.solids] == [0.15, -0.15]
    kinds = [item["properties"]["kind"]["const"] for item in reader.schema()["properties"]["shapes"]["items"]["oneOf"]]
    assert "gate" in kinds


def test_a_new_actuator_file_is_enough(add_plugin: Callable[[ModuleType, str, str], None]) -> None:
    add_plugin(actuators, "spring", TOY_ACTUATOR)
    (spring,) = (actuator for actuator in actuators.all_actuators() if actuator.name == "spring")
    world = World(make([FLOOR]), noise=False)
    send(world, spring.accepts[0](1.5))
    world.step()
    assert world.robots["thymio"].pose.x_m == pytest.approx(1.5)


def test_a_new_stimulus_file_tilts_sounds_and_shows(add_plugin: Callable[[ModuleType, str, str], None]) -> None:
    add_plugin(stimuli, "lean", TOY_STIMULUS)
    (lean,) = (stimulus for stimulus in stimuli.all_stimuli() if stimulus.name == "lean")
    world = World(make([FLOOR]), noise=False)
    send(world, lean.accepts[0](0.5))
    heard = [reading.words[0] for step in run(world, 0.1) for _, name, reading in step.readings if name == "sound"]
    robot = world.robots["thymio"]
    assert heard[-1] == 40
    assert robot.tilt.roll_rad == 0.5
    assert robot.snapshot().shown["lean"] == 0.5


@pytest.mark.parametrize(("text", "found"), [("", "NoneType"), ("SENSOR = 3", "int")])
def test_a_file_without_its_export_is_named(
    add_plugin: Callable[[ModuleType, str, str], None], text: str, found: str
) -> None:
    add_plugin(sensors, "broken", text)
    with pytest.raises(RegistryError, match=f"broken: expected SENSOR of type Sensor, found {found}"):
        sensors.all_sensors()


def test_helpers_with_an_underscore_are_left_out(add_plugin: Callable[[ModuleType, str, str], None]) -> None:
    add_plugin(shapes, "_helper", "raise AssertionError")
    assert registry.collect(shapes, "SHAPE", shapes.ShapeKind) == shapes.all_shapes()
