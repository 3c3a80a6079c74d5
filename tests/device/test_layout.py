"""Where variables and natives lie: on the robot, and in the reference playground."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from aseba_vm import TargetDescription
from thymio_sim_ros.device.device import AsebaDevice
from thymio_sim_ros.device.layout import LAYOUTS, PLAYGROUND, THYMIO, target
from thymio_sim_ros.device.options import DeviceOptions
from thymio_sim_ros.device.programs.program import load_program

DATA = Path(__file__).parents[1] / "data"
REFERENCES = {THYMIO: "thymio2", PLAYGROUND: "thymio2_playground"}
TABLE = json.loads((DATA / "device" / "variables.json").read_text())


def device(layout: str) -> AsebaDevice:
    return AsebaDevice(node_id=5, options=DeviceOptions(layout=layout))


@pytest.mark.parametrize("layout", LAYOUTS)
def test_a_layout_begins_with_that_of_its_reference(layout: str) -> None:
    targets = json.loads((DATA / "vectors" / "aseba-targets.json").read_text())
    reference, ours = TargetDescription.from_data(targets[REFERENCES[layout]]), target(layout)
    variables, events, natives = reference.variables, reference.local_events, reference.natives
    assert [(v.name, v.size) for v in ours.variables[: len(variables)]] == [(v.name, v.size) for v in variables]
    assert [e.name for e in ours.local_events[: len(events)]] == [e.name for e in events]
    assert [(n.name, [p.size for p in n.parameters]) for n in ours.natives[: len(natives)]] == [
        (n.name, [p.size for p in n.parameters]) for n in natives
    ]
    sizes = (ours.variables_size - ours.variables_end, ours.bytecode_size, ours.stack_size)
    assert sizes == (reference.variables_size - reference.variables_end, reference.bytecode_size, reference.stack_size)


@pytest.mark.parametrize("layout", LAYOUTS)
def test_every_variable_lies_where_the_table_says(layout: str) -> None:
    expected = {name: (places[layout], size) for name, size, places in TABLE["variables"] if layout in places}
    assert target(layout).addresses.items() >= expected.items()


@pytest.mark.parametrize("layout", LAYOUTS)
def test_natives_have_the_numbers_of_the_table(layout: str) -> None:
    expected = TABLE["natives"][layout]
    assert [native.name for native in target(layout).natives[: len(expected)]] == expected


@pytest.mark.parametrize(("layout", "firmware"), [(THYMIO, (14, 1)), (PLAYGROUND, (11, 0))])
def test_a_robot_names_itself(layout: str, firmware: tuple[int, int]) -> None:
    robot = device(layout)
    found = [robot.variables.get(name) for name in ("_id", "event.source", "_productId", "_fwversion", "sd.present")]
    assert found == [(5,), (5,), (8,), firmware, (0,)]


def test_a_playground_s_robot_begins_at_22_degrees() -> None:
    assert device(PLAYGROUND).variables.get("temperature") == (220,)


@pytest.mark.parametrize("layout", LAYOUTS)
def test_programs_of_either_layout_see_and_move_the_same_robot(layout: str) -> None:
    source = (
        "var seen[2]\nonevent prox\nseen = [prox.horizontal[2], prox.ground.delta[1]]\n"
        "motor.left.target = 100\ncall leds.bottom.left(1, 2, 3)\ncall leds.circle(1, 2, 3, 4, 5, 6, 7, 8)"
    )
    robot = device(layout)
    robot.load(load_program(source, "program", layout))
    robot.pop_commands()
    robot.feed("ground", (0, 0, 900, 800, 900, 800))
    robot.feed("proximity", (0, 0, 4000, 0, 0, 0, 0))
    robot.run(1000)
    assert robot.variables.get("seen") == (4000, 800)
    reported = [str(command) for command in robot.pop_commands()]
    assert reported == [
        "SetLeds(group='bottom_left', levels=(1, 2, 3))",
        "SetLeds(group='circle', levels=(1, 2, 3, 4, 5, 6, 7, 8))",
        "MotorTargets(left=100, right=0)",
    ]


def test_a_program_of_the_other_layout_is_not_run() -> None:
    with pytest.raises(ValueError, match="a program for the layout playground found, expected thymio"):
        device(THYMIO).load(load_program("", "program", PLAYGROUND))
