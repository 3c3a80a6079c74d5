"""All nodes in one process: what a start of the suite chooses reaches the node that it is meant for."""

from __future__ import annotations

from thymio_sim_ros.device.options import DeviceOptions
from thymio_sim_ros.nodes import all_nodes
from thymio_sim_ros.suite import Suite


def test_the_choices_of_a_start_reach_their_nodes(ros, tmp_path):
    device = DeviceOptions("playground", "playground", tmp_path / "card", tmp_path / "flash")
    models = {"motor_model": "firmware", "proximity_model": "cone"}
    suite = Suite(playground="base", program="none", device=device, **models, web=False, foxglove=False)
    simulator, runtime = (ros.live(life) for life in all_nodes.lives(ros.context, suite))
    assert simulator.params.motor_model == "firmware"
    assert simulator.params.proximity_model == "cone"
    assert runtime.params.options == device
    (robot,) = runtime.robots
    assert robot.device.layout == "playground"
    assert robot.device.get_variable("sd.present") == (1,)
