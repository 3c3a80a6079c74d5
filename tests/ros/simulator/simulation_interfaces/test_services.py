"""The services of simulation_interfaces: what they do, and the codes and reasons with which they refuse."""

from __future__ import annotations

import json
import math

import pytest
from geometry_msgs.msg import Point, Pose, PoseStamped, Quaternion, Twist, Vector3
from std_msgs.msg import Header

from tests.ros.interface_types import interfaces
from thymio_sim_ros.files import resources
from thymio_sim_ros.ros.simulator.simulation_interfaces.services import OFFERS, SimInterfaces

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
UNSUPPORTED, OK, NOT_FOUND, INCORRECT_STATE, FAILED = range(5)
STOPPED, PLAYING, PAUSED = range(3)
ROBOT, DYNAMIC_OBJECT = 1, 4
TYPES = interfaces()


class Served:
    """A simulator's services, called as an executor would."""

    def __init__(self, sim):
        self.simulator = sim.simulator
        self._answers = {}
        SimInterfaces(self, sim.simulator.runner, sim.simulator.params, sim.simulator.parameter_callbacks, TYPES)

    def create_service(self, kind, name, answer):
        """What a node does."""
        self._answers[name] = (kind, answer)

    def __call__(self, name, /, **fields):
        kind, answer = self._answers[f"~/{name}"]
        return answer(kind.Request(**fields), kind.Response())

    def reported(self, name, /, **fields):
        """Code and reason of the answer."""
        result = self(name, **fields).result
        return result.result, result.error_message

    @property
    def state(self):
        """What the simulation does."""
        return self("get_simulation_state").state.state


@pytest.fixture
def room(simulation):
    return Served(simulation(playground=ROOM))


def pose(x, y, yaw=0.0):
    return Pose(position=Point(x=x, y=y), orientation=Quaternion(z=math.sin(yaw / 2), w=math.cos(yaw / 2)))


def state(x=0.0, y=0.0, yaw=0.0, *, frame="", twist=None):
    header = Header(frame_id=frame)
    return TYPES.msg.EntityState(header=header, pose=pose(x, y, yaw), twist=twist or Twist())


def place(x, y, frame=""):
    return PoseStamped(header=Header(frame_id=frame), pose=pose(x, y))


def target(number):
    return TYPES.msg.SimulationState(state=number)


def named(served, pattern="", *categories):
    request = served._answers["~/get_entities"][0].Request()
    request.filters.filter = pattern
    request.filters.categories = [TYPES.msg.EntityCategory(category=one) for one in categories]
    return list(served("get_entities", filters=request.filters).entities)


def test_every_service_is_there(room):
    assert set(room._answers) == {f"~/{offer.name}" for offer in OFFERS}


def test_a_service_whose_type_is_unknown_is_left_out(simulation, monkeypatch):
    monkeypatch.delattr(TYPES.srv, "LoadWorld")
    served = Served(simulation(playground=ROOM))
    assert "~/load_world" not in served._answers
    assert "~/step_simulation" in served._answers


def test_features_are_those_that_are_offered(room):
    found = room("get_simulator_features").features
    known = TYPES.msg.SimulatorFeatures
    assert {known.SPAWNING, known.DELETING, known.ENTITY_STATE_GETTING, known.STEP_SIMULATION_MULTIPLE} <= set(
        found.features
    )


def test_the_simulation_is_stopped_played_paused_and_stopped(room):
    assert room.state == STOPPED
    assert room.reported("set_simulation_state", state=target(PLAYING)) == (OK, "")
    assert room.state == PLAYING
    assert room.reported("set_simulation_state", state=target(PLAYING)) == (101, "the simulation is playing already")
    room.simulator.runner.advance(3)
    assert room.reported("set_simulation_state", state=target(PAUSED)) == (OK, "")
    assert room.state == PAUSED
    assert room.reported("set_simulation_state", state=target(STOPPED)) == (OK, "")
    assert (room.state, room.simulator.runner.world.now_ns) == (STOPPED, 0)


def test_an_invalid_transition_is_rejected(room):
    code, reason = room.reported("set_simulation_state", state=target(PAUSED))
    assert (code, reason) == (103, "the simulation is stopped, which is paused at time 0: step or play it")
    assert room.reported("set_simulation_state", state=target(3))[0] == UNSUPPORTED


