"""Domains: private to a test, free of others, left as they were found."""

from __future__ import annotations

import os

import pytest
import rclpy
from rclpy.context import Context

from thymio_sim_ros.testing.ros import domain
from thymio_sim_ros.testing.ros.domain import NoDomainError, reserved


def test_every_test_has_a_domain_of_its_own():
    own = os.environ.get("ROS_DOMAIN_ID")
    with reserved() as one, reserved() as other:
        assert one != other
        assert os.environ["ROS_DOMAIN_ID"] == str(other)
        assert os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] == "LOCALHOST"
    assert os.environ.get("ROS_DOMAIN_ID") == own


def test_the_user_s_own_domain_is_left_alone(monkeypatch):
    with reserved() as free:
        pass
    monkeypatch.setattr(domain, "DOMAINS", [free])
    monkeypatch.setenv("ROS_DOMAIN_ID", str(free))
    with pytest.raises(NoDomainError, match="no free ROS domain on this machine"), reserved():
        pass


def test_a_domain_in_use_is_skipped(monkeypatch):
    context = Context()
    with reserved() as busy:
        rclpy.init(args=[], context=context, domain_id=busy)
    node = rclpy.create_node("other", context=context)
    monkeypatch.setattr(domain, "DOMAINS", [busy])
    try:
        with pytest.raises(NoDomainError), reserved():
            pass
    finally:
        node.destroy_node()
        context.try_shutdown()
