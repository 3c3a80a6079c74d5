"""The private graph of a test: nodes under test, waiting, and what it says when waiting was in vain."""

from __future__ import annotations

import signal
import threading

import pytest
import rclpy
from geometry_msgs.msg import Twist, TwistStamped
from nav_msgs.msg import Odometry
from rclpy.context import Context
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from sensor_msgs.msg import Range
from std_msgs.msg import Bool, String
from std_srvs.srv import Empty, Trigger

from thymio_sim_ros.ros.simulator.node import Simulator, SimulatorParams
from thymio_sim_ros.testing.ros import Ros, Simulation
from thymio_sim_ros.testing.ros.domain import reserved
from thymio_sim_ros.testing.ros.student_errors import StudentError

BEST_EFFORT = QoSProfile(depth=1, reliability=ReliabilityPolicy.BEST_EFFORT)


class Echo(Node):
    """Says what it hears."""

    def __init__(self, prefix="", **kwargs):
        super().__init__("echo", **kwargs)
        self.prefix = prefix or self.declare_parameter("prefix", "").value
        self.mouth = self.create_publisher(String, "said", 10)
        self.create_subscription(String, "heard", self.hear, 10)
        if self.prefix == "bye":
            rclpy.shutdown(context=self.context)

    def hear(self, message):
        if message.data == "bang":
            raise ValueError("I fell over")
        while message.data == "loop":
            pass
        if message.data == "bye":
            rclpy.shutdown(context=self.context)
            return
        self.mouth.publish(String(data=self.prefix + message.data))


class Timed(Node):
    """Counts ten times a second."""

    def __init__(self):
        super().__init__("timed")
        self.times = []
        self.create_timer(0.1, lambda: self.times.append(self.get_clock().now().nanoseconds))


class Wanderer(Node):
    """Goes on until something is ahead."""

    def __init__(self):
        super().__init__("wanderer")
        self.wheels = self.create_publisher(Twist, "cmd_vel", 10)
        self.create_subscription(Range, "proximity/center", self.look, 10)

    def look(self, seen):
        command = Twist()
        command.linear.x, command.angular.z = (0.1, 0.0) if seen.range > 0.1 else (0.0, 1.0)
        self.wheels.publish(command)


class Stamped(Node):
    """Publishes as newer teleoperation nodes do."""

    def __init__(self):
        super().__init__("stamped")
        self.create_publisher(TwistStamped, "cmd_vel", 10)


class Asking(Node):
    """Calls a service as another type."""

    def __init__(self):
        super().__init__("asking")
        self.create_client(Empty, "reset_odometry")


def test_a_node_under_test_needs_to_know_nothing_of_tests(ros):
    node = ros.start(Echo)
    said = ros.collect(String, "said")
    ros.publisher(String, "heard").publish(String(data="hello"))
    assert said.next().data == "hello"
    assert node.context is ros.context


def test_it_gets_parameters_names_and_arguments(ros):
    node = ros.start(Echo, name="parrot", namespace="zoo", parameters={"prefix": "ps"}, remappings={"said": "cried"})
    assert node.get_fully_qualified_name() == "/zoo/parrot"
    said = ros.collect(String, "/zoo/cried")
    ros.publisher(String, "/zoo/heard").publish(String(data="t"))
    assert said.next().data == "pst"
    assert ros.start(Echo, arguments={"prefix": "x"}).prefix == "x"


def test_what_a_callback_raises_is_raised_in_the_test(ros):
    ros.start(Echo)
    ros.publisher(String, "heard").publish(String(data="bang"))
    with pytest.raises(ValueError, match="I fell over"):
        ros.until(lambda: False)


def test_a_node_that_shuts_ros_down_is_an_error(ros):
    ros.start(Echo)
    ros.publisher(String, "heard").publish(String(data="bye"))
    with pytest.raises(pytest.fail.Exception, match=r"rclpy.shutdown\(\) belongs to main"):
        ros.until(lambda: False)


def test_a_node_that_shuts_ros_down_at_its_start_is_an_error_too(ros):
    with pytest.raises(pytest.fail.Exception, match=r"rclpy.shutdown\(\) belongs to main"):
        ros.start(Echo, arguments={"prefix": "bye"})


def test_a_node_that_is_stopped_is_gone(ros):
    node = ros.start(Echo)
    ros.stop(node)
    ros.until(lambda: "echo" not in ros.node.get_node_names())


