"""`thymio-sim doctor` beside a running suite: it names what is wrong, and only that."""

from __future__ import annotations

import json
import math
import re
import subprocess
import sys

import pytest
import rclpy
from geometry_msgs.msg import Twist, TwistStamped, Vector3
from rclpy.context import Context
from rclpy.node import Node
from std_msgs.msg import Int16MultiArray, MultiArrayDimension, MultiArrayLayout
from std_srvs.srv import Empty, SetBool

from tests.patience import PATIENCE_S
from tests.processes import Process, free_port

pytestmark = pytest.mark.process


@pytest.fixture
def suite(ros, tmp_path, request):
    """A suite with one robot without a program. A parameter of the test is its real-time factor."""
    ports = ("--port", str(free_port()), "--foxglove-port", str(free_port()))
    pace = ("--ros-args", "-p", f"simulator:real_time_factor:={getattr(request, 'param', 1.0):.1f}")
    process = Process(tmp_path, "thymio_sim_ros.cli.main", *ports, "--program", "none", "--headless", *pace)
    ros.until(lambda: ros.node.count_subscribers("/cmd_vel"), PATIENCE_S, what="the robot")
    yield process
    process.end()


def start_doctor(*arguments):
    code = "import sys; from thymio_sim_ros.cli.main import main; sys.exit(main(['doctor', '--ros', *sys.argv[1:]]))"
    command = [sys.executable, "-c", code, *arguments]
    return subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def doctor(ros, *arguments, meanwhile=lambda: None):
    """Run the command while the node of the test lives; return exit code and both outputs."""
    process = start_doctor(*arguments)

    def has_ended():
        meanwhile()
        return process.poll() is not None

    try:
        ros.until(has_ended, PATIENCE_S, what="the end of the doctor")
        output, errors = process.communicate()
    finally:
        process.kill()
        process.wait()
    return process.returncode, output, errors


@pytest.mark.parametrize("suite", [1000.0], indirect=True)  # no computer is so fast
def test_a_robot_that_nobody_drives_is_well_on_a_slow_computer(ros, suite):
    def found():
        code, output, errors = doctor(ros)
        assert (code, errors) == (0, ""), output
        return output if "slower than requested" in output else None

    output = ros.until(found, PATIENCE_S, what="the pace")
    assert re.search(r"simulator is slower than requested: real-time factor [0-9.]+, expected 1000; ", output)
    assert "Playground desk, robots: one without a name; ROS 2, ROS_DOMAIN_ID" in output
    assert "Nothing is wrong." in output
    assert "/cmd_vel has no publisher: the robot moves by its program and from the page only" in output


def test_everything_that_is_wrong_is_named_with_the_topics(ros, suite):
    context = Context()
    rclpy.init(context=context, domain_id=ros.domain)
    other = Node("other", context=context, enable_rosout=False)
    try:
        other.create_publisher(TwistStamped, "/cmd_vel", 10)
        other.create_publisher(Twist, "/thymio0/cmd_vel", 10)
        other.create_client(Empty, "/reset_odometry")
        publisher = ros.publisher(Twist, "/cmd_vel")
        message = Twist(linear=Vector3(x=math.nan))
        ros.call(SetBool, "/simulator/pause", SetBool.Request(data=True))

        def found():
            code, output, errors = doctor(ros, "--json", meanwhile=lambda: publisher.publish(message))
            assert (code, errors) == (1, "")
            result = json.loads(output)
            uses = {(use["name"], use["type"].rpartition("/")[2]): use for use in result["topics"]}
            is_complete = len(result["faults"]) == 5 and ("/cmd_vel", "TwistStamped") in uses
            return result if is_complete and uses["/cmd_vel", "Twist"]["last"] else None

        result = ros.until(found, PATIENCE_S, what="all faults")
    finally:
        context.try_shutdown()
    begins = sorted(fault.split(":")[0] for fault in result["faults"])
    assert begins == [
        "/cmd_vel has a publisher of geometry_msgs/msg/TwistStamped by node /other; expected geometry_msgs/msg/Twist",
        "/cmd_vel rejected",
        "/reset_odometry has a client of std_srvs/srv/Empty by node /other; expected std_srvs/srv/Trigger",
        "/thymio0/cmd_vel has a publisher of geometry_msgs/msg/Twist by node /other; expected /cmd_vel, since"
        " /thymio0/cmd_vel has no subscriber",
        "The simulation is paused",
    ]
    uses = {(use["name"], use["type"]): use for use in result["topics"]}
    driven = uses["/cmd_vel", "geometry_msgs/msg/Twist"]
    assert (driven["subscribers"], driven["last"]) == (["/simulator"], "linear.x nan")
    stamped = uses["/cmd_vel", "geometry_msgs/msg/TwistStamped"]
    assert (stamped["publishers"], stamped["subscribers"], stamped["age_s"]) == (["/other"], [], None)


def test_events_that_no_program_declares_are_named(ros, suite):
    """Simulator and Aseba runtime report alike; the doctor shows both."""
    message = Int16MultiArray(layout=MultiArrayLayout(dim=[MultiArrayDimension(label="go")]))
    publisher = ros.publisher(Int16MultiArray, "/_aseba/emit")

    def found():
        code, output, errors = doctor(ros, "--json", meanwhile=lambda: publisher.publish(message))
        assert errors == ""
        faults = json.loads(output)["faults"]
        return (code, faults) if faults else None

    assert ros.until(found, PATIENCE_S, what="the fault") == (
        1,
        ["event go rejected: the program declares no events"],
    )


def test_an_unknown_robot_is_an_error_with_the_known_ones(ros, suite):
    code, output, errors = doctor(ros, "anna")
    assert (code, output) == (2, "")
    assert "no robot 'anna': the robots are one without a name (its topics have no prefix)" in errors


def test_without_a_simulator_it_says_what_to_start(ros):
    code, output, errors = doctor(ros)
    assert (code, output) == (2, "")
    assert "no simulator found on ROS 2, ROS_DOMAIN_ID" in errors
    assert "start `thymio-sim`" in errors
