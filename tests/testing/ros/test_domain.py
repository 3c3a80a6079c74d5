"""Domains: private to a test, free of others, left as they were found."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

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


PARTICIPANT = """
import rclpy
from pathlib import Path
rclpy.init()
node = rclpy.create_node("one")
print("/dev/shm/fastrtps_" in Path("/proc/self/maps").read_text())
"""


@pytest.mark.process
@pytest.mark.skipif(not Path("/proc/self/maps").exists(), reason="needs /proc")
def test_shared_memory_is_used_only_where_it_is_wanted():
    for wanted in (True, False):
        with reserved(shared_memory=wanted):
            run = subprocess.run([sys.executable, "-c", PARTICIPANT], capture_output=True, text=True, check=True)
        assert run.stdout == f"{wanted}\n"


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
