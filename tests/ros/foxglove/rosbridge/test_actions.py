"""Clients of rosbridge that send goals and that serve actions, on the ROS graph."""

from __future__ import annotations

import pytest
from action_msgs.msg import GoalStatus
from rclpy.action import ActionClient, ActionServer, CancelResponse
from rclpy.task import Future
from test_msgs.action import Fibonacci

from tests.bridge.ros_client import RosClient

FIBONACCI = "test_msgs/action/Fibonacci"


@pytest.fixture
def server(ros):
    """An action that counts to its order, or waits until it is canceled where the order is 0."""
    waiting = []

    async def execute(goal):
        goal.publish_feedback(Fibonacci.Feedback(sequence=[goal.request.order]))
        if goal.request.order == 0:
            waiting.append((goal, Future(executor=ros.node.executor)))
            await waiting[-1][1]
            goal.canceled()
        else:
            goal.succeed()
        return Fibonacci.Result(sequence=range(goal.request.order))

    def cancel(_goal):
        waiting[-1][1].set_result(None)
        return CancelResponse.ACCEPT

    made = ActionServer(ros.node, Fibonacci, "/count", execute, cancel_callback=cancel)
    yield made
    made.destroy()


def _goal(order, **fields):
    return {"action": "/count", "action_type": FIBONACCI, "args": {"order": order}, **fields}


def test_a_goal_is_answered_by_feedback_and_its_result(server, roslib):
    roslib.send("send_action_goal", **_goal(3, id="g", feedback=True))
    feedback = roslib.next("action_feedback")
    assert feedback == {"op": "action_feedback", "action": "/count", "id": "g", "values": {"sequence": [3]}}
    result = roslib.next("action_result")
    assert (result["id"], result["values"], result["result"]) == ("g", {"sequence": [0, 1, 2]}, True)
    assert result["status"] == GoalStatus.STATUS_SUCCEEDED


def test_a_goal_can_be_canceled(server, roslib):
    roslib.send("send_action_goal", **_goal(0, id="g", feedback=True))
    roslib.next("action_feedback")
    roslib.send("cancel_action_goal", action="/count", id="g")
    assert roslib.next("action_result")["status"] == GoalStatus.STATUS_CANCELED
    roslib.send("cancel_action_goal", action="/count", id="g")
    assert "cancel_action_goal.id: expected the id of a goal, found g" in roslib.next("status")["msg"]


@pytest.mark.parametrize(
    ("fields", "text"),
    [
        ({"args": {"order": "3"}}, "send_action_goal.args.order: expected int32, found '3'"),
        ({"action_type": "test_msgs/Nothing"}, "send_action_goal.action_type: type test_msgs/action/Nothing is not"),
        ({"action_type": "std_msgs/msg/Bool"}, "send_action_goal.action_type: expected an action, found std_msgs"),
    ],
)
def test_a_wrong_goal_is_answered_with_the_reason(roslib, fields, text):
    roslib.send("send_action_goal", **{**_goal(1, id="g"), **fields})
    result = roslib.next("action_result")
    assert (result["id"], result["result"]) == ("g", False)
    assert text in result["values"]


def test_a_client_serves_an_action(ros, roslib):
    roslib.send("advertise_action", action="/walk", type=FIBONACCI)
    client = ActionClient(ros.node, Fibonacci, "/walk")
    ros.until(client.server_is_ready)
    heard = []
    sent = client.send_goal_async(Fibonacci.Goal(order=5), feedback_callback=lambda each: heard.append(each.feedback))
    goal = roslib.next("send_action_goal")
    assert (goal["args"], goal["action"], goal["action_type"]) == ({"order": 5}, "/walk", FIBONACCI)
    ros.until(sent.done)
    roslib.send("action_feedback", action="/walk", id=goal["id"], values={"sequence": [1]})
    ros.until(lambda: heard)
    ended = sent.result().get_result_async()
    roslib.send("action_result", action="/walk", id=goal["id"], values={"sequence": [1, 2]}, status=4, result=True)
    ros.until(ended.done)
    assert (ended.result().status, list(ended.result().result.sequence)) == (GoalStatus.STATUS_SUCCEEDED, [1, 2])
    client.destroy()


def test_a_client_that_serves_an_action_is_asked_to_cancel_and_its_goals_end_with_it(ros, roslib):
    roslib.send("advertise_action", action="/walk", type=FIBONACCI)
    client = ActionClient(ros.node, Fibonacci, "/walk")
    ros.until(client.server_is_ready)
    sent = [client.send_goal_async(Fibonacci.Goal(order=order)) for order in (1, 2)]
    goals = [roslib.next("send_action_goal") for _ in sent]
    ros.until(lambda: all(each.done() for each in sent))
    ended = [each.result().get_result_async() for each in sent]
    sent[0].result().cancel_goal_async()
    assert roslib.next("cancel_action_goal")["id"] == goals[0]["id"]
    roslib.send("action_result", action="/walk", id=goals[0]["id"], values={}, status=5, result=True)
    ros.until(ended[0].done)
    assert ended[0].result().status == GoalStatus.STATUS_CANCELED
    roslib.send("action_result", action="/walk", id=goals[1]["id"], values="no way", result=False)
    ros.until(ended[1].done)
    assert ended[1].result().status == GoalStatus.STATUS_ABORTED
    client.destroy()


def test_the_parts_of_an_action_can_be_used_one_by_one(server, roslib):
    goal_id = {"uuid": [7] * 16}
    roslib.send("subscribe", topic="/count/_action/feedback", type=f"{FIBONACCI}_FeedbackMessage")
    arguments = {"goal_id": goal_id, "goal": {"order": 2}}
    sent = roslib.call("/count/_action/send_goal", type=f"{FIBONACCI}_SendGoal", args=arguments)
    assert sent["values"]["accepted"] is True
    result = roslib.call("/count/_action/get_result", type=f"{FIBONACCI}_GetResult", args={"goal_id": goal_id})
    assert result["values"] == {"status": GoalStatus.STATUS_SUCCEEDED, "result": {"sequence": [0, 1]}}


def test_a_client_may_leave_in_the_middle_of_goals_and_calls(ros, bridge, server):
    port = bridge().port
    client = ActionClient(ros.node, Fibonacci, "/walk")
    with RosClient(port, ros.until) as leaving:
        leaving.send("advertise_action", action="/walk", type=FIBONACCI)
        ros.until(client.server_is_ready)
        sent = client.send_goal_async(Fibonacci.Goal(order=1))
        leaving.next("send_action_goal")
        ros.until(sent.done)
        leaving.send("send_action_goal", **_goal(0, id="g", feedback=True))
        leaving.next("action_feedback")
        leaving.send("call_service", service="/never", type="std_srvs/Trigger", timeout=0)
        leaving.call("/rosapi/get_time")
    ros.until(lambda: not client.server_is_ready())
    with RosClient(port, ros.until) as other:
        assert other.call("/rosapi/nodes")["result"]
    client.destroy()
