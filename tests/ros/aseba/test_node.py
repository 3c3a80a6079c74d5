"""The Aseba runtime node beside the simulator node, joined by topics only."""

from __future__ import annotations

import json
import math

import pytest
from diagnostic_msgs.msg import DiagnosticStatus
from geometry_msgs.msg import Twist, Vector3
from rcl_interfaces.srv import GetParameters, SetParameters
from rclpy.parameter import Parameter
from std_msgs.msg import Bool, Empty, Float32MultiArray, Int16MultiArray, MultiArrayDimension, MultiArrayLayout, String
from std_srvs.srv import Trigger

from thymio_sim_ros.ros.aseba.node import AsebaRuntime, RuntimeParams
from thymio_sim_ros.ros.rclpy_ext.node_runner import StartError
from thymio_sim_ros.testing import followed_line

AESL = """<!DOCTYPE aesl-source>
<network>
<event size="2" name="pong"/>
<event size="1" name="ping"/>
<constant value="3" name="FACTOR"/>
<node nodeId="1" name="thymio-II">onevent ping
    emit pong [event.args[0] * FACTOR, 7]
</node>
</network>
"""


def values(status):
    return {item.key: item.value for item in status.values}


def test_a_pressed_button_raises_its_event(ros, simulation, runtime):
    sim = simulation()
    runtime("onevent button.center\nif button.center == 1 then\n call leds.top(32, 0, 16)\nend")
    state = ros.collect(Float32MultiArray, "/_led/state", transient_local=True)
    press = ros.publisher(Bool, "/_press/center")
    press.publish(Bool(data=True))
    sim.until(lambda: state and list(state[-1].data[:3]) == [1.0, 0.0, 0.5])


def test_a_program_drives_the_wheels(ros, simulation, runtime):
    sim = simulation()
    runtime("motor.left.target = 200\nmotor.right.target = 200")
    sim.until(lambda: sim.world.robots["thymio"].pose.x_m > 0.05)


def test_emit_reaches_a_topic_and_back(ros, simulation, runtime):
    simulation()
    runtime(AESL)
    pongs = ros.collect(Int16MultiArray, "/aseba/events/pong")
    anything = ros.collect(Int16MultiArray, "/_aseba/events")
    ros.publisher(Int16MultiArray, "/aseba/emit/ping").publish(Int16MultiArray(data=[5]))
    ros.until(lambda: pongs and anything)
    assert list(pongs[0].data) == [15, 7]
    assert [(dim.label, dim.size) for dim in anything[0].layout.dim] == [("pong", 2)]


def test_the_generic_pair_carries_any_event(ros, simulation, runtime):
    simulation()
    runtime(AESL)
    pongs = ros.collect(Int16MultiArray, "/aseba/events/pong")
    message = Int16MultiArray(
        layout=MultiArrayLayout(dim=[MultiArrayDimension(label="ping", size=1, stride=1)]), data=[-2]
    )
    ros.publisher(Int16MultiArray, "/_aseba/emit").publish(message)
    ros.until(lambda: pongs)
    assert list(pongs[0].data) == [-6, 7]


def test_events_of_the_wrong_size_are_refused(ros, simulation, runtime):
    simulation()
    runtime(AESL)
    pongs = ros.collect(Int16MultiArray, "/aseba/events/pong")
    publisher = ros.publisher(Int16MultiArray, "/aseba/emit/ping")
    publisher.publish(Int16MultiArray(data=[1, 2]))
    publisher.publish(Int16MultiArray(data=[4]))
    ros.until(lambda: pongs)
    assert [list(pong.data) for pong in pongs] == [[12, 7]]


