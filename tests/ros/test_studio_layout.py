"""The layouts against the running suite: every topic and service they name is there."""

from __future__ import annotations

import re

import pytest

from tests.bridge.studio import Studio
from thymio_sim_ros.studio_layout import render

DATATYPE = re.compile(r'"topicName": "(/[\w/]+)",\s*"datatype": "([\w/]+)"')


@pytest.fixture
def suite(ros, bridge, request):
    """Simulator, runtime and bridge, and a client of it; of the playground that a test asks for, or of `line`."""
    playground, robots = getattr(request, "param", ("line", [""]))
    from thymio_sim_ros.ros.aseba.node import AsebaRuntime, RuntimeParams
    from thymio_sim_ros.ros.simulator.node import Simulator, SimulatorParams
    from thymio_sim_ros.ros.simulator.parameters import LidarParams

    ros.live(Simulator(ros.context, SimulatorParams(playground=playground, lidar=LidarParams(enabled=True))))
    ros.live(AsebaRuntime(ros.context, RuntimeParams(robots=robots, path="line_follower"), use_sim_time=True))
    with Studio(bridge(use_sim_time=True).port, ros.until) as studio:
        yield studio


@pytest.mark.parametrize(
    ("suite", "robot"),
    [(("line", [""]), ""), (("two_robots", ["red", "blue"]), "blue")],
    indirect=["suite"],
)
def test_every_name_of_the_layout_is_in_the_running_suite(ros, suite, robot):
    text = render("lichtblick", robot)
    names = {name.partition(".")[0] for name in re.findall(r'"(/[\w/.]+)', text)}
    services = set(re.findall(r'"serviceName": "(/[\w/]+)"', text))
    assert len(names) > 30
    assert len(services) > 5

    def missing():
        suite.read()
        return (names - services - suite.channels.keys()) | (services - suite.services.keys())

    ros.until(lambda: not missing(), what="all names of the layout")


def test_what_the_layout_publishes_has_the_type_of_its_topic(ros, suite):
    published = DATATYPE.findall(render("lichtblick"))
    assert len(published) > 5
    for topic, datatype in published:
        assert suite.channel(topic).schema_name == datatype
