"""Commands from the runtime of the same process: order, limits, robots that have ended."""

from __future__ import annotations

from std_msgs.msg import Int16MultiArray

from thymio_sim_ros.ros.simulator.local_commands import DEPTH, LocalCommands


def test_messages_of_all_topics_arrive_in_order(ros):
    heard = []
    commands = LocalCommands(ros.node, lambda *message: heard.append(message))
    sent = [("r1", "a", 1), ("r2", "a", 2), ("r1", "b", 3), ("r1", "a", 4)]
    for message in sent:
        commands.post(*message)
    ros.until(lambda: len(heard) == 4)
    assert heard == sent


def test_of_too_many_messages_of_a_topic_the_last_ones_arrive(ros):
    heard = []
    commands = LocalCommands(ros.node, lambda _robot, topic, message: heard.append((topic, message)))
    commands.post("r1", "first", 0)
    for number in range(DEPTH + 5):
        commands.post("r1", "a", number)
    commands.deliver()
    assert heard == [("first", 0), *(("a", number) for number in range(5, DEPTH + 5))]


def test_messages_before_the_node_spins_are_not_lost(ros):
    node, heard = ros.make_node("other"), []
    ros._executor.remove_node(node)
    node.executor = None
    commands = LocalCommands(node, lambda *message: heard.append(message))
    commands.post("r1", "a", 1)
    commands.deliver()
    assert heard == [("r1", "a", 1)]


def test_the_simulator_handles_them_as_messages_of_the_topic(ros, simulator_with):
    simulator = simulator_with(playground="two_robots")
    for robot in ("red", "unknown"):
        simulator.local_commands.post(robot, "_motor/target", Int16MultiArray(data=[100, 100]))
    simulator.local_commands.deliver()
    robots = simulator.runner.world.robots
    before = {name: robots[name].pose for name in ("red", "blue")}
    simulator.runner.step(20)
    assert robots["red"].pose != before["red"]
    assert robots["blue"].pose == before["blue"]