def test_a_program_that_does_not_compile_is_refused_with_its_place(ros, simulation, runtime):
    simulation()
    runtime("var a = 1")
    status = ros.collect(DiagnosticStatus, "/_aseba/status", transient_local=True)
    bad = set_parameters(ros, {"script.source": "var a\n  motor.left.targt = 5", "script.name": "bad.aesl"})
    assert not bad.successful
    assert "line 2, column 3" in bad.reason
    assert "motor.left.target" in bad.reason
    answer = ros.call(GetParameters, "/aseba_runtime/get_parameters", GetParameters.Request(names=["script.source"]))
    assert answer.values[0].string_value == "var a = 1"
    good = set_parameters(ros, {"script.source": "motor.left.target = 5", "script.name": "good.aesl"})
    assert good.successful, good.reason
    ros.until(lambda: values(status[-1])["program"] == "good.aesl")
    assert values(status[-1])["state"] == "running"


def set_parameters(ros, wanted):
    parameters = [Parameter(name, value=value).to_parameter_msg() for name, value in wanted.items()]
    from rcl_interfaces.srv import SetParametersAtomically

    request = SetParametersAtomically.Request(parameters=parameters)
    return ros.call(SetParametersAtomically, "/aseba_runtime/set_parameters_atomically", request).result


def test_a_fault_is_reported_with_its_line_and_stops_the_wheels(ros, simulation, runtime):
    sim = simulation()
    runtime("var i = 9\nvar t[3]\nmotor.left.target = 100\nmotor.right.target = 100\nonevent button.center\n t[i] = 1")
    status = ros.collect(DiagnosticStatus, "/_aseba/status", transient_local=True)
    sim.until(lambda: sim.world.robots["thymio"].pose.x_m > 0.01)
    ros.publisher(Bool, "/_press/center").publish(Bool(data=True))
    sim.until(lambda: status and values(status[-1])["state"] == "fault")
    assert values(status[-1])["line"] == "6"
    assert status[-1].level == DiagnosticStatus.ERROR
    sim.step(0.2)
    stopped = sim.world.robots["thymio"].pose
    sim.step(0.5)
    assert sim.world.robots["thymio"].pose == stopped


def test_run_control_by_services(ros, simulation, runtime):
    sim = simulation()
    runtime("motor.left.target = 100\nmotor.right.target = 100")
    sim.until(lambda: sim.world.robots["thymio"].pose.x_m > 0.01)
    assert ros.call(Trigger, "/aseba/stop").message == "stopped"
    sim.step(0.2)
    stopped = sim.world.robots["thymio"].pose
    sim.step(0.3)
    assert sim.world.robots["thymio"].pose == stopped
    assert ros.call(Trigger, "/aseba/reset").success
    assert ros.call(Trigger, "/aseba/run").message == "running"
    sim.until(lambda: sim.world.robots["thymio"].pose.x_m > stopped.x_m + 0.01)


def test_a_robot_that_is_discovered_later_gets_the_first_commands(ros, simulation, runtime):
    runtime("motor.left.target = 100\nmotor.right.target = 100\ncall leds.top(32, 0, 0)")
    sim = simulation(playground="base")

    def is_told():
        sim.tick()
        return sim.thymio.speed > 0.02 and sim.thymio.leds["top"] == (32, 0, 0)

    ros.until(is_told)


def test_timers_follow_simulated_time(ros, simulation, runtime):
    sim = simulation()
    runtime(
        '<network><event size="1" name="tick"/><node name="thymio-II">var n = 0\ntimer.period[0] = 200\n'
        "onevent timer0\nn = n + 1\nemit tick n</node></network>"
    )
    ticks = ros.collect(Int16MultiArray, "/aseba/events/tick")
    sim.until(lambda: len(ticks) >= 5, seconds=1.5)
    assert [list(tick.data) for tick in ticks[:5]] == [[1], [2], [3], [4], [5]]


