"""The verbs of actions."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

from action_msgs.msg import GoalStatus
from rclpy.action import (
    ActionClient,
    get_action_client_names_and_types_by_node,
    get_action_server_names_and_types_by_node,
)

from thymio_sim_ros.ros_commands.member import Member, listed, load, print_types
from thymio_sim_ros.ros_commands.node import split
from thymio_sim_ros.ros_commands.values import from_yaml, to_yaml

if TYPE_CHECKING:
    from rclpy.action.client import ClientGoalHandle

__all__ = ["VERBS"]

_STATES = {
    GoalStatus.STATUS_SUCCEEDED: "SUCCEEDED",
    GoalStatus.STATUS_CANCELED: "CANCELED",
    GoalStatus.STATUS_ABORTED: "ABORTED",
}


def _list(member: Member, options: argparse.Namespace) -> None:
    member.discover()
    listed(member.actions(), types=options.show_types, count=options.count, hidden=True)


def _info(member: Member, options: argparse.Namespace) -> None:
    action = member.find("action", options.action, member.actions)
    member.discover()
    print(f"Action: {action}")
    for role, of_node in (
        ("clients", get_action_client_names_and_types_by_node),
        ("servers", get_action_server_names_and_types_by_node),
    ):
        nodes = [one for one in member.nodes() if action in dict(of_node(member.node, *split(one)))]
        print(f"Action {role}: {len(nodes)}")
        for one in nodes:
            print(f"    {one}")


def _type(member: Member, options: argparse.Namespace) -> None:
    print_types(member, "action", options.action, member.actions)


def _send_goal(member: Member, options: argparse.Namespace) -> None:
    name, kind = load(options.type, "action")
    goal = from_yaml(options.values, kind.Goal, member.node)
    action = member.find("action", options.action, member.actions)
    member.check_type("action", action, name, member.actions)
    client = ActionClient(member.node, kind, action)
    print("Waiting for an action server to become available...", flush=True)
    member.spin_until(client.server_is_ready)
    print(f"Sending goal:\n     {to_yaml(goal)}", flush=True)
    handle = member.result(client.send_goal_async(goal, _show_feedback if options.feedback else None), action)
    if not handle.accepted:
        print("Goal was rejected.")
        return
    print(f"Goal accepted with ID: {bytes(handle.goal_id.uuid).hex()}\n", flush=True)
    result = handle.get_result_async()
    try:
        member.spin_until(result.done)
    except KeyboardInterrupt:
        _cancel(member, handle, action)
        raise
    print(f"Result:\n    {to_yaml(result.result().result)}")
    print(f"Goal finished with status: {_STATES.get(result.result().status, 'UNKNOWN')}")


def _show_feedback(feedback: Any) -> None:
    print(f"Feedback:\n    {to_yaml(feedback.feedback)}", flush=True)


def _cancel(member: Member, handle: ClientGoalHandle[Any, Any, Any], action: str) -> None:
    print("Canceling goal...", flush=True)
    member.answer(handle.cancel_goal_async(), action)
    print("Goal canceled.")


VERBS: Mapping[str, Callable[[Member, argparse.Namespace], None]] = {
    "list": _list,
    "info": _info,
    "type": _type,
    "send_goal": _send_goal,
}
