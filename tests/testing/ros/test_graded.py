"""Under `thymio-sim grade`, programs reach the topics of robots; the world belongs to the test."""

import json
from collections.abc import Iterator

import pytest
from geometry_msgs.msg import PoseWithCovarianceStamped, Twist, Vector3
from nav_msgs.msg import Odometry
from rcl_interfaces.msg import Parameter, ParameterValue
from rcl_interfaces.srv import SetParameters
from std_msgs.msg import Bool
from std_srvs.srv import Trigger
from visualization_msgs.msg import MarkerArray

from thymio_sim_ros.pytest_plugin import GRADED, Graded
from thymio_sim_ros.ros.compat.tf2_messages import TFMessage
from thymio_sim_ros.ros.simulator.world_services import SERVICES
from thymio_sim_ros.testing import no_contact

LISTS = """
import json, time
import rclpy
rclpy.init()
node = rclpy.create_node("lists")
time.sleep(2)
shown = {
    "services": [name for name, _ in node.get_service_names_and_types()],
    "publishers": [name for name, _ in node.get_topic_names_and_types() if node.count_publishers(name)],
    "subscribers": [name for name, _ in node.get_topic_names_and_types() if node.count_subscribers(name)],
}
print(json.dumps(shown))
"""
OF_ROBOT = {"/cmd_vel", "/odom", "/proximity/center", "/ground/left", "/tf", "/clock"}
OF_WORLD = {"/_markers", "/_markers/objects", "/simulator/_overview", "/_ground_truth/odom", "/map"}
OF_OPERATOR = {"/initialpose", "/simulator/_place", "/_press/forward", "/_press/ground", "/_press/lift"}


@pytest.fixture
def graded(pytestconfig: pytest.Config, tmp_path) -> Iterator[None]:
    """Fixtures work as under `thymio-sim grade`."""
    pytestconfig.stash[GRADED] = Graded(tmp_path)
    yield
    del pytestconfig.stash[GRADED]


@pytest.mark.process
def test_a_program_sees_the_topics_of_the_robot_only(graded, ros, simulation, runtime, tmp_path) -> None:
    (tmp_path / "lists.py").write_text(LISTS)
    sim = simulation(publish_map=True)
    runtime("var a")
    program = ros.run(tmp_path / "lists.py")
    sim.step(2.5)
    shown = json.loads(program.output)
    assert {name for name in shown["services"] if name.startswith("/simulator/")} <= {"/simulator/get_type_description"}
    assert not [name for name in shown["services"] if "parameters" in name and not name.startswith("/lists/")]
    assert set(shown["publishers"]) >= OF_ROBOT - {"/cmd_vel"}
    assert not OF_WORLD & set(shown["publishers"])
    assert "/cmd_vel" in shown["subscribers"]
    assert not OF_OPERATOR & set(shown["subscribers"])


def test_the_test_has_services_parameters_and_topics_of_the_world(graded, ros, simulation) -> None:
    sim = simulation(noise=False)
    assert all(ros._local_nodes()[0].service(f"/simulator/{name[2:]}") for name in SERVICES)
    poses = SetParameters.Request(parameters=[_parameter("thymio", double_array_value=[0.1, 0.0, 0.0], type=8)])
    assert ros.call(SetParameters, "/simulator/set_poses", poses).results[0].successful
    sim.step(0.1)
    assert sim.thymio.pose.x_m == pytest.approx(0.1)
    wanted = SetParameters.Request(parameters=[_parameter("playground", string_value="line", type=4)])
    assert ros.call(SetParameters, "/simulator/set_parameters", wanted).results[0].successful
    assert sim.simulator.runner.prepared.name == "line"
    assert "track" in ros.call(Trigger, "simulator/get_playground").message


def test_the_test_has_the_topics_of_operators_and_the_truth(graded, ros, simulation) -> None:
    sim = simulation(noise=False)
    truth = ros.collect(Odometry, "_ground_truth/odom")
    pressed = ros.collect(Bool, "buttons/forward")
    assert len(ros.collect(MarkerArray, "_markers")) == 1
    message = PoseWithCovarianceStamped()
    message.pose.pose.position.x, message.pose.pose.orientation.w = -0.2, 1.0
    ros.publisher(PoseWithCovarianceStamped, "initialpose").publish(message)
    ros.publisher(Bool, "_press/forward").publish(Bool(data=True))
    sim.until(lambda: pressed.latest.data and truth.latest.pose.pose.position.x == pytest.approx(-0.2), seconds=1)


@pytest.mark.parametrize(("parameters", "shown_x_m"), [({}, 0.1), ({"publish_map_tf": True}, 0.4)])
def test_transforms_have_the_pose_by_odometry_unless_the_test_wants_the_true_one(
    graded, ros, simulation, parameters, shown_x_m
) -> None:
    sim = simulation(noise=False, **parameters)
    sim.thymio.place(0.1, 0.0, 0.0)  # before the start
    sim.step(0.2)
    sim.thymio.place(0.4, 0.0, 0.0)
    sim.step(0.2)
    moving = ros.collect(TFMessage, "/tf")  # a late subscriber
    sim.step(0.2)
    places = {one.child_frame_id: one.transform.translation.x for one in moving.latest.transforms}
    assert places["odom"] + places["base_link"] == pytest.approx(shown_x_m, abs=1e-3)
    sim.reset()
    sim.thymio.place(-0.2, 0.0, 0.0)
    sim.step(0.2)
    places = {one.child_frame_id: one.transform.translation.x for one in moving.latest.transforms}
    assert places["odom"] + places["base_link"] == pytest.approx(-0.2, abs=1e-3)


def test_a_world_that_is_reset_from_outside_keeps_the_record(ros, simulation) -> None:
    sim = simulation(playground="base")
    wheels = ros.publisher(Twist, "cmd_vel")
    wheels.publish(Twist(linear=Vector3(x=0.15)))
    while sim.now < 8 and no_contact(sim.thymio):
        wheels.publish(Twist(linear=Vector3(x=0.15)))
        sim.step(0.1)
    touched = sim.thymio.touches[0]
    assert ros.call(Trigger, "simulator/reset").success
    sim.step(0.1)
    assert sim.now < 1
    assert sim.thymio.touches == [touched]
    assert not no_contact(sim.thymio)
    sim.reset()
    assert no_contact(sim.thymio)


def _parameter(name: str, **value: object) -> Parameter:
    return Parameter(name=name, value=ParameterValue(**value))