def test_a_reset_of_the_simulator_restarts_the_program(ros, simulation, runtime):
    sim = simulation()
    runtime(
        '<network><event size="1" name="count"/><node name="thymio-II">var n = 0\n'
        "onevent button.forward\nif button.forward == 1 then\nn = n + 1\nemit count n\nend</node></network>"
    )
    counts = ros.collect(Int16MultiArray, "/aseba/events/count")
    press = ros.publisher(Bool, "/_press/forward")
    for expected in (1, 2):
        press.publish(Bool(data=True))
        sim.until(lambda n=expected: counts and list(counts[-1].data) == [n])
        press.publish(Bool(data=False))
        sim.step(0.2)
    ros.call(Trigger, "/simulator/reset")
    sim.step(0.5)
    press.publish(Bool(data=True))
    sim.until(lambda: len(counts) == 3)
    assert list(counts[-1].data) == [1]


def test_the_line_program_follows_the_line_for_a_lap(ros, simulation, runtime):
    sim = simulation(playground="line")
    runtime(path="line_follower")
    sim.until(followed_line(sim.thymio, within=0.04), seconds=120.0)


def test_cmd_vel_takes_over_and_gives_back(ros, simulation, runtime):
    sim = simulation(cmd_vel_timeout=0.3)
    runtime("motor.left.target = 100\nmotor.right.target = 100")
    sim.until(lambda: sim.world.robots["thymio"].pose.x_m > 0.01)
    before = sim.world.robots["thymio"].pose
    ros.publisher(Twist, "/cmd_vel").publish(Twist(linear=Vector3(x=-0.1)))
    sim.until(lambda: sim.world.robots["thymio"].pose.x_m < before.x_m - 0.01)
    lowest = sim.world.robots["thymio"].pose.x_m
    sim.until(lambda: sim.world.robots["thymio"].pose.x_m > lowest + 0.02)


TWO_ROBOTS = """{"format": 1, "title": "Two", "shapes": [
    {"kind": "rectangle", "size_x_m": 2.0, "size_y_m": 2.0, "color": "#ffffff"}],
    "robots": [{"name": "anna", "x_m": 0.0, "y_m": 0.5}, {"name": "bert", "x_m": 0.0, "y_m": -0.5}]}"""

TALK = """<network><event size="1" name="hello"/><node name="thymio-II">
motor.left.target = 50
motor.right.target = 50
onevent button.center
if button.center == 1 then
emit hello 21
end
onevent hello
call leds.top(event.args[0], 0, 0)
</node></network>"""


def test_a_playground_with_other_robots_gives_each_its_program(ros, simulation, runtime):
    sim = simulation()
    runtime(TALK)
    sim.until(lambda: sim.world.robots["thymio"].pose.x_m > 0.01)
    request = SetParameters.Request(parameters=[Parameter("playground", value=TWO_ROBOTS).to_parameter_msg()])
    assert ros.call(SetParameters, "/simulator/set_parameters", request).results[0].successful
    press = ros.publisher(Bool, "/anna/_press/center")
    heard = ros.collect(Float32MultiArray, "/bert/_led/state", transient_local=True)
    sim.until(lambda: all(robot.pose.x_m > 0.01 for robot in sim.world.robots.values()))
    press.publish(Bool(data=True))
    sim.until(lambda: heard and heard[-1].data[0] > 0.5)
    assert ros.node.count_publishers("/_motor/target") == 0


def test_parameters_describe_themselves(ros, simulation, runtime):
    simulation()
    runtime()
    from rcl_interfaces.srv import DescribeParameters

    request = DescribeParameters.Request(names=["real_time_factor", "motor_model"])
    factor, model = ros.call(DescribeParameters, "/simulator/describe_parameters", request).descriptors
    assert "as fast as possible" in factor.description
    assert factor.floating_point_range[0].to_value == 1000.0
    assert model.read_only
    assert model.additional_constraints == "one of: ideal, firmware"
    assert not ros.call(SetParameters, "/simulator/set_parameters", too_fast()).results[0].successful


def too_fast():
    return SetParameters.Request(parameters=[Parameter("real_time_factor", value=5000.0).to_parameter_msg()])


