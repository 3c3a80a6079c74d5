"""docs/plugins.md: its package, as shown, joins the simulator end to end."""

from __future__ import annotations

import json
import logging
import math
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager
from pathlib import Path

import pytest

from tests import plugin_page
from tests.sim.builders import FLOOR, make
from thymio_sim_ros.device.layout import target
from thymio_sim_ros.device.programs.program import load_program
from thymio_sim_ros.engine.engine import Engine
from thymio_sim_ros.files import resources
from thymio_sim_ros.files.loading import load_playground, read_program, shipped_behaviours
from thymio_sim_ros.sim import actuators, sensors, shapes
from thymio_sim_ros.sim.model.primitives import Disc
from thymio_sim_ros.sim.playground import reader
from thymio_sim_ros.sim.playground.drawings import drawings
from thymio_sim_ros.sim.world import World
from thymio_sim_ros.web import Content

SLALOM = Path(__file__).parent / "data" / "web" / "slalom.json"
DRAWINGS = SLALOM.with_name("drawings.json")
Variant = Callable[[str, str, str], AbstractContextManager[None]]


@pytest.fixture
def extras(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """The page's package."""
    with plugin_page.installed(tmp_path, plugin_page.files(), monkeypatch):
        yield


@pytest.fixture
def variant(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Variant:
    """`with variant(file, old, new)`: the page's package with one text replaced in one file."""

    def install(name: str, old: str, new: str) -> AbstractContextManager[None]:
        shown = plugin_page.files()
        assert old in shown[name]
        return plugin_page.installed(tmp_path, {**shown, name: shown[name].replace(old, new)}, monkeypatch)

    return install


def test_the_page_shows_one_file_for_each_thing() -> None:
    assert sorted(plugin_page.files()) == [
        "pyproject.toml",
        "thymio_extras/behaviours/go_north.aesl",
        "thymio_extras/compass.py",
        "thymio_extras/hop.py",
        "thymio_extras/playgrounds/slalom_field.json",
        "thymio_extras/rover.py",
        "thymio_extras/slalom.py",
    ]


@pytest.mark.usefixtures("extras")
def test_its_parts_stand_among_ours_in_name_order() -> None:
    for found in (
        [sensor.name for sensor in sensors.all_sensors()],
        [actuator.name for actuator in actuators.all_actuators()],
        [kind.name for kind in shapes.all_shapes()],
    ):
        assert found == sorted(found)
        assert {"compass", "hop", "slalom"} & set(found)
    assert "slalom_field" in resources.playgrounds()
    assert "go_north" in resources.behaviours()


@pytest.mark.usefixtures("extras")
def test_a_program_knows_its_variable_its_event_and_its_native() -> None:
    described = target()
    assert "compass.heading" in described.addresses
    assert "compass" in {event.name for event in described.local_events}
    assert "hop" in {native.name for native in described.natives}


@pytest.mark.usefixtures("extras")
def test_the_behaviour_finds_the_north_with_the_sensor_and_hops_with_the_actuator() -> None:
    engine = Engine(load_playground("slalom_field")[1], read_program("go_north"))
    (robot,) = engine.world.robots.values()
    before = robot.pose
    engine.run(6.0)
    assert math.degrees(robot.pose.yaw_rad) == pytest.approx(90, abs=15)
    assert robot.pose.y_m - before.y_m == pytest.approx(0.15, abs=0.02)


@pytest.mark.usefixtures("extras")
def test_the_shape_becomes_primitives_and_part_of_the_schema() -> None:
    posts = [solid for solid in load_playground("slalom_field")[1].solids if isinstance(solid.outline, Disc)]
    assert [post.pose.x_m for post in posts] == pytest.approx([-0.5, -0.25, 0.0, 0.25, 0.5])
    kinds = reader.schema()["properties"]["shapes"]["items"]["oneOf"]
    assert "slalom" in [kind["properties"]["kind"]["const"] for kind in kinds]


@pytest.mark.usefixtures("extras")
def test_the_server_of_the_page_declares_the_shape_with_its_labels_and_its_sample() -> None:
    document = Content(None, b"{}").find("/shapes.json")
    assert document is not None
    assert document.media_type == "application/json"
    shapes_by_name = json.loads(document.body)["shapes"]
    assert {"box", "slalom"} <= set(shapes_by_name)
    slalom = shapes_by_name["slalom"]
    assert slalom["labels"]["de"] == "Slalomstangen"
    assert slalom["field_labels"]["gap_m"]["en"] == "Gap"
    assert slalom["fields"]["gap_m"]["default"] == 0.25
    assert [part["pose"]["x"] for part in slalom["primitives"]] == pytest.approx([0.0, 0.25, 0.5, 0.75, 1.0])
    assert slalom == json.loads(SLALOM.read_text()), "the declaration that tests/web_ui/plugin_shape.test.js reads"


@pytest.mark.usefixtures("extras")
def test_the_answers_that_the_tests_of_the_page_use_are_those_of_the_simulator() -> None:
    records = json.loads(DRAWINGS.read_text())
    assert "slalom" in {record["shape"]["kind"] for record in records}
    found = json.loads(drawings(json.dumps([record["shape"] for record in records])))
    assert found == [record["drawing"] for record in records]


@pytest.mark.parametrize(
    ("name", "old", "new", "said"),
    [
        ("thymio_extras/compass.py", "import math", "import no_such_module", "ModuleNotFoundError"),
        ("thymio_extras/compass.py", "SENSOR = Sensor(", "OTHER = Sensor(", "expected SENSOR of type Sensor"),
        ("thymio_extras/compass.py", 'name="compass"', 'name="proximity"', "which exists"),
        ("thymio_extras/compass.py", 'name="compass"', 'name="My Compass"', "small letters"),
        ("pyproject.toml", '"thymio_extras.compass"', '"thymio_extras.nowhere"', "ModuleNotFoundError"),
        ("thymio_extras/compass.py", "from __future__", "raise SystemError\nfrom __future__", "SyntaxError"),
    ],
)
def test_a_broken_one_is_named_and_the_others_go_on(
    variant: Variant, caplog: pytest.LogCaptureFixture, name: str, old: str, new: str, said: str
) -> None:
    with variant(name, old, new):
        assert "compass" not in [sensor.name for sensor in sensors.all_sensors()]
        assert "hop" in [actuator.name for actuator in actuators.all_actuators()]
        World(make([FLOOR])).step()
    (reported,) = (record.getMessage() for record in caplog.records)
    assert reported.startswith("plug-in 'compass' of the package thymio_extras (thymio_sim_ros.sensors) is left out")
    assert said in reported


@pytest.mark.parametrize(
    ("name", "old", "new", "said"),
    [
        ("compass", '("compass.heading", 1)', '("prox.horizontal", 1)', "variable prox.horizontal"),
        ("hop", 'Native("hop", ("millimeters",)', 'Native("leds.top", ("millimeters",)', "native leds.top"),
    ],
)
def test_programs_see_nothing_of_one_that_does_not_fit_the_robot(
    variant: Variant, caplog: pytest.LogCaptureFixture, name: str, old: str, new: str, said: str
) -> None:
    with variant(f"thymio_extras/{name}.py", old, new):
        engine = Engine(make([FLOOR]), load_program("motor.left.target = 100", "a"))
        engine.run(0.2)
        assert name in {plugin.name for plugin in (*sensors.all_sensors(), *actuators.all_actuators())}
    (reported,) = (record.getMessage() for record in caplog.records)
    assert reported.startswith(f"programs see nothing of the plug-in '{name}': {said}")


def test_a_folder_that_is_missing_is_named(variant: Variant, caplog: pytest.LogCaptureFixture) -> None:
    with variant("pyproject.toml", '"thymio_extras.playgrounds"', '"thymio_extras.worlds"'):
        assert "line" in resources.playgrounds()
    assert "plug-in 'thymio_extras'" in caplog.text


def test_a_sensor_that_raises_is_switched_off_until_the_next_reset(
    variant: Variant, caplog: pytest.LogCaptureFixture
) -> None:
    with variant("thymio_extras/compass.py", "    heading = ", "    heading = 1 / 0 + "):
        world = World(make([FLOOR]))
        for _ in range(100):
            world.step()
        assert [record.levelno for record in caplog.records] == [logging.ERROR]
        assert "the sensor 'compass'" in caplog.text
        world.reset()
        for _ in range(100):
            world.step()
        assert len(caplog.records) == 2


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("        view.place(", "        view.fly("),
        ("    spring.distance_m = command", "    spring.speed_m_s = command"),
        ("class Spring:\n", "class Spring:\n    def __post_init__(self) -> None:\n        raise OSError\n\n"),
    ],
)
def test_an_actuator_that_raises_is_switched_off(
    variant: Variant, caplog: pytest.LogCaptureFixture, old: str, new: str
) -> None:
    with variant("thymio_extras/hop.py", old, new):
        world = World(make([FLOOR]))
        (hop,) = (actuator for actuator in actuators.all_actuators() if actuator.name == "hop")
        for _ in range(10):
            world.post("thymio", hop.accepts[0](0.1))
            world.step()
        assert world.robots["thymio"].pose.x_m == 0.0
    assert [record.levelno for record in caplog.records] == [logging.ERROR]
    assert "the actuator 'hop'" in caplog.text


