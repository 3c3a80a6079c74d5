"""Clients of actions."""

from __future__ import annotations

import threading
import uuid
import weakref
from collections.abc import Callable
from typing import Any, TypeVar, cast

from thymio_sim_ros.portable_ros import ros_types
from thymio_sim_ros.portable_ros.messages.action_class import Action, FeedbackT, GoalT, ResultT
from thymio_sim_ros.portable_ros.rclpy._rclpy_pybind11 import RCLError
from thymio_sim_ros.portable_ros.rclpy.callback_groups import CallbackGroup
from thymio_sim_ros.portable_ros.rclpy.client import Client
from thymio_sim_ros.portable_ros.rclpy.logging import get_logger
from thymio_sim_ros.portable_ros.rclpy.node import Node
from thymio_sim_ros.portable_ros.rclpy.qos import (
    QoSProfile,
    qos_profile_action_status_default,
    qos_profile_services_default,
)
from thymio_sim_ros.portable_ros.rclpy.task import Future, await_or_execute
from thymio_sim_ros.portable_ros.rclpy_parts.action_end import ActionEnd
from thymio_sim_ros.portable_ros.rclpy_parts.action_parts import (
    CANCEL_GOAL,
    FEEDBACK,
    GET_RESULT,
    SEND_GOAL,
    STATUS,
)
from thymio_sim_ros.portable_ros.rclpy_parts.client_goal_handle import ClientGoalHandle as ClientGoalHandle
from thymio_sim_ros.portable_ros.rclpy_parts.goal_state import FINAL
from thymio_sim_ros.portable_ros.rclpy_parts.service_entity import ServiceDescription

T = TypeVar("T")

_KINDS = {SEND_GOAL: "goal", CANCEL_GOAL: "cancel", GET_RESULT: "result"}


class _ActionServiceClient(Client[Any, Any]):
    """A client of a service of an action, which warns of responses without a request.

    Its turn comes before those of states and feedback that a server has published after it has answered.
    """

    def __init__(self, of: ServiceDescription[Any, Any]) -> None:
        super().__init__(of)
        self.lets_pass = False

    def _report_unexpected(self) -> None:
        action, _, part = self.srv_name.partition("/_action/")
        get_logger(self.logger_name).get_child("action_client").warning(
            f"Ignoring unexpected {_KINDS[part]} response. There may be more than one action server for the action"
            f" '{action}'"
        )


