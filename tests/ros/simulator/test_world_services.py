"""Robots come, go and are put somewhere while the simulator runs: by services with reasons, and by a topic."""

from __future__ import annotations

import json
import math

import pytest
from geometry_msgs.msg import Quaternion, Transform, TransformStamped, Vector3
from nav_msgs.msg import Odometry
from rcl_interfaces.msg import Parameter, ParameterType, ParameterValue
from rcl_interfaces.srv import GetParameters, SetParameters
from std_msgs.msg import Header, String
from std_srvs.srv import Trigger

from thymio_sim_ros.sim.commands import MoveRobot
from thymio_sim_ros.sim.playground import reader as playgrounds

GRAY = "#808080"
ROOM = json.dumps(
    {
        "format": 1,
        "title": "Room",
        "shapes": [
            {"kind": "rectangle", "name": "ground", "size_x_m": 2.0, "size_y_m": 2.0, "color": "#ffffff"},
            {"kind": "box", "name": "crate", "x_m": 0.5, "y_m": 0, "size_x_m": 0.1, "size_y_m": 0.1, "height_m": 0.1,
             "color": GRAY, "mass_kg": 0.1},
            {"kind": "cylinder", "name": "post", "x_m": 0, "y_m": 0.5, "radius_m": 0.03, "height_m": 0.1,
             "color": GRAY},
        ],
        "robots": [{"name": "thymio", "x_m": 0.0, "y_m": 0.0}],
    }
)  # fmt: skip


def numbers(*values):
    return ParameterValue(type=ParameterType.PARAMETER_DOUBLE_ARRAY, double_array_value=values)


def ask(ros, service, **values):
    """Reasons by name; an empty one is success."""
    request = SetParameters.Request(parameters=[Parameter(name=name, value=value) for name, value in values.items()])
    results = ros.call(SetParameters, f"/simulator/{service}", request).results
    assert all(result.successful == (not result.reason) for result in results)
    return {name: result.reason for name, result in zip(values, results, strict=True)}


def poses(ros, *names):
    values = ros.call(GetParameters, "/simulator/get_poses", GetParameters.Request(names=names)).values
    return [list(value.double_array_value) for value in values]


def test_the_playground_is_returned_as_json(ros, simulation):
    simulation(playground=ROOM)
    answer = ros.call(Trigger, "/simulator/get_playground", Trigger.Request())
    reported, given = playgrounds.loads(answer.message, "answer.json"), playgrounds.loads(ROOM, "room.json")
    assert answer.success
    assert (reported.shapes, reported.robots) == (given.shapes, given.robots)


def test_the_primitives_of_shapes_are_returned_as_json(ros, simulation):
    simulation(playground=ROOM)
    wall = {"kind": "wall", "start_x_m": 0, "start_y_m": 0, "end_x_m": 1, "end_y_m": 0, "color": "#112233"}
    shapes = ParameterValue(type=ParameterType.PARAMETER_STRING, string_value=json.dumps([wall, {"kind": "hill"}]))
    request = SetParameters.Request(
        parameters=[Parameter(name="a", value=shapes), Parameter(name="b", value=numbers(1.0))]
    )
    answer, refused = ros.call(SetParameters, "/simulator/get_primitives", request).results
    drawn, faulty = json.loads(answer.reason)
    assert drawn["primitives"][0]["size"] == [1.02, 0.02]
    assert faulty["fault"]["key"] == "kind"
    assert [answer.successful, refused.successful] == [True, False]
    assert "expected JSON" in refused.reason


def test_a_robot_is_spawned_and_removed_while_the_world_is_paused(ros, simulation):
    simulation(playground=ROOM)
    states = ros.collect(String, "/simulator/_state")
    assert ask(ros, "spawn", anna=numbers(-0.5, 0.25, 1.5)) == {"anna": ""}
    ros.collect(Odometry, "/anna/_ground_truth/odom")
    ros.until(lambda: [robot["robot"] for robot in json.loads(states[-1].data)["robots"]] == ["thymio", "anna"])
    assert json.loads(states[-1].data)["robots"][1]["frame"] == "anna/base_link"
    assert poses(ros, "anna") == [[-0.5, 0.25, 1.5]]
    assert ask(ros, "remove", anna=ParameterValue()) == {"anna": ""}
    ros.until(lambda: [robot["robot"] for robot in json.loads(states[-1].data)["robots"]] == ["thymio"])


def test_the_state_lists_robots_that_fell(ros, simulation):
    sim = simulation(playground=ROOM)
    states = ros.collect(String, "/simulator/_state")
    ros.until(lambda: states and json.loads(states[-1].data)["robots"][0]["fallen"] is False)
    sim.world.post("thymio", MoveRobot(50.0, 50.0, 0.0))
    sim.until(lambda: json.loads(states[-1].data)["robots"][0]["fallen"] is True)
    assert ask(ros, "set_poses", thymio=numbers(0.0, 0.0)) == {"thymio": ""}
    sim.until(lambda: json.loads(states[-1].data)["robots"][0]["fallen"] is False)


def test_a_robot_that_was_spawned_measures_and_obeys(ros, simulation):
    sim = simulation(playground=ROOM)
    ask(ros, "spawn", anna=numbers(-0.5, 0.25))
    truth = ros.collect(Odometry, "/anna/_ground_truth/odom")
    sim.until(lambda: truth)
    assert truth[-1].pose.pose.position.x == -0.5