def test_steps_are_done_while_the_world_is_paused(room):
    assert room.reported("step_simulation") == (OK, "")
    assert room.reported("step_simulation", steps=5) == (OK, "")
    assert room.simulator.runner.world.now_ns == 60_000_000
    room.simulator.runner.pause(False)
    assert room.reported("step_simulation") == (FAILED, "the simulation is running: pause it first")
    room.simulator.runner.pause(True)
    assert room.reported("step_simulation", steps=100_001)[0] == FAILED
    assert room.simulator.runner.world.now_ns == 60_000_000


def test_a_reset_takes_spawned_robots_along(room):
    room("spawn_entity", name="anna", uri="thymio", initial_pose=place(-0.5, 0.0))
    room("step_simulation", steps=5)
    assert room.reported("reset_simulation", scope=1)[0] == UNSUPPORTED
    assert room.reported("reset_simulation") == (OK, "")
    assert (room.state, named(room)) == (STOPPED, ["thymio", "crate"])


def test_entities_are_listed_by_name_and_category(room):
    assert named(room) == ["thymio", "crate"]
    assert named(room, "^c.*e$") == ["crate"]
    assert named(room, "", ROBOT) == ["thymio"]
    assert named(room, "t", DYNAMIC_OBJECT) == ["crate"]
    filters = room._answers["~/get_entities"][0].Request().filters
    filters.filter = "("
    assert room.reported("get_entities", filters=filters)[0] == FAILED
    filters.filter, filters.bounds.type = "", 3
    assert room.reported("get_entities", filters=filters)[0] == UNSUPPORTED
    filters.bounds.type, filters.tags.tags = 0, ["red"]
    assert room.reported("get_entities", filters=filters)[0] == UNSUPPORTED


def test_an_entity_has_a_category(room):
    assert room("get_entity_info", entity="crate").info.category.category == DYNAMIC_OBJECT
    code, reason = room.reported("get_entity_info", entity="crat")
    assert (code, reason) == (NOT_FOUND, "found unknown name 'crat', expected 'crate' (one of thymio, crate)")


def test_a_state_is_the_truth_in_the_world_s_frame(room):
    assert room.reported("set_entity_state", entity="thymio", state=state(0.2, -0.1, math.pi / 2, frame="map")) == (
        OK,
        "",
    )
    room.simulator.runner.world.post("thymio", _forward())
    room("step_simulation", steps=2)
    found = room("get_entity_state", entity="thymio").state
    assert (found.header.frame_id, found.header.stamp.nanosec) == ("map", 20_000_000)
    assert (found.pose.position.x, found.pose.position.y) == pytest.approx((0.2, -0.1), abs=0.01)
    assert found.pose.orientation.z == pytest.approx(math.sqrt(0.5), abs=0.01)
    assert (found.twist.linear.x, found.twist.linear.y) == pytest.approx((0.0, 0.1), abs=0.02)
    both = room("get_entities_states")
    assert list(both.entities) == ["thymio", "crate"]
    assert both.states[1].pose.position.x == 0.5


def _forward():
    from thymio_sim_ros.sim.commands import BodyTwist

    return BodyTwist(0.1, 0.0)


@pytest.mark.parametrize(
    ("entity", "wanted", "code", "reason"),
    [
        ("unknown", state(), NOT_FOUND, "found unknown name 'unknown'"),
        ("crate", state(0.0, 0.5), 101, "'crate' cannot be placed at 0.000, 0.500 m: occupied by 'post'"),
        ("crate", state(math.nan), 101, "the pose has a value that is not finite"),
        ("crate", state(frame="odom"), UNSUPPORTED, "found frame 'odom', expected 'map'"),
        ("thymio", state(twist=Twist(linear=Vector3(x=1.0))), UNSUPPORTED, "found velocities"),
    ],
)
def test_an_invalid_state_is_rejected(room, entity, wanted, code, reason):
    found = room.reported("set_entity_state", entity=entity, state=wanted)
    assert (found[0], found[1][: len(reason)]) == (code, reason)


def test_a_robot_is_spawned_and_deleted(room):
    (only,) = room("get_spawnables").spawnables
    answer = room("spawn_entity", name="anna", uri=only.uri, entity_namespace="/anna", initial_pose=place(-0.5, 0.2))
    assert (answer.result.result, answer.entity_name) == (OK, "anna")
    assert room.simulator.endpoints.robots.names["anna"].topic("odom") == "anna/odom"
    assert room.simulator.runner.world.robots["anna"].pose.x_m == -0.5
    assert room.reported("delete_entity", entity="anna") == (OK, "")
    assert named(room) == ["thymio", "crate"]
    assert room.reported("delete_entity", entity="crate")[0] == FAILED
    assert room.reported("delete_entity", entity="anna")[0] == NOT_FOUND


