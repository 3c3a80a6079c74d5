"""The robot's menu: which program runs, and what the robot shows meanwhile.

Source: docs/spec/thymio-behaviors.md section 1.
"""

from __future__ import annotations

import pytest

from tests.device.handheld import HandheldRobot
from thymio_sim_ros.device.behavior_host import ENTRIES, MENU, BehaviorHost, built_in, is_internal
from thymio_sim_ros.device.device import AsebaDevice
from thymio_sim_ros.device.options import DeviceOptions
from thymio_sim_ros.device.programs.program import ProgramError, load_program

OWN = load_program("motor.left.target = 100\nonevent button.center\ncall leds.top(1, 2, 3)", "own.aesl")

COLORS = {
    "friendly": (0, 32, 0),
    "explorer": (32, 32, 0),
    "fearful": (32, 0, 0),
    "attentive": (0, 0, 32),
    "investigator": (0, 32, 32),
    "obedient": (32, 0, 32),
    "program": (0, 0, 0),
}


def test_every_behaviour_of_the_menu_is_a_program_that_compiles():
    assert [built_in(name).name for name in ENTRIES.values()] == [f"{name}.aesl" for name in ENTRIES.values()]


@pytest.mark.parametrize("arrow", ["right", "forward"])
def test_right_and_forward_lead_round_through_all_entries(arrow):
    robot = HandheldRobot.switched_on(MENU)
    shown = [robot.top]
    for _ in range(6):
        robot.touch(arrow)
        shown.append(robot.top)
    order = ["friendly", "explorer", "fearful", "attentive", "investigator", "obedient", "friendly"]
    assert shown == [COLORS[name] for name in order]


@pytest.mark.parametrize("arrow", ["left", "backward"])
def test_left_and_backward_lead_the_other_way(arrow):
    robot = HandheldRobot.switched_on(MENU)
    robot.touch(arrow)
    assert robot.top == COLORS["obedient"]


def test_a_held_arrow_moves_on_once():
    robot = HandheldRobot.switched_on(MENU)
    robot.touch("right", ticks=60)
    assert robot.top == COLORS["explorer"]


def test_a_user_s_program_is_the_first_entry_and_black():
    robot = HandheldRobot.switched_on(MENU, OWN)
    assert robot.top == COLORS["program"]
    robot.touch("right")
    assert robot.top == COLORS["friendly"]
    robot.touch("left")
    robot.touch("left")
    assert robot.top == COLORS["obedient"]


def test_the_center_button_is_ignored_for_two_seconds():
    robot = HandheldRobot.switched_on(MENU)
    robot.tick(94)
    robot.touch("center")
    assert robot.running == MENU
    robot.tick(2)
    robot.touch("center")
    assert robot.running == "friendly"


@pytest.mark.parametrize(
    ("steps", "behaviour"),
    [(0, "friendly"), (1, "explorer"), (2, "fearful"), (3, "attentive"), (4, "investigator"), (5, "obedient")],
)
def test_the_centre_button_starts_a_behaviour_and_ends_it_again(steps, behaviour):
    robot = HandheldRobot.switched_on(MENU)
    robot.tick(100)
    for _ in range(steps):
        robot.touch("right")
    robot.touch("center", ticks=30)
    assert robot.running == behaviour
    robot.touch("center", ticks=30)
    assert robot.running == MENU
    assert robot.top == COLORS[behaviour]
    assert robot.targets == (0, 0)
    robot.touch("center")
    assert robot.running == behaviour


def test_the_program_entry_starts_the_user_s_program_for_good():
    robot = HandheldRobot.switched_on(MENU, OWN)
    robot.tick(100)
    robot.touch("center")
    assert robot.running == "own"
    assert robot.targets == (100, 0)
    robot.touch("center")
    assert robot.running == "own"
    assert robot.top == (1, 2, 3)


def begun_anew(robot: HandheldRobot, how: str) -> None:
    """Switched off and on again, or reset and let run; then the menu's two seconds pass."""
    if how == "switched on":
        robot.device.run_control.switch_off()
        robot.tick()
    else:
        robot.device.run_control.reset()
    robot.host.resume()
    robot.tick(100)


@pytest.mark.parametrize("how", ["switched on", "reset"])
def test_a_menu_that_begins_anew_still_has_the_user_s_program(how):
    robot = HandheldRobot.switched_on(MENU, OWN)
    robot.touch("right")
    begun_anew(robot, how)
    assert robot.top == COLORS["program"]
    robot.touch("center")
    assert robot.running == "own"


@pytest.mark.parametrize("entries", [0, 1])
def test_a_robot_that_was_switched_off_in_a_behaviour_is_switched_on_as_at_first(entries):
    robot = HandheldRobot.switched_on(MENU, OWN)
    robot.tick(100)
    for _ in range(entries):
        robot.touch("right")
    robot.touch("center")
    begun_anew(robot, "switched on")
    assert (robot.running, robot.top) == (MENU, COLORS["program"])