def test_a_robot_without_a_program_is_switched_on_with_its_menu(ros, simulation, runtime):
    sim = simulation()
    runtime()
    status = ros.collect(DiagnosticStatus, "/_aseba/status", transient_local=True)
    shown = ros.collect(Float32MultiArray, "/_led/state", transient_local=True)
    events = ros.collect(Int16MultiArray, "/_aseba/events")
    center = ros.publisher(Bool, "/_press/center")
    right = ros.publisher(Bool, "/_press/right")
    sim.until(lambda: shown and list(shown[-1].data[:3]) == [0.0, 1.0, 0.0], what="the color of friendly")
    sim.until(lambda: status and values(status[-1])["program"] == "menu.aesl")
    right.publish(Bool(data=True))
    sim.until(lambda: list(shown[-1].data[:3]) == [1.0, 1.0, 0.0], what="the color of explorer")
    sim.step(2.2)
    center.publish(Bool(data=True))
    sim.until(lambda: values(status[-1])["program"] == "explorer.aesl")
    center.publish(Bool(data=False))
    sim.until(lambda: sim.world.robots["thymio"].pose.x_m > 0.02)
    center.publish(Bool(data=True))
    sim.until(lambda: values(status[-1])["program"] == "menu.aesl")
    assert events == []


def test_a_program_ends_a_behaviour_and_waits_in_the_menu(ros, simulation, runtime):
    sim = simulation()
    runtime(behaviour="obedient")
    status = ros.collect(DiagnosticStatus, "/_aseba/status", transient_local=True)
    ros.publisher(Bool, "/_press/forward").publish(Bool(data=True))
    sim.until(lambda: sim.world.robots["thymio"].pose.x_m > 0.01)
    assert set_parameters(ros, {"script.source": "var a = 1", "script.name": "mine"}).successful
    sim.step(0.3)
    stopped = sim.world.robots["thymio"].pose
    sim.step(0.3)
    assert sim.world.robots["thymio"].pose == stopped
    sim.until(lambda: values(status[-1])["program"] == "mine")
    shown = ros.collect(Float32MultiArray, "/_led/state", transient_local=True)
    assert set_parameters(ros, {"behaviour": "menu"}).successful
    sim.until(lambda: values(status[-1])["program"] == "menu.aesl")
    sim.until(lambda: shown and list(shown[-1].data[:3]) == [0.0, 0.0, 0.0], what="the black of one's own program")


def test_built_in_behaviours_are_published_as_a_list(ros, simulation, runtime):
    simulation()
    runtime("var a = 1")
    lists = ros.collect(String, "/aseba_runtime/_behaviours", transient_local=True)
    ros.until(lambda: lists)
    listed = {entry["name"]: entry["description"] for entry in json.loads(lists[-1].data)}
    assert listed["explorer"].startswith("Explorer, yellow: drives about")
    assert {"menu", "line_follower", "thesis_basic"} <= listed.keys()


def test_a_behaviour_that_does_not_exist_is_refused(ros, simulation, runtime):
    simulation()
    runtime("var a = 1")
    result = set_parameters(ros, {"behaviour": "freindly"})
    assert not result.successful
    assert "did you mean 'friendly'?" in result.reason


def test_internal_events_have_no_topic(ros, simulation, runtime):
    simulation()
    runtime(path="menu")
    ros.until(lambda: ros.node.count_publishers("/_aseba/events"))
    topics = {name for name, _ in ros.node.get_topic_names_and_types()}
    assert not [name for name in topics if "menu" in name]


SOUND = """<network><event size="0" name="done"/><node name="thymio-II">
call sound.freq(440, 10)
onevent sound.finished
    emit done
</node></network>"""


