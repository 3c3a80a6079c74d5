"""The domain and its reach, as a person reads them."""

from __future__ import annotations

import pytest

from thymio_sim_ros.names.domain import describe_domain

RANGE = "ROS_AUTOMATIC_DISCOVERY_RANGE"


@pytest.mark.parametrize(
    ("environment", "reported"),
    [
        ({}, "ROS_DOMAIN_ID 0, this network"),
        ({"ROS_DOMAIN_ID": "7", RANGE: "SUBNET"}, "ROS_DOMAIN_ID 7, this network"),
        ({"ROS_DOMAIN_ID": "7", RANGE: "localhost"}, "ROS_DOMAIN_ID 7, this computer only"),
        ({RANGE: "OFF"}, "ROS_DOMAIN_ID 0, this process only"),
        ({RANGE: "SYSTEM_DEFAULT"}, "ROS_DOMAIN_ID 0, as DDS is configured"),
        ({RANGE: "SUBNET", "ROS_LOCALHOST_ONLY": "1"}, "ROS_DOMAIN_ID 0, this computer only"),
    ],
)
def test_domain_and_reach_are_one_line(environment, reported):
    assert describe_domain(environment) == reported


def test_a_domain_that_is_known_goes_first():
    assert describe_domain({"ROS_DOMAIN_ID": "7"}, 9) == "ROS_DOMAIN_ID 9, this network"
