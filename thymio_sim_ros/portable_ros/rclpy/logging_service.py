"""The services of a node by which others read and set the levels of logs of its process."""

from __future__ import annotations

from typing import TYPE_CHECKING

from thymio_sim_ros.portable_ros import ros_types
from thymio_sim_ros.portable_ros.rclpy.logging import get_logger_level, set_logger_level

if TYPE_CHECKING:
    from thymio_sim_ros.portable_ros.rclpy_parts.node_endpoints import NodeEndpoints

__all__ = ["LoggingService"]


class LoggingService:
    """Offers the two services."""

    def __init__(self, node: NodeEndpoints) -> None:
        name = node.get_name()
        node.create_service(ros_types.GetLoggerLevels, f"{name}/get_logger_levels", self._get)
        node.create_service(ros_types.SetLoggerLevels, f"{name}/set_logger_levels", self._set)

    def _get(
        self, request: ros_types.GetLoggerLevels.Request, response: ros_types.GetLoggerLevels.Response
    ) -> ros_types.GetLoggerLevels.Response:
        response.levels = [ros_types.LoggerLevel(name=name, level=get_logger_level(name)) for name in request.names]
        return response

    def _set(
        self, request: ros_types.SetLoggerLevels.Request, response: ros_types.SetLoggerLevels.Response
    ) -> ros_types.SetLoggerLevels.Response:
        for one in request.levels:
            result = ros_types.SetLoggerLevelsResult(successful=True)
            try:
                set_logger_level(one.name, one.level, detailed_error=True)
            except ValueError:
                result.successful, result.reason = False, "Failed reason: Invalid logger level."
            response.results.append(result)
        return response
