"""Actions: goals that take time, with feedback, results and cancellation."""

from thymio_sim_ros.portable_ros.rclpy.action.client import ActionClient as ActionClient
from thymio_sim_ros.portable_ros.rclpy.action.graph import (
    get_action_client_names_and_types_by_node as get_action_client_names_and_types_by_node,
)
from thymio_sim_ros.portable_ros.rclpy.action.graph import get_action_names_and_types as get_action_names_and_types
from thymio_sim_ros.portable_ros.rclpy.action.graph import (
    get_action_server_names_and_types_by_node as get_action_server_names_and_types_by_node,
)
from thymio_sim_ros.portable_ros.rclpy.action.server import ActionServer as ActionServer
from thymio_sim_ros.portable_ros.rclpy.action.server import CancelResponse as CancelResponse
from thymio_sim_ros.portable_ros.rclpy.action.server import GoalResponse as GoalResponse