def test_the_sound_of_a_program_is_published_and_its_end_reported(ros, simulation, runtime):
    sim = simulation()
    reported = ros.collect(Float32MultiArray, "/_sound/state")
    runtime(SOUND)
    done = ros.collect(Int16MultiArray, "/aseba/events/done")
    sim.until(lambda: done, what="the end of the sound")
    (hertz, seconds, volume), *_, silence = (list(message.data) for message in reported)
    assert (hertz, volume) == (440.0, 1.0)
    assert math.isclose(seconds, 10 * 0.016384, rel_tol=1e-5)
    assert silence[:2] == [0.0, 0.0]


def test_a_touched_button_lights_up_until_a_program_takes_its_lights(ros, simulation, runtime):
    sim = simulation()
    runtime("onevent button.left\ncall leds.buttons(0, 0, 0, 16)")
    shown = ros.collect(Float32MultiArray, "/_led/state", transient_local=True)

    def lights():
        labels = [dimension.label for dimension in shown[-1].layout.dim]
        begin = sum(dimension.size for dimension in shown[-1].layout.dim[: labels.index("buttons")])
        return list(shown[-1].data[begin : begin + 4])

    ros.publisher(Bool, "/_press/forward").publish(Bool(data=True))
    sim.until(lambda: shown and lights() == [1.0, 0.0, 0.0, 0.0], what="the light of the button")
    ros.publisher(Bool, "/_press/left").publish(Bool(data=True))
    sim.until(lambda: lights() == [0.0, 0.0, 0.0, 0.5], what="the program's lights")


def test_a_robot_is_switched_off_and_on_again(ros, simulation, runtime):
    sim = simulation()
    runtime("motor.left.target = 200\nmotor.right.target = 200")
    status = ros.collect(DiagnosticStatus, "/_aseba/status", transient_local=True)
    sim.until(lambda: sim.world.robots["thymio"].pose.x_m > 0.02)
    ros.publisher(Empty, "/shutdown").publish(Empty())
    sim.until(lambda: status and values(status[-1])["state"] == "off")
    sim.step(0.3)
    stopped = sim.world.robots["thymio"].pose
    sim.step(0.3)
    assert sim.world.robots["thymio"].pose == stopped
    assert ros.call(Trigger, "/aseba/run").success
    sim.until(lambda: sim.world.robots["thymio"].pose.x_m > stopped.x_m + 0.02)


def test_a_robot_that_was_switched_on_with_the_menu_is_so_again(ros, simulation, runtime):
    sim = simulation()
    runtime(behaviour="menu")
    status = ros.collect(DiagnosticStatus, "/_aseba/status", transient_local=True)
    center = ros.publisher(Bool, "/_press/center")
    sim.step(2.2)
    center.publish(Bool(data=True))
    sim.until(lambda: status and values(status[-1])["program"] == "friendly.aesl")
    ros.publisher(Empty, "/shutdown").publish(Empty())
    sim.until(lambda: values(status[-1])["state"] == "off")
    assert ros.call(Trigger, "/aseba/run").success
    sim.until(lambda: (values(status[-1])["program"], values(status[-1])["state"]) == ("menu.aesl", "running"))


def test_a_program_writes_on_its_card(ros, simulation, runtime, tmp_path):
    sim = simulation()
    runtime("var s\nvar n\ncall sd.open(1, s)\ncall sd.write([5], n)", card=str(tmp_path / "card"))
    sim.until(lambda: (tmp_path / "card" / "u1.dat").exists())
    assert (tmp_path / "card" / "u1.dat").read_bytes() == b"\x05\x00"


@pytest.mark.parametrize(
    ("parameters", "found"),
    [
        ({"layout": "aseba"}, "layout 'aseba' found, expected one of thymio, playground"),
        ({"events": "none"}, "events 'none' found"),
        ({"card": "/dev/null"}, "card /dev/null: File exists; expected a folder"),
    ],
)
def test_an_invalid_robot_is_rejected_at_the_start(ros, parameters, found):
    with pytest.raises(StartError, match=found):
        AsebaRuntime(ros.context, RuntimeParams(**parameters))