def test_a_shape_that_raises_refuses_the_playground_with_its_key(variant: Variant) -> None:
    broken = "raise KeyError(name)\n        number = "
    with variant("thymio_extras/slalom.py", "number = ", broken):
        path = resources.find_playground("slalom_field")
        with pytest.raises(reader.PlaygroundError, match=r"shapes\[1\]: found KeyError: 'posts'"):
            reader.load(path)


def test_a_shape_with_a_field_that_no_file_has_is_left_out(variant: Variant, caplog: pytest.LogCaptureFixture) -> None:
    with variant("thymio_extras/slalom.py", "    x_m: Coordinate\n", "    x_m: float\n"):
        assert "slalom" not in {kind.name for kind in shapes.all_shapes()}
        assert "a field of type <class 'float'> found" in caplog.text
        assert "slalom" not in str(reader.schema()["properties"]["shapes"])


@pytest.mark.usefixtures("extras")
def test_its_behaviour_is_listed_with_its_first_comment() -> None:
    assert shipped_behaviours()["go_north"] == "Turn to the north (90 degrees), hop there, and stop."


@pytest.mark.parametrize("broken", ["<network>", "<network><node", "caf\udce9"])
def test_a_behaviour_that_cannot_be_read_is_left_out_of_the_list(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture, broken: str
) -> None:
    with plugin_page.installed(tmp_path, plugin_page.files(), monkeypatch):
        path = tmp_path / "thymio_extras" / "behaviours" / "go_north.aesl"
        path.write_bytes(broken.encode("utf-8", "surrogateescape"))
        found = shipped_behaviours()
    assert "go_north" not in found
    assert "friendly" in found
    assert f"the behaviour {path} is left out" in caplog.text


@pytest.mark.usefixtures("extras")
def test_a_robot_can_be_switched_on_with_its_behaviour() -> None:
    engine = Engine(load_playground("slalom_field")[1], behaviour="go_north")
    (robot,) = engine.world.robots.values()
    engine.run(6.0)
    assert math.degrees(robot.pose.yaw_rad) == pytest.approx(90, abs=15)