def test_timers_follow_simulated_time(ros, simulation):
    sim = simulation()
    node = ros.start(Timed)
    sim.step(1.0)
    assert [time // 100_000_000 for time in node.times] == list(range(1, len(node.times) + 1))
    assert len(node.times) in (9, 10)


def test_without_a_simulation_timers_follow_real_time(ros):
    node = ros.start(Timed)
    ros.until(lambda: len(node.times) == 2)


def test_the_same_run_is_the_same_bit_for_bit():
    poses = []
    for _ in range(3):
        with reserved() as domain:
            ros = Ros(domain)
            poses.append(drive(ros))
            ros.close()
    assert poses[0] == poses[1] == poses[2]
    assert poses[0].x_m > 0.2


def drive(ros):
    """Where the wanderer is after five seconds among the obstacles."""
    sim = Simulation(ros, ros.live(Simulator(ros.context, SimulatorParams(playground="obstacle", start_paused=True))))
    ros.settle()
    ros.start(Wanderer)
    sim.step(5.0)
    return sim.thymio.pose


def test_a_recorder_listens_as_it_is_published(ros):
    publisher = ros.node.create_publisher(Bool, "light", BEST_EFFORT)
    lights = ros.collect(Bool, "light")
    publisher.publish(Bool(data=True))
    lights.wait()
    assert lights.latest.data


def test_a_recorder_does_not_wait_for_publishers(ros):
    lights = ros.collect(Bool, "light", qos=BEST_EFFORT)
    ros.node.create_publisher(Bool, "light", BEST_EFFORT)
    ros.settle()
    assert len(lights) == 0


def test_a_time_out_is_reported_with_all_that_is_known(ros, simulation):
    sim = simulation()
    ros.start(Wanderer, remappings={"cmd_vel": "cmd_vle"})
    ros.collect(Odometry, "odom")
    with pytest.raises(pytest.fail.Exception) as caught:
        sim.until(lambda: sim.thymio.pose.x_m > 0.1, seconds=0.2)
    lines = str(caught.value).splitlines()
    assert lines[0] == "not within 0.2 simulated s: sim.thymio.pose.x_m > 0.1"
    assert lines[1:3] == ["simulated time: 0.20 s", "thymio: at (0.000, 0.000) m, turned 0°, 0.000 m/s"]
    assert lines[3].startswith("/odom: 4 messages, last at 0.20 s: Odometry(header=Header(")
    assert "/cmd_vle geometry_msgs/msg/Twist: 1 publisher, 0 subscribers (no subscriber)" in lines
    assert "/proximity/center sensor_msgs/msg/Range: 1 publisher, 1 subscriber" in lines
    assert lines[-1].endswith(" other topics")


def test_an_endpoint_of_the_wrong_type_is_refused_with_the_cure(ros, simulation):
    simulation()
    with pytest.raises(StudentError) as caught:
        ros.start(Stamped)
    assert str(caught.value) == (
        "/cmd_vel has a publisher of geometry_msgs/msg/TwistStamped by node /stamped; expected geometry_msgs/msg/Twist:"
        " its messages never arrive. Publish on /cmd_vel_stamped, or start the simulator with --ros-args -p"
        " stamped_cmd_vel:=true"
    )
    with pytest.raises(StudentError, match=r"/reset_odometry has a client of std_srvs/srv/Empty by node /asking;"):
        ros.start(Asking)


def test_a_subscription_of_the_test_itself_with_another_qos_is_refused_with_the_cure(ros, simulation):
    simulation()
    retained = QoSProfile(depth=1, durability=DurabilityPolicy.TRANSIENT_LOCAL)
    with pytest.raises(
        pytest.fail.Exception, match="durability transient_local by node /test; expected durability volatile"
    ):
        ros.collect(Odometry, "/odom", qos=retained)


def test_a_test_that_uses_the_wrong_type_is_told_the_right_one(ros, simulation):
    simulation()
    with pytest.raises(StudentError, match=r"expected geometry_msgs/msg/Twist: .* Publish on /cmd_vel_stamped"):
        ros.publisher(TwistStamped, "/cmd_vel")
    with pytest.raises(StudentError, match="expected nav_msgs/msg/Odometry: it gets no message"):
        ros.collect(Range, "/odom")
    with pytest.raises(StudentError, match="expected std_srvs/srv/Trigger: its calls are never answered"):
        ros.call(Empty, "/reset_odometry")


def test_a_node_in_a_namespace_that_there_is_not_is_reported(ros, simulation):
    sim = simulation()
    ros.start(Wanderer, namespace="thymio0")
    with pytest.raises(pytest.fail.Exception) as caught:
        sim.until(lambda: sim.thymio.pose.x_m > 0.1, seconds=0.1)
    assert (
        "/thymio0/cmd_vel has a publisher of geometry_msgs/msg/Twist by node /thymio0/wanderer; expected /cmd_vel"
        in (str(caught.value))
    )
    assert "/thymio0/proximity/center has a subscriber of sensor_msgs/msg/Range" in str(caught.value)


def test_time_that_stood_still_is_reported(ros, simulation):
    simulation()
    with pytest.raises(pytest.fail.Exception, match="simulated time stood still meanwhile: sim_time= lets it pass"):
        ros.until(lambda: False, timeout=0.0)


def test_waits_have_the_deadline_of_the_graph(ros):
    messages = ros.collect(Bool, "light", qos=BEST_EFFORT)
    ros.deadline_s = 0.0
    for wait in (lambda: ros.until(lambda: False), messages.next, messages.wait, lambda: ros.publisher(Bool, "dark")):
        with pytest.raises(pytest.fail.Exception, match="not within 0 s"):
            wait()


def test_incompatible_qos_is_reported(ros):
    ros.node.create_publisher(Bool, "light", BEST_EFFORT)
    ros.make_node("viewer").create_subscription(Bool, "light", lambda _: None, 10)
    with pytest.raises(pytest.fail.Exception, match=r"/light .*\(test and viewer have incompatible QoS\)"):
        ros.until(lambda: False, 0.0)


def test_time_of_a_simulation_that_there_is_not_cannot_pass(ros):
    with pytest.raises(LookupError, match="sim_time needs a simulation"):
        ros.until(lambda: True, sim_time=1.0)


def test_simulated_time_passes_while_waiting(ros, simulation, spin_until, ros_node):
    sim = simulation()
    spin_until(lambda: sim.now > 0.5, sim_time=1.0)
    assert sim.now == pytest.approx(0.51)
    assert ros_node is ros.node


@pytest.mark.parametrize("word", ["nothing", "loop"])
def test_an_interrupted_test_leaves_nothing_behind(ros_domain, word):
    """As pytest-timeout does it: a signal's handler raises while the test waits, or while a callback never ends."""

    def stop(_number, _frame):
        raise TimeoutError

    def wait():
        signal.setitimer(signal.ITIMER_REAL, 0.05)
        ros.until(lambda: False)

    before = signal.signal(signal.SIGALRM, stop)
    threads = set(threading.enumerate())
    ros = Ros(ros_domain)
    try:
        ros.start(Echo)
        ros.publisher(String, "heard").publish(String(data=word))
        with pytest.raises(TimeoutError):
            wait()
    finally:
        ros.close()
        signal.signal(signal.SIGALRM, before)
    assert set(threading.enumerate()) == threads
    assert not ros.context.ok()


def test_the_end_is_complete_even_when_a_node_spoils_it(ros_domain):
    class Bad(Node):
        def destroy_node(self):
            super().destroy_node()
            raise RuntimeError("no")

    ros = Ros(ros_domain)
    ros.start(type("BadOne", (Bad,), {"__init__": lambda self: super(Bad, self).__init__("bad")}))
    with pytest.raises(RuntimeError, match="no"):
        ros.close()
    assert not ros.context.ok()


def test_a_foreign_default_context_is_left_alone(ros_domain):
    rclpy.init(args=[], domain_id=ros_domain)
    try:
        ros = Ros(ros_domain)
        ros.close()
        assert rclpy.ok()
    finally:
        rclpy.shutdown()


def test_code_under_test_may_use_the_default_context(ros):
    assert rclpy.ok()
    assert rclpy.create_node("plain").context is ros.context


def test_two_domains_hear_nothing_of_each_other(ros):
    ros.node.create_publisher(String, "secret", 10)
    with reserved() as domain:
        other = Ros(domain)
        other.start(Echo)
        said = other.collect(String, "said")
        other.publisher(String, "heard").publish(String(data="x"))
        said.wait()
        assert "/secret" not in dict(other.node.get_topic_names_and_types())
        other.close()


def test_a_service_is_called(ros):
    ros.node.create_service(Trigger, "open", lambda _request, answer: answer)
    assert ros.call(Trigger, "open").success is False


def test_contexts_are_private(ros):
    assert isinstance(ros.context, Context)
    assert ros.node.get_node_names() == ["test"]
