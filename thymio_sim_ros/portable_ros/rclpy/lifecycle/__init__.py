"""Lifecycle nodes: nodes with states, which others change by services."""

from thymio_sim_ros.portable_ros.rclpy.lifecycle.managed_entity import ManagedEntity, SimpleManagedEntity
from thymio_sim_ros.portable_ros.rclpy.lifecycle.node import LifecycleNode, LifecycleNodeMixin, LifecycleState
from thymio_sim_ros.portable_ros.rclpy.lifecycle.publisher import LifecyclePublisher
from thymio_sim_ros.portable_ros.rclpy_parts.state_machine import TransitionCallbackReturn

Node = LifecycleNode
NodeMixin = LifecycleNodeMixin
State = LifecycleState
Publisher = LifecyclePublisher

__all__ = [
    "LifecycleNode",
    "LifecycleNodeMixin",
    "LifecyclePublisher",
    "LifecycleState",
    "ManagedEntity",
    "Node",
    "NodeMixin",
    "Publisher",
    "SimpleManagedEntity",
    "State",
    "TransitionCallbackReturn",
]
