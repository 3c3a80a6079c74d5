"""Servers of actions."""

from __future__ import annotations

import functools
import threading
import traceback
from typing import Any

from thymio_sim_ros.portable_ros import ros_types
from thymio_sim_ros.portable_ros.messages.action_class import Action, FeedbackT, GoalT, ResultT
from thymio_sim_ros.portable_ros.rclpy._rclpy_pybind11 import RCLError
from thymio_sim_ros.portable_ros.rclpy.callback_groups import CallbackGroup
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
    Respond,
)
from thymio_sim_ros.portable_ros.rclpy_parts.goal_callbacks import (
    AcceptedCallback,
    CancelCallback,
    GoalCallback,
)
from thymio_sim_ros.portable_ros.rclpy_parts.goal_callbacks import CancelResponse as CancelResponse
from thymio_sim_ros.portable_ros.rclpy_parts.goal_callbacks import GoalResponse as GoalResponse
from thymio_sim_ros.portable_ros.rclpy_parts.goal_callbacks import default_cancel_callback as default_cancel_callback
from thymio_sim_ros.portable_ros.rclpy_parts.goal_callbacks import default_goal_callback as default_goal_callback
from thymio_sim_ros.portable_ros.rclpy_parts.goal_callbacks import (
    default_handle_accepted_callback as default_handle_accepted_callback,
)
from thymio_sim_ros.portable_ros.rclpy_parts.goal_state import GoalEvent as GoalEvent
from thymio_sim_ros.portable_ros.rclpy_parts.goal_state import to_cancel
from thymio_sim_ros.portable_ros.rclpy_parts.result_expiry import ResultExpiry
from thymio_sim_ros.portable_ros.rclpy_parts.server_goal_handle import ExecuteCallback
from thymio_sim_ros.portable_ros.rclpy_parts.server_goal_handle import ServerGoalHandle as ServerGoalHandle


