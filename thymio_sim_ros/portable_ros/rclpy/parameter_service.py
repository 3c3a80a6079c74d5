"""The services of a node by which others read and set its parameters."""

from __future__ import annotations

import weakref
from collections.abc import Sequence
from typing import Any

from thymio_sim_ros.portable_ros import ros_types
from thymio_sim_ros.portable_ros.rclpy.exceptions import (
    ParameterNotDeclaredException,
    ParameterUninitializedException,
)
from thymio_sim_ros.portable_ros.rclpy.parameter import Parameter
from thymio_sim_ros.portable_ros.rclpy.qos import qos_profile_parameters

__all__ = ["ParameterService"]


class ParameterService:
    """Offers the six services. Invariant: keeps no node alive."""

    def __init__(self, node: Any) -> None:
        """`node`: a node, or an object with its methods."""
        self._node_reference = weakref.ref(node)
        for kind, name, callback in (
            (ros_types.DescribeParameters, "describe_parameters", self._describe),
            (ros_types.GetParameters, "get_parameters", self._get),
            (ros_types.GetParameterTypes, "get_parameter_types", self._get_types),
            (ros_types.ListParameters, "list_parameters", self._list),
            (ros_types.SetParameters, "set_parameters", self._set),
            (ros_types.SetParametersAtomically, "set_parameters_atomically", self._set_atomically),
        ):
            full = f"{node.get_name()}/{name}"
            node.create_service(kind, full, callback, qos_profile=qos_profile_parameters)

    @property
    def _node(self) -> Any:
        node = self._node_reference()
        if node is None:
            raise ReferenceError("Expected valid node weak reference")
        return node

    def _describe(
        self, request: ros_types.DescribeParameters.Request, response: ros_types.DescribeParameters.Response
    ) -> ros_types.DescribeParameters.Response:
        for name in request.names:
            try:
                response.descriptors.append(self._node.describe_parameter(name))
            except ParameterNotDeclaredException:
                response.descriptors = self._node.describe_parameters([])
                return response
        return response

    def _get(
        self, request: ros_types.GetParameters.Request, response: ros_types.GetParameters.Response
    ) -> ros_types.GetParameters.Response:
        for name in request.names:
            try:
                parameter = self._node.get_parameter(name)
            except (ParameterNotDeclaredException, ParameterUninitializedException):
                response.values = []
                return response
            response.values.append(parameter.get_parameter_value())
        return response

    def _get_types(
        self, request: ros_types.GetParameterTypes.Request, response: ros_types.GetParameterTypes.Response
    ) -> ros_types.GetParameterTypes.Response:
        for name in request.names:
            try:
                kind = self._node.get_parameter_type(name)
            except ParameterNotDeclaredException:
                response.types = []
                return response
            response.types.append(kind.value if isinstance(kind, Parameter.Type) else kind)
        return response

    def _list(
        self, request: ros_types.ListParameters.Request, response: ros_types.ListParameters.Response
    ) -> ros_types.ListParameters.Response:
        response.result = self._node.list_parameters(list(request.prefixes), request.depth)
        return response

    def _set(
        self, request: ros_types.SetParameters.Request, response: ros_types.SetParameters.Response
    ) -> ros_types.SetParameters.Response:
        for one in request.parameters:
            response.results.append(self._result([one]))
        return response

    def _set_atomically(
        self, request: ros_types.SetParametersAtomically.Request, response: ros_types.SetParametersAtomically.Response
    ) -> ros_types.SetParametersAtomically.Response:
        response.result = self._result(request.parameters)
        return response

    def _result(self, messages: Sequence[ros_types.ParameterMessage]) -> ros_types.SetParametersResult:
        try:
            parameters = [Parameter.from_parameter_msg(one) for one in messages]
            result: ros_types.SetParametersResult = self._node.set_parameters_atomically(parameters)
        except ParameterNotDeclaredException as error:
            return ros_types.SetParametersResult(successful=False, reason=str(error))
        return result
