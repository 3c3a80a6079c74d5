"""Which profiles of publishers and subscriptions fit."""

from __future__ import annotations

import pytest

pytest.importorskip("rclpy")

from rclpy.duration import Duration
from rclpy.qos import DurabilityPolicy, LivelinessPolicy, QoSProfile, ReliabilityPolicy
from std_msgs.msg import String

from thymio_sim_ros.lockstep.matching import fit


def test_a_plain_profile_fits_a_publisher_as_the_graph_describes_it(ros):
    """The graph has the liveliness that the middleware chose, a plain profile leaves it open."""
    ros.node.create_publisher(String, "said", 10)
    ros.until(lambda: ros.node.get_publishers_info_by_topic("/said"))
    assert fit(ros.node.get_publishers_info_by_topic("/said")[0].qos_profile, QoSProfile(depth=10))


@pytest.mark.parametrize(
    "wanted",
    [
        {"reliability": ReliabilityPolicy.RELIABLE},
        {"durability": DurabilityPolicy.TRANSIENT_LOCAL},
        {"deadline": Duration(seconds=1)},
        {"liveliness": LivelinessPolicy.MANUAL_BY_TOPIC},
    ],
)
def test_a_subscription_that_wants_more_does_not_fit(wanted):
    weak = QoSProfile(
        depth=1,
        reliability=ReliabilityPolicy.BEST_EFFORT,
        durability=DurabilityPolicy.VOLATILE,
        liveliness=LivelinessPolicy.AUTOMATIC,
    )
    assert fit(weak, weak)
    assert not fit(weak, QoSProfile(depth=1, **{"reliability": ReliabilityPolicy.BEST_EFFORT, **wanted}))