class ActionServer(ActionEnd[GoalT, ResultT, FeedbackT]):
    """Accepts, executes and cancels goals by callbacks, which may be coroutines, and keeps their results for a time."""

    def __init__(
        self,
        node: Node,
        action_type: type[Action[GoalT, ResultT, FeedbackT]],
        action_name: str,
        execute_callback: ExecuteCallback[GoalT, ResultT, FeedbackT],
        *,
        callback_group: CallbackGroup | None = None,
        goal_callback: GoalCallback[GoalT] | None = default_goal_callback,
        handle_accepted_callback: AcceptedCallback[GoalT, ResultT, FeedbackT] | None = default_handle_accepted_callback,
        cancel_callback: CancelCallback[GoalT, ResultT, FeedbackT] | None = default_cancel_callback,
        goal_service_qos_profile: QoSProfile = qos_profile_services_default,
        result_service_qos_profile: QoSProfile = qos_profile_services_default,
        cancel_service_qos_profile: QoSProfile = qos_profile_services_default,
        feedback_pub_qos_profile: QoSProfile = QoSProfile(depth=10),  # noqa: B008  # as rclpy's
        status_pub_qos_profile: QoSProfile = qos_profile_action_status_default,
        result_timeout: float = 900,
    ) -> None:
        """`result_timeout`: seconds of the node's clock from the end of a goal, from 0.

        Raises TypeError for a callback that cannot be called, ValueError for a wrong name or time, and errors about the
        type.
        """
        self.register_handle_accepted_callback(handle_accepted_callback)
        self.register_goal_callback(goal_callback)
        self.register_cancel_callback(cancel_callback)
        self.register_execute_callback(execute_callback)
        super().__init__(node, action_type, action_name, callback_group, "server")
        self._logger = node.get_logger().get_child("action_server")
        self.lock = threading.RLock()
        """Guards the goals and their states, and orders what is published of them."""
        self._goal_handles: dict[bytes, ServerGoalHandle[GoalT, ResultT, FeedbackT]] = {}
        self._result_futures: dict[bytes, Future[Any]] = {}
        with self._assembly() as (parts, impl):
            self._expiry = ResultExpiry(parts.timer, node.get_clock(), result_timeout, self._forget, self.lock)
            self._feedback = parts.publisher(impl.FeedbackMessage, FEEDBACK, feedback_pub_qos_profile)
            self._status = parts.publisher(impl.GoalStatusMessage, STATUS, status_pub_qos_profile)
            parts.service(impl.SendGoalService, SEND_GOAL, self._on_goal, goal_service_qos_profile)
            parts.service(impl.CancelGoalService, CANCEL_GOAL, self._on_cancel, cancel_service_qos_profile)
            parts.service(impl.GetResultService, GET_RESULT, self._on_result_request, result_service_qos_profile)

    def register_goal_callback(self, goal_callback: GoalCallback[GoalT] | None) -> None:
        """Set what decides about new goals; None accepts all."""
        self._goal_callback = goal_callback or default_goal_callback

    def register_handle_accepted_callback(
        self, handle_accepted_callback: AcceptedCallback[GoalT, ResultT, FeedbackT] | None
    ) -> None:
        """Set what is called with each accepted goal; None executes it."""
        self._handle_accepted_callback = handle_accepted_callback or default_handle_accepted_callback

    def register_cancel_callback(self, cancel_callback: CancelCallback[GoalT, ResultT, FeedbackT] | None) -> None:
        """Set what decides about requests to cancel a goal; None rejects all."""
        self._cancel_callback = cancel_callback or default_cancel_callback

    def register_execute_callback(self, execute_callback: ExecuteCallback[GoalT, ResultT, FeedbackT]) -> None:
        """Set what executes goals and returns their results. Raises TypeError for what cannot be called."""
        if not callable(execute_callback):
            raise TypeError("Failed to register goal execution callback: not callable")
        self._execute_callback = execute_callback

    def notify_execute(
        self,
        goal_handle: ServerGoalHandle[GoalT, ResultT, FeedbackT],
        execute_callback: ExecuteCallback[GoalT, ResultT, FeedbackT] | None,
    ) -> None:
        """Let the executor of the node execute a goal by a callback, by default that of the server."""
        executor: Any = self._node.executor
        executor.create_task(self._execute, execute_callback or self._execute_callback, goal_handle)

    def publish_feedback(self, goal_handle: ServerGoalHandle[GoalT, ResultT, FeedbackT], feedback: FeedbackT) -> None:
        """Publish feedback of a goal."""
        message: Any = self._action_type.Impl.FeedbackMessage
        self._feedback.publish(message(goal_id=goal_handle.goal_id, feedback=feedback))

    def state_changed(self, goal_handle: ServerGoalHandle[GoalT, ResultT, FeedbackT]) -> None:
        """Publish the states of all goals, one of which has changed; keep the result of one that has ended."""
        self._publish_status()
        if not goal_handle.is_active:
            self._expiry.start(bytes(goal_handle.goal_id.uuid))

    def destroy(self) -> None:
        """Offer the action no more; its goals become unknown."""
        with self.lock:
            self._parts.destroy()
            for goal_id in list(self._goal_handles):
                self._forget(goal_id)

    async def _on_goal(self, request: Any, respond: Respond) -> None:
        info = ros_types.GoalInfo(goal_id=request.goal_id)
        handle = None
        if bytes(request.goal_id.uuid) not in self._goal_handles and await self._accepts(request.goal):
            info.stamp = self._node.get_clock().now().to_msg()
            handle = self._track(ServerGoalHandle(self, info, request.goal))
        response: Any = self._action_type.Impl.SendGoalService.Response
        respond(response(accepted=handle is not None, stamp=info.stamp))
        if handle is not None:
            self._publish_status()
            await await_or_execute(self._handle_accepted_callback, handle)

    async def _accepts(self, goal: GoalT) -> bool:
        response = await await_or_execute(self._goal_callback, goal)
        if not isinstance(response, GoalResponse):
            self._logger.warning("Goal request callback did not return a GoalResponse type. Rejecting goal.")
        return response is GoalResponse.ACCEPT

    def _track(
        self, handle: ServerGoalHandle[GoalT, ResultT, FeedbackT]
    ) -> ServerGoalHandle[GoalT, ResultT, FeedbackT] | None:
        """Keep a new goal; None if another one of the same id was accepted meanwhile."""
        with self.lock:
            goal_id = bytes(handle.goal_id.uuid)
            if goal_id in self._goal_handles:
                return None
            self._goal_handles[goal_id], self._result_futures[goal_id] = handle, Future()
            return handle

    async def _on_cancel(self, request: ros_types.CancelGoal.Request, respond: Respond) -> None:
        with self.lock:
            return_code, chosen = to_cancel(request.goal_info, self._goal_handles.values())
        response = ros_types.CancelGoal.Response(return_code=return_code)
        for handle in chosen:
            if await await_or_execute(self._cancel_callback, handle) is not CancelResponse.ACCEPT:
                continue
            try:
                handle._update_state(GoalEvent.CANCEL_GOAL)
            except RCLError as error:  # it has ended since the callback was asked
                self._logger.debug(f"Failed to cancel goal in cancel callback: {error}")
            else:
                response.goals_canceling = [*response.goals_canceling, handle.info]
        respond(response)

    def _on_result_request(self, request: Any, respond: Respond) -> None:
        with self.lock:
            future = self._result_futures.get(bytes(request.goal_id.uuid))
        if future is None:
            response: Any = self._action_type.Impl.GetResultService.Response
            respond(response(status=ros_types.GoalStatus.STATUS_UNKNOWN))
        else:
            future.add_done_callback(functools.partial(_send_result, respond))

    async def _execute(
        self,
        execute_callback: ExecuteCallback[GoalT, ResultT, FeedbackT],
        handle: ServerGoalHandle[GoalT, ResultT, FeedbackT],
    ) -> None:
        """Execute a goal, end it if the callback has not, and keep its result. Raises TypeError for a wrong result."""
        try:
            result = await await_or_execute(execute_callback, handle)
        except Exception as error:
            result = self._action_type.Result()
            self._logger.error(f"Error raised in execute callback: {error}")
            traceback.print_exc()
        if handle.is_active:
            self._logger.warning(f"Goal state not set, assuming aborted. Goal ID: {handle.goal_id.uuid}")
            handle.abort()
        if not isinstance(result, self._action_type.Result):
            raise TypeError(f"execute callback: found the result {result!r}, expected {self._action_type.Result}")
        with self.lock:
            future = self._result_futures.get(bytes(handle.goal_id.uuid))
        if future is not None:
            response: Any = self._action_type.Impl.GetResultService.Response
            future.set_result(response(status=handle.status, result=result))

    def _publish_status(self) -> None:
        with self.lock:
            states = [
                ros_types.GoalStatus(goal_info=one.info, status=one.status) for one in self._goal_handles.values()
            ]
            self._status.publish(ros_types.GoalStatusArray(status_list=states))

    def _forget(self, goal_id: bytes) -> None:
        """Forget a goal and its result."""
        with self.lock:
            self._goal_handles.pop(goal_id).destroy()
            del self._result_futures[goal_id]


def _send_result(respond: Respond, future: Future[Any]) -> None:
    response: Any = future.result()
    respond(response)
