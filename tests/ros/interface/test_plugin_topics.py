"""What a plug-in adds, up to its topics: the package of docs/plugins.md on a running simulator."""

import json

import pytest
from std_msgs.msg import Float64MultiArray, Int16MultiArray, String
from visualization_msgs.msg import MarkerArray

from tests import plugin_page
from thymio_sim_ros.ros.interface import plugin_topics


@pytest.fixture(autouse=True)
def extras(tmp_path, monkeypatch):
    with plugin_page.installed(tmp_path, plugin_page.files(), monkeypatch):
        yield


def test_the_sensor_of_the_page_is_published(ros, simulation):
    sim = simulation(playground="slalom_field")
    headings = ros.collect(Int16MultiArray, "/_raw/compass")
    sim.until(lambda: headings)
    assert abs(headings[0].data[0]) < 10


def test_the_actuator_of_the_page_obeys_its_topic(ros, simulation):
    sim = simulation(playground="slalom_field")
    hop = ros.publisher(Float64MultiArray, "/actuator/hop")
    hop.publish(Float64MultiArray(data=[0.1]))
    sim.until(lambda: sim.world.robots["thymio"].pose.x_m > -0.76)


def test_the_shape_of_the_page_is_drawn(ros, simulation):
    sim = simulation(playground="slalom_field")
    shown = ros.collect(MarkerArray, "/_markers", transient_local=True)
    sim.until(lambda: shown)
    assert sum(marker.ns == "solid/posts" for marker in shown[-1].markers) == 5


def test_the_playground_of_the_page_is_listed(ros, simulation):
    sim = simulation()
    lists = ros.collect(String, "/simulator/_playgrounds", transient_local=True)
    sim.until(lambda: lists)
    assert "slalom_field" in [shown["name"] for shown in json.loads(lists[-1].data)]


def test_a_command_survives_its_message():
    (row,) = plugin_topics.rows()
    command = row.decode(Float64MultiArray(data=[0.05]))
    assert row.decode(row.encode(command)) == command
    assert row.encode(command).layout.dim[0].label == "distance_m"
    assert plugin_topics.topic_of(command) == row.topic == "actuator/hop"


@pytest.mark.parametrize("data", [[], [1.0, 2.0], [float("nan")], [5.0]])
def test_a_command_of_other_numbers_is_refused(data):
    (row,) = plugin_topics.rows()
    with pytest.raises(ValueError, match="expected"):
        row.decode(Float64MultiArray(data=data))
