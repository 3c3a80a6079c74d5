"""A client of the services by which a node offers its parameters."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

from thymio_sim_ros.portable_ros import ros_types
from thymio_sim_ros.portable_ros.graph.deadline import Deadline
from thymio_sim_ros.portable_ros.messages.message_class import Service, SrvRequestT, SrvResponseT
from thymio_sim_ros.portable_ros.rclpy.callback_groups import CallbackGroup
from thymio_sim_ros.portable_ros.rclpy.client import Client
from thymio_sim_ros.portable_ros.rclpy.event_handler import SubscriptionEventCallbacks
from thymio_sim_ros.portable_ros.rclpy.node import Node
from thymio_sim_ros.portable_ros.rclpy.parameter import Parameter, parameter_dict_from_yaml_file
from thymio_sim_ros.portable_ros.rclpy.qos import (
    QoSProfile,
    qos_profile_parameter_events,
    qos_profile_services_default,
)
from thymio_sim_ros.portable_ros.rclpy.qos_overriding_options import QoSOverridingOptions
from thymio_sim_ros.portable_ros.rclpy.subscription import MessageInfo, Subscription
from thymio_sim_ros.portable_ros.rclpy.task import Future

__all__ = ["AsyncParameterClient"]

DoneCallback = Callable[[Future[SrvResponseT]], object]


class AsyncParameterClient:
    """Reads and sets parameters of another node; the futures get the responses of its services."""

    def __init__(
        self,
        node: Node,
        remote_node_name: str,
        qos_profile: QoSProfile = qos_profile_services_default,
        callback_group: CallbackGroup | None = None,
    ) -> None:
        self.node, self.remote_node_name = node, remote_node_name

        def client(kind: type[Service[SrvRequestT, SrvResponseT]], name: str) -> Client[SrvRequestT, SrvResponseT]:
            full = f"{remote_node_name}/{name}"
            return node.create_client(kind, full, qos_profile=qos_profile, callback_group=callback_group)

        self._get = client(ros_types.GetParameters, "get_parameters")
        self._list = client(ros_types.ListParameters, "list_parameters")
        self._set = client(ros_types.SetParameters, "set_parameters")
        self._get_types = client(ros_types.GetParameterTypes, "get_parameter_types")
        self._describe = client(ros_types.DescribeParameters, "describe_parameters")
        self._set_atomically = client(ros_types.SetParametersAtomically, "set_parameters_atomically")

    @property
    def _clients(self) -> tuple[Client[Any, Any], ...]:
        return self._get, self._list, self._set, self._get_types, self._describe, self._set_atomically

    def services_are_ready(self) -> bool:
        """Whether the node offers all services."""
        return all(one.service_is_ready() for one in self._clients)

    def wait_for_services(self, timeout_sec: float | None = None) -> bool:
        """Wait for all services; return whether they are there."""
        deadline = Deadline(None if timeout_sec is None else max(0.0, timeout_sec))
        return all(one.wait_for_service(deadline.left_s()) for one in self._clients)

    def list_parameters(
        self,
        prefixes: list[str] | None = None,
        depth: int | None = None,
        callback: DoneCallback[ros_types.ListParameters.Response] | None = None,
    ) -> Future[ros_types.ListParameters.Response]:
        """Ask for the names of parameters; without `depth`, at any depth."""
        request = ros_types.ListParameters.Request(prefixes=prefixes or [], depth=depth or 0)
        return _call(self._list, request, callback)

    def get_parameters(
        self, names: list[str], callback: DoneCallback[ros_types.GetParameters.Response] | None = None
    ) -> Future[ros_types.GetParameters.Response]:
        """Ask for values."""
        return _call(self._get, ros_types.GetParameters.Request(names=names), callback)

    def set_parameters(
        self,
        parameters: Sequence[Parameter | ros_types.ParameterMessage],
        callback: DoneCallback[ros_types.SetParameters.Response] | None = None,
    ) -> Future[ros_types.SetParameters.Response]:
        """Set parameters one after the other; they are objects or messages."""
        request = ros_types.SetParameters.Request(parameters=_messages(parameters))
        return _call(self._set, request, callback)

    def describe_parameters(
        self, names: list[str], callback: DoneCallback[ros_types.DescribeParameters.Response] | None = None
    ) -> Future[ros_types.DescribeParameters.Response]:
        """Ask for descriptors."""
        return _call(self._describe, ros_types.DescribeParameters.Request(names=names), callback)

    def get_parameter_types(
        self, names: list[str], callback: DoneCallback[ros_types.GetParameterTypes.Response] | None = None
    ) -> Future[ros_types.GetParameterTypes.Response]:
        """Ask for types."""
        return _call(self._get_types, ros_types.GetParameterTypes.Request(names=names), callback)

    def set_parameters_atomically(
        self,
        parameters: Sequence[Parameter | ros_types.ParameterMessage],
        callback: DoneCallback[ros_types.SetParametersAtomically.Response] | None = None,
    ) -> Future[ros_types.SetParametersAtomically.Response]:
        """Set all parameters or none; they are objects or messages."""
        request = ros_types.SetParametersAtomically.Request(parameters=_messages(parameters))
        return _call(self._set_atomically, request, callback)

    def delete_parameters(
        self, names: list[str], callback: DoneCallback[ros_types.SetParameters.Response] | None = None
    ) -> Future[ros_types.SetParameters.Response]:
        """Undeclare parameters, which only those with a dynamic type permit."""
        return self.set_parameters([Parameter(name) for name in names], callback)

    def load_parameter_file(
        self,
        parameter_file: str,
        use_wildcard: bool = False,
        callback: DoneCallback[ros_types.SetParameters.Response] | None = None,
    ) -> Future[ros_types.SetParameters.Response]:
        """Set the parameters of a file one after the other."""
        found = parameter_dict_from_yaml_file(parameter_file, use_wildcard)
        return self.set_parameters(list(found.values()), callback)

    def load_parameter_file_atomically(
        self,
        parameter_file: str,
        use_wildcard: bool = False,
        callback: DoneCallback[ros_types.SetParametersAtomically.Response] | None = None,
    ) -> Future[ros_types.SetParametersAtomically.Response]:
        """Set all parameters of a file or none."""
        found = parameter_dict_from_yaml_file(parameter_file, use_wildcard)
        return self.set_parameters_atomically(list(found.values()), callback)

    def on_parameter_event(
        self,
        callback: Callable[[Any], object] | Callable[[Any, MessageInfo], object],
        qos_profile: QoSProfile = qos_profile_parameter_events,
        *,
        callback_group: CallbackGroup | None = None,
        event_callbacks: SubscriptionEventCallbacks | None = None,
        qos_overriding_options: QoSOverridingOptions | None = None,
        raw: bool = False,
    ) -> Subscription:
        """Call back after changes of parameters of all nodes."""
        return self.node.create_subscription(
            ros_types.ParameterEvent,
            "/parameter_events",
            callback,
            qos_profile,
            callback_group=callback_group,
            event_callbacks=event_callbacks,
            qos_overriding_options=qos_overriding_options,
            raw=raw,
        )


def _call(
    client: Client[SrvRequestT, SrvResponseT], request: SrvRequestT, callback: DoneCallback[SrvResponseT] | None
) -> Future[SrvResponseT]:
    future = client.call_async(request)
    if callback is not None:
        future.add_done_callback(callback)
    return future


def _messages(parameters: Sequence[Parameter | ros_types.ParameterMessage]) -> list[ros_types.ParameterMessage]:
    return [one.to_parameter_msg() if isinstance(one, Parameter) else one for one in parameters]