def test_a_robot_with_a_program_from_a_computer_is_switched_on_with_that():
    robot = HandheldRobot()
    robot.host.load(asking("mine.aesl", "menu.back", 0, "onevent button.left\nemit menu.back"))
    robot.touch("left")
    robot.touch("right")
    robot.touch("center")
    assert robot.running == "friendly"
    begun_anew(robot, "switched on")
    assert robot.running == "mine"


def test_what_is_not_flashed_is_lost_when_a_robot_is_switched_on_in_a_behaviour():
    robot = HandheldRobot.switched_on(MENU)
    robot.tick(100)
    robot.touch("center")
    robot.device.services.settings[0] = 5
    begun_anew(robot, "switched on")
    assert robot.device.services.settings[0] == 0


def test_a_program_from_a_computer_ends_a_behaviour_with_its_wheels_stopped():
    robot = HandheldRobot.switched_on("obedient")
    robot.touch("forward")
    assert robot.targets == (150, 150)
    robot.host.load(load_program("", "none"))
    robot.tick()
    assert robot.targets == (0, 0)
    robot.touch("forward")
    assert robot.targets == (0, 0)


def asking(name, event, size, code):
    """A user's program that declares one event."""
    network = f'<network><event size="{size}" name="{event}"/><node name="thymio-II">{code}</node></network>'
    return load_program(network, name)


def test_an_own_program_may_open_the_menu_and_is_shown_there():
    robot = HandheldRobot.switched_on("obedient")
    robot.host.load(asking("mine.aesl", "menu.back", 0, "onevent button.left\nemit menu.back"))
    robot.tick()
    robot.touch("left")
    assert robot.running == MENU
    assert robot.top == COLORS["program"]
    robot.touch("center")
    assert robot.running == "mine"


def test_the_touch_that_starts_a_user_s_program_is_no_news_for_it():
    code = "onevent button.center\nif button.center == 1 then\nemit menu.back\nend"
    robot = HandheldRobot.switched_on(MENU, asking("mine.aesl", "menu.back", 0, code))
    robot.tick(100)
    robot.touch("center")
    assert robot.running == "mine"
    robot.touch("center")
    assert robot.running == MENU


def test_what_a_program_asks_of_the_robot_is_no_event_for_others():
    robot = HandheldRobot.switched_on(MENU)
    robot.tick(100)
    robot.touch("center")
    robot.touch("center")
    assert robot.events == []
    assert is_internal("menu.start")
    assert not is_internal("line")


def test_an_unknown_entry_is_reported():
    robot = HandheldRobot()
    robot.host.load(asking("x.aesl", "menu.start", 1, "emit menu.start 42"))
    robot.tick()
    assert robot.host.pop_notices() == ["menu.start 42: the robot has no such program"]
    assert robot.running == "x"


def test_readings_hold_through_a_change_of_program():
    robot = HandheldRobot.switched_on(MENU)
    robot.device.feed("ground", (0, 0, 900, 900, 900, 900))
    robot.tick(100)
    robot.touch("center", ticks=1)
    assert robot.running == "friendly"
    assert robot.device.variables.get("prox.ground.delta") == (900, 900)


def test_a_user_s_program_begins_with_cleared_variables():
    robot = HandheldRobot.switched_on(MENU, OWN)
    robot.device.feed("ground", (0, 0, 900, 900, 900, 900))
    robot.tick(100)
    robot.touch("center", ticks=1)
    assert robot.running == "own"
    assert robot.device.variables.get("prox.ground.delta") == (0, 0)


def test_a_restart_is_as_the_first_start():
    robot = HandheldRobot.switched_on(MENU, OWN)
    robot.tick(100)
    robot.touch("center")
    robot.host.restart()
    robot.tick()
    assert robot.running == MENU
    robot.host.load(OWN)
    robot.host.restart()
    assert robot.running == "own"


@pytest.mark.parametrize("behaviour", [MENU, *ENTRIES.values()])
def test_every_arrow_and_the_centre_sound_once_in_every_behaviour(behaviour):
    robot = HandheldRobot.switched_on(behaviour)
    robot.tick(100)
    for arrow in ("left", "right", "forward", "backward"):
        robot.touch(arrow)
    assert robot.sounds == [2, 2, 2, 2]
    robot.touch("center", ticks=30)
    assert robot.sounds[4:] == [3]
    assert robot.running != behaviour


@pytest.mark.parametrize("behaviour", list(ENTRIES.values()))
def test_lights_go_out_before_another_behaviour_begins(behaviour):
    robot = HandheldRobot.switched_on(behaviour)
    robot.tick(30)
    assert any(robot.top)
    robot.host.load(load_program("", "none"))
    robot.tick()
    assert not any(level for group, levels in robot.leds.items() if group != "temperature" for level in levels)


def test_a_behavior_that_does_not_fit_the_layout_is_reported():
    host = BehaviorHost(AsebaDevice(options=DeviceOptions(layout="playground")))
    host.start("obedient")
    with pytest.raises(ProgramError, match=r"menu\.aesl: line \d+"):
        host.start(MENU)
    assert host.program.name == "obedient.aesl"