@pytest.mark.parametrize(
    ("name", "value", "reason"),
    [
        ("thymio", numbers(-0.5, 0.5), "the name 'thymio' is taken"),
        ("crate", numbers(-0.5, 0.5), "the name 'crate' is taken"),
        ("anna", numbers(0.0, 0.5), "'anna' cannot be placed at 0.000, 0.500 m: occupied by 'post'"),
        ("anna", numbers(1.0), "anna: found [1.0], expected [x, y, yaw] in m and rad"),
        ("anna", ParameterValue(), "anna: found nothing, expected [x, y, yaw] in m and rad"),
        ("an na", numbers(-0.5, 0.5), "name: found 'an na', expected a ROS name"),
        ("anna", numbers(math.nan, 0.5), "x_m: found nan"),
        ("anna", numbers(-0.5, 0.5, math.nan), "yaw_rad: found nan"),
        ("raw", numbers(-0.5, 0.5), "the name 'raw' is taken by topics of the robot that has no name"),
        ("anna", ParameterValue(type=42), "anna: found a value of unknown type 42"),
    ],
)
def test_an_invalid_robot_is_rejected_with_a_reason(ros, simulation, name, value, reason):
    sim = simulation(playground=ROOM)
    assert ask(ros, "spawn", **{name: value})[name].startswith(reason)
    assert list(sim.world.robots) == ["thymio"]


def test_each_name_has_an_answer_of_its_own(ros, simulation):
    sim = simulation(playground=ROOM)
    reasons = ask(ros, "remove", thymo=ParameterValue(), thymio=ParameterValue())
    assert reasons == {"thymo": "found unknown name 'thymo', expected 'thymio' (one of thymio)", "thymio": ""}
    assert not sim.world.robots
    sim.step(0.1)


def test_robots_and_objects_are_moved(ros, simulation):
    sim = simulation(playground=ROOM)
    reasons = ask(ros, "set_poses", thymio=numbers(-0.5, 0.0, 1.0), crate=numbers(0.25, 0.25), post=numbers(0.0, 0.0))
    assert (reasons["thymio"], reasons["crate"]) == ("", "")
    assert reasons["post"] == "found unknown name 'post', expected one of thymio, crate"
    sim.step(0.01)
    thymio, crate, post = poses(ros, "thymio", "crate", "post")
    assert (thymio, crate, post) == ([-0.5, 0.0, 1.0], [0.25, 0.25, 0.0], [])
    assert "occupied by 'post'" in ask(ros, "set_poses", crate=numbers(0.0, 0.5))["crate"]


def test_a_place_without_ground_is_refused_with_the_nearest(ros, simulation):
    sim = simulation(playground=ROOM)
    reason = "there is no ground; the nearest is 'ground' at 1.000, 1.000 m"
    places = ask(ros, "set_poses", thymio=numbers(9.0, 9.0), crate=numbers(9.0, 9.0))
    assert places == {name: f"'{name}' cannot be placed at 9.000, 9.000 m: {reason}" for name in ("thymio", "crate")}
    assert ask(ros, "spawn", anna=numbers(9.0, 9.0)) == {"anna": f"'anna' cannot be placed at 9.000, 9.000 m: {reason}"}
    assert list(sim.world.robots) == ["thymio"]
    assert ask(ros, "set_poses", thymio=numbers(0.99, 0.99)) == {"thymio": ""}  # its middle is on the ground


def test_every_place_of_a_playground_without_ground_is_allowed(ros, simulation):
    simulation(playground=json.dumps(json.loads(ROOM) | {"shapes": []}))
    assert ask(ros, "set_poses", thymio=numbers(9.0, 9.0)) == {"thymio": ""}


@pytest.mark.parametrize("place", [numbers(-0.5, 0.5, math.nan), numbers(math.inf, 0.5)])
def test_an_invalid_pose_is_rejected_and_the_world_continues(ros, simulation, place):
    sim = simulation(playground=json.dumps(json.loads(ROOM) | {"shapes": json.loads(ROOM)["shapes"][:1]}))
    assert "expected finite numbers" in ask(ros, "set_poses", thymio=place)["thymio"]
    sim.step(0.1)


def test_two_are_not_put_into_one_another_by_one_request(ros, simulation):
    simulation(playground=ROOM)
    reasons = ask(ros, "set_poses", thymio=numbers(-0.5, 0.5), crate=numbers(-0.5, 0.5))
    assert reasons == {"thymio": "", "crate": "'crate' cannot be placed at -0.500, 0.500 m: occupied by 'thymio'"}


def transform(child, x, y, yaw=0.0, frame="map"):
    return TransformStamped(
        header=Header(frame_id=frame),
        child_frame_id=child,
        transform=Transform(
            translation=Vector3(x=x, y=y), rotation=Quaternion(z=math.sin(yaw / 2), w=math.cos(yaw / 2))
        ),
    )


@pytest.mark.parametrize(("name", "child"), [("thymio", "thymio"), ("thymio", "base_link"), ("crate", "crate")])
def test_a_dragged_robot_moves(ros, simulation, name, child):
    sim = simulation(playground=ROOM)
    ros.publisher(TransformStamped, "/simulator/_place").publish(transform(child, -0.5, 0.25, 0.5))
    sim.until(lambda: poses(ros, name) == [pytest.approx([-0.5, 0.25, 0.5])], seconds=0.1)


@pytest.mark.parametrize(
    "refused",
    [transform("thymio", 0.0, 0.5), transform("unknown", 0.0, 0.0), transform("crate", 0.0, 0.0, frame="odom")],
)
def test_a_drag_to_nowhere_is_refused_and_counted(ros, simulation, refused):
    sim = simulation(playground=ROOM)
    ros.publisher(TransformStamped, "/simulator/_place").publish(refused)
    ros.until(lambda: sim.simulator._messages.rejected == 1)
    assert poses(ros, "thymio") == [[0.0, 0.0, 0.0]]
