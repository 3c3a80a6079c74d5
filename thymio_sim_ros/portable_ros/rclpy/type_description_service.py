"""The parameter of a node that is about its service `get_type_description`, which is not offered here."""

from __future__ import annotations

from typing import TYPE_CHECKING

from thymio_sim_ros.portable_ros import ros_types

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.rclpy.node_parameters import NodeParameters

__all__ = ["START_TYPE_DESCRIPTION_SERVICE_PARAM", "declare_start_parameter"]

START_TYPE_DESCRIPTION_SERVICE_PARAM = "start_type_description_service"


def declare_start_parameter(node: NodeParameters) -> None:
    """Declare the parameter of a node, unless it is declared."""
    if not node.has_parameter(START_TYPE_DESCRIPTION_SERVICE_PARAM):
        descriptor = ros_types.ParameterDescriptor(
            description="If enabled, start the ~/get_type_description service.", read_only=True
        )
        node.declare_parameter(START_TYPE_DESCRIPTION_SERVICE_PARAM, True, descriptor)
