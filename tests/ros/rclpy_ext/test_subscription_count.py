"""The count below rclpy is that of rclpy."""

from __future__ import annotations

from std_msgs.msg import String

from thymio_sim_ros.ros.rclpy_ext.subscription_count import counter


def test_subscriptions_come_and_go(ros):
    publisher = ros.node.create_publisher(String, "word", 5)
    count = counter(publisher)
    assert count() == publisher.get_subscription_count() == 0
    ros.collect(String, "word")
    ros.until(lambda: count() == 1, what="a listener")
    assert publisher.get_subscription_count() == 1
