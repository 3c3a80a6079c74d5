"""An int in a float field of a message is an error wherever tests run, with the line that set it."""

from __future__ import annotations

import pytest

pytest.importorskip("rclpy")

from tests.testing.ros.driver import NODE, TEST

CONFTEST = "from geometry_msgs.msg import Twist\n"


@pytest.mark.process
def test_a_node_under_test_is_checked_although_conftest_imports_the_messages(pytester, monkeypatch):
    monkeypatch.delenv("ROS_PYTHON_CHECK_FIELDS", raising=False)
    pytester.makeconftest(CONFTEST)
    pytester.makepyfile(driver=NODE.replace("command.linear.x = 0.1", "command.linear.x = 1"), test_driver=TEST)
    result = pytester.runpytest_subprocess("-p", "no:cacheprovider")
    result.assert_outcomes(failed=1)
    result.stdout.fnmatch_lines(["*command.linear.x = 1*", "*The 'x' field must be of type 'float'*"])
