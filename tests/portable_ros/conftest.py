"""Fixtures of tests of the embedded graph."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from thymio_sim_ros.portable_ros.rclpy.context import Context
from thymio_sim_ros.portable_ros.rclpy.node import Node


@pytest.fixture
def node() -> Iterator[Node]:
    context = Context()
    context.init([])
    made = Node("tested", context=context, enable_rosout=False, start_parameter_services=False)
    yield made
    made.destroy_node()
    context.try_shutdown()
