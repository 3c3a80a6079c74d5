"""Nodes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from thymio_sim_ros.portable_ros import ros_types
from thymio_sim_ros.portable_ros.rclpy._rclpy_pybind11 import NodeNameNonExistentError as NodeNameNonExistentError
from thymio_sim_ros.portable_ros.rclpy.logging_service import LoggingService
from thymio_sim_ros.portable_ros.rclpy.parameter import Parameter
from thymio_sim_ros.portable_ros.rclpy.parameter_service import ParameterService
from thymio_sim_ros.portable_ros.rclpy.qos import qos_profile_parameter_events
from thymio_sim_ros.portable_ros.rclpy.time_source import TimeSource
from thymio_sim_ros.portable_ros.rclpy.type_description_service import TypeDescriptionService
from thymio_sim_ros.portable_ros.rclpy_parts.node_endpoints import NodeEndpoints
from thymio_sim_ros.portable_ros.rclpy_parts.node_graph import NodeGraph
from thymio_sim_ros.portable_ros.rclpy_parts.node_rosout import Rosout

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.rclpy.context import Context

__all__ = ["Node", "NodeNameNonExistentError"]

HIDDEN_NODE_PREFIX = "_"


class Node(NodeEndpoints, NodeGraph):
    """A node of the graph. Its callbacks run in the executor that it is added to."""

    PARAM_REL_TOL = 1e-6

    def __init__(
        self,
        node_name: str,
        *,
        context: Context | None = None,
        cli_args: Sequence[str] | None = None,
        namespace: str | None = None,
        use_global_arguments: bool = True,
        enable_rosout: bool = True,
        start_parameter_services: bool = True,
        parameter_overrides: Sequence[Parameter] | None = None,
        allow_undeclared_parameters: bool = False,
        automatically_declare_parameters_from_overrides: bool = False,
        enable_logger_service: bool = False,
    ) -> None:
        """Raises NotInitializedException, InvalidNodeNameException and InvalidNamespaceException."""
        super().__init__(node_name, context, cli_args, namespace, use_global_arguments)
        self._prepare_entities()
        self._graph.add_node(self)
        self._rosout = Rosout(self) if enable_rosout and self._context.arguments.has_rosout else None
        self._prepare_parameters(
            self._overrides(parameter_overrides or ()), is_undeclared_allowed=allow_undeclared_parameters
        )
        self._parameter_event_publisher = self.create_publisher(
            ros_types.ParameterEvent, "/parameter_events", qos_profile_parameter_events
        )
        if automatically_declare_parameters_from_overrides:
            items = [
                (name, one.value, ros_types.ParameterDescriptor()) for name, one in self._parameter_overrides.items()
            ]
            self.declare_parameters("", items, ignore_override=True)
        self._time_source = TimeSource(node=self)
        self._time_source.attach_clock(self._clock)
        if start_parameter_services:
            self._parameter_service = ParameterService(self)
        if enable_logger_service:
            self._logger_service = LoggingService(self)
        self._type_description_service = TypeDescriptionService(self)

    def destroy_node(self) -> None:
        """Remove the node with all that it has."""
        if not self._handle.is_valid:
            return
        if self._rosout is not None:
            self._rosout.close()
        self._time_source.detach_node()
        for end in [*self.all_publishers, *self.entities()]:
            self._remove(end)
        self._graph.remove_node(self)
        if self.executor is not None:
            self.executor.remove_node(self)
        self._handle.destroy_when_not_in_use()

    def _overrides(self, given: Sequence[Parameter]) -> dict[str, Parameter]:
        """The values of the start: of the command line, and those that were given to the node, which win."""
        found: dict[str, Parameter] = {}
        for arguments in reversed(self._arguments):
            values = arguments.values(self.get_fully_qualified_name())
            found |= {name: Parameter(name, value=value) for name, value in values.items()}
        return found | {one.name: one for one in given}