@pytest.mark.parametrize(
    ("request_", "code"),
    [
        ({"name": "anna"}, 104),
        ({"name": "anna", "resource_string": "<sdf/>"}, 103),
        ({"name": "anna", "uri": "nexus"}, 103),
        ({"name": "", "uri": "thymio"}, 102),
        ({"name": "an na", "uri": "thymio"}, 102),
        ({"name": "thymio", "uri": "thymio"}, 101),
        ({"name": "anna", "uri": "thymio", "entity_namespace": "/bert"}, 105),
        ({"name": "anna", "uri": "thymio", "initial_pose": place(0.0, 0.5)}, 109),
        ({"name": "anna", "uri": "thymio", "initial_pose": place(math.inf, 0.5)}, 109),
        ({"name": "anna", "uri": "thymio", "initial_pose": place(0.0, 0.5, "base_link")}, UNSUPPORTED),
    ],
)
def test_an_invalid_robot_is_rejected(room, request_, code):
    found = room.reported("spawn_entity", **({"initial_pose": place(-0.5, 0.0)} | request_))
    assert found[0] == code
    assert found[1]
    assert named(room) == ["thymio", "crate"]


def test_a_robot_may_be_renamed(room):
    for wanted, given in (("thymio", "thymio_2"), ("", "thymio_1")):
        where = place(-0.5, 0.3 if wanted else -0.3)
        answer = room("spawn_entity", name=wanted, allow_renaming=True, uri="thymio", initial_pose=where)
        assert (answer.result.result, answer.entity_name) == (OK, given)


def test_several_are_spawned_each_with_a_result(room):
    wanted = [TYPES.msg.SpawnEntity(name="anna", initial_pose=place(-0.5, 0.0)) for _ in range(2)]
    for one in wanted:
        getattr(one, "entity_resource", one).uri = "thymio"
    answer = room("spawn_entities", spawn_requests=wanted)
    assert [(one.result.result, one.entity_name) for one in answer.results] == [(OK, "anna"), (101, "")]
    assert answer.result.result == 150


def test_worlds_are_listed_and_loaded(room):
    assert [world.name for world in room("get_available_worlds").worlds] == list(resources.playgrounds())
    room.simulator.runner.pause(False)
    answer = room("load_world", uri="maze")
    assert (answer.result.result, answer.world.name, room.state) == (OK, "maze", STOPPED)
    assert room("load_world", resource_string=ROOM).world.name == "Room"
    world = room("get_current_world").world
    assert (world.world_resource.uri, world.world_resource.resource_string) == ("", ROOM)
    assert named(room) == ["thymio", "crate"]


def test_an_invalid_world_is_rejected_and_the_old_one_stays(room):
    assert room.reported("load_world")[0] == 102
    code, reason = room.reported("load_world", uri="nowhere")
    assert code == 103
    assert reason.startswith("no playground 'nowhere'")
    assert room("get_current_world").world.name == "Room"


def test_without_the_package_nothing_is_logged(ros, simulation):
    if not hasattr(TYPES.srv.StepSimulation, "Event"):
        assert simulation().simulator._interfaces is None


def test_with_the_package_the_services_and_the_action_are_called_over_ros(ros, simulation):
    srv = pytest.importorskip("simulation_interfaces.srv", reason="no wheel has simulation_interfaces")
    from rclpy.action import ActionClient
    from simulation_interfaces.action import SimulateSteps

    sim = simulation()
    assert ros.call(srv.StepSimulation, "/simulator/step_simulation").result.result == OK
    assert sim.world.now_ns == 10_000_000
    client = ActionClient(ros.node, SimulateSteps, "/simulator/simulate_steps")
    ros.until(client.server_is_ready)
    reported = []
    sent = client.send_goal_async(SimulateSteps.Goal(steps=5), feedback_callback=reported.append)
    ros.until(sent.done)
    answer = sent.result().get_result_async()
    ros.until(answer.done)
    assert answer.result().result.result.result == OK
    assert sim.world.now_ns == 60_000_000
    assert [one.feedback.remaining_steps for one in reported] == [4, 3, 2, 1, 0]
    sent = client.send_goal_async(SimulateSteps.Goal(steps=10**9))
    ros.until(sent.done)
    answer = sent.result().get_result_async()
    ros.until(lambda: sim.world.now_ns > 100_000_000)
    sent.result().cancel_goal_async()
    ros.until(answer.done)
    assert answer.result().result.result.error_message.startswith("canceled after")
    client.destroy()