class ActionClient(ActionEnd[GoalT, ResultT, FeedbackT]):
    """Sends goals to the server of an action."""

    def __init__(
        self,
        node: Node,
        action_type: type[Action[GoalT, ResultT, FeedbackT]],
        action_name: str,
        *,
        callback_group: CallbackGroup | None = None,
        goal_service_qos_profile: QoSProfile = qos_profile_services_default,
        result_service_qos_profile: QoSProfile = qos_profile_services_default,
        cancel_service_qos_profile: QoSProfile = qos_profile_services_default,
        feedback_sub_qos_profile: QoSProfile = QoSProfile(depth=10),  # noqa: B008  # as rclpy's
        status_sub_qos_profile: QoSProfile = qos_profile_action_status_default,
    ) -> None:
        """Raises ValueError for a wrong name and errors about the type."""
        super().__init__(node, action_type, action_name, callback_group, "client")
        self._goal_handles: weakref.WeakValueDictionary[bytes, ClientGoalHandle[GoalT, ResultT, FeedbackT]]
        self._goal_handles = weakref.WeakValueDictionary()
        """The goals whose state is not final, as long as the program has them."""
        self._feedback_callbacks: dict[bytes, Callable[[Any], object]] = {}
        self._name = action_name
        with self._assembly() as (parts, impl):
            self._status = parts.subscription(impl.GoalStatusMessage, STATUS, self._note_states, status_sub_qos_profile)
            self._feedback = parts.subscription(
                impl.FeedbackMessage, FEEDBACK, self._pass_feedback, feedback_sub_qos_profile
            )
            self._goals, self._cancellations, self._results = (
                parts.client(_ActionServiceClient, kind, part, profile)
                for kind, part, profile in (
                    (impl.SendGoalService, SEND_GOAL, goal_service_qos_profile),
                    (impl.CancelGoalService, CANCEL_GOAL, cancel_service_qos_profile),
                    (impl.GetResultService, GET_RESULT, result_service_qos_profile),
                )
            )

    def send_goal(self, goal: GoalT, **kwargs: Any) -> Any:
        """Send a goal and wait for the response with its result; another thread must spin the node.

        Arguments and errors are those of `send_goal_async`.
        """
        handle = _wait_for(self.send_goal_async(goal, **kwargs), self._goals)
        return self._get_result(handle)

    def send_goal_async(
        self,
        goal: GoalT,
        feedback_callback: Callable[[Any], object] | None = None,
        goal_uuid: ros_types.UUID | None = None,
    ) -> Future[ClientGoalHandle[GoalT, ResultT, FeedbackT]]:
        """Send a goal; the future gets its handle once a server has accepted or rejected it.

        `feedback_callback` is called with messages with id and feedback until the result is there. The goal gets a
        random id unless one is given. Raises TypeError for a goal of another action.
        """
        if not isinstance(goal, self._action_type.Goal):
            raise TypeError
        goal_id = goal_uuid or ros_types.UUID(uuid=list(uuid.uuid4().bytes))
        key = bytes(goal_id.uuid)
        if feedback_callback is not None:
            self._feedback_callbacks[key] = feedback_callback

        def handle_of(response: Any) -> ClientGoalHandle[GoalT, ResultT, FeedbackT]:
            handle: ClientGoalHandle[GoalT, ResultT, FeedbackT] = ClientGoalHandle(self, goal_id, response)
            if not handle.accepted:
                self._feedback_callbacks.pop(key, None)
            elif key in self._goal_handles:
                raise RuntimeError(f"Two goals were accepted with the same ID ({handle})")
            else:
                self._goal_handles[key] = handle
                handle._status = ros_types.GoalStatus.STATUS_ACCEPTED
            return handle

        request: Any = self._action_type.Impl.SendGoalService.Request
        return self._goals.send(request(goal_id=goal_id, goal=goal), handle_of)

    def server_is_ready(self) -> bool:
        """Whether there is a server with all services and topics. Raises RCLError after a shutdown of the context."""
        with self._node.handle:
            if not self._node.context.ok():
                raise RCLError("Failed to check if action server is available: rcl node's context is invalid")
            topics = (self._feedback.topic_name, self._status.topic_name)
            return all(map(self._node.count_publishers, topics)) and all(
                client.service_is_ready() for client in (self._goals, self._cancellations, self._results)
            )

    def wait_for_server(self, timeout_sec: float | None = None) -> bool:
        """Wait for a server; return whether there is one. None stands for a wait without end."""
        timeout_s = None if timeout_sec is None else max(0.0, timeout_sec)
        self._node.context.wait_for(self.server_is_ready, timeout_s, f"the server of action {self._name}")
        return self.server_is_ready()

    def destroy(self) -> None:
        """Receive no more responses, feedback and states."""
        self._parts.destroy()

    def _cancel_goal(self, goal_handle: ClientGoalHandle[GoalT, ResultT, FeedbackT]) -> ros_types.CancelGoal.Response:
        return _wait_for(self._cancel_goal_async(goal_handle), self._cancellations)

    def _cancel_goal_async(
        self, goal_handle: ClientGoalHandle[GoalT, ResultT, FeedbackT]
    ) -> Future[ros_types.CancelGoal.Response]:
        _require_handle(goal_handle)
        request = ros_types.CancelGoal.Request()
        request.goal_info.goal_id = goal_handle.goal_id
        return self._cancellations.call_async(request)

    def _get_result(self, goal_handle: ClientGoalHandle[GoalT, ResultT, FeedbackT]) -> Any:
        return _wait_for(self._get_result_async(goal_handle), self._results)

    def _get_result_async(self, goal_handle: ClientGoalHandle[GoalT, ResultT, FeedbackT]) -> Future[Any]:
        _require_handle(goal_handle)

        def note_end(response: Any) -> Any:
            self._feedback_callbacks.pop(bytes(goal_handle.goal_id.uuid), None)
            return response

        request: Any = self._action_type.Impl.GetResultService.Request
        return self._results.send(request(goal_id=goal_handle.goal_id), note_end)

    async def _pass_feedback(self, message: Any) -> None:
        callback = self._feedback_callbacks.get(bytes(message.goal_id.uuid))
        if callback is not None:
            await await_or_execute(callback, message)

    def _note_states(self, message: ros_types.GoalStatusArray) -> None:
        for one in message.status_list:
            key = bytes(one.goal_info.goal_id.uuid)
            handle = self._goal_handles.get(key)
            if handle is not None:
                handle._status = one.status
                if one.status in FINAL:
                    self._goal_handles.pop(key, None)


def _wait_for(future: Future[T], client: Client[Any, Any]) -> T:
    """The result of a future that another thread sets, with a response of a client. Raises its exception."""
    done = threading.Event()
    future.add_done_callback(lambda _: done.set())
    with client.named_wait():
        done.wait()
    return cast("T", future.result())


def _require_handle(goal_handle: object) -> None:
    if not isinstance(goal_handle, ClientGoalHandle):
        raise TypeError(f"Expected type ClientGoalHandle but received {type(goal_handle)}")
