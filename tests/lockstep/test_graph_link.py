"""Links of embedded graphs: what nodes of several processes see and get of each other."""

from __future__ import annotations

import json
from collections.abc import Iterator

import pytest

from thymio_sim_ros.lockstep.graph_link import GraphLink, LinkHub
from thymio_sim_ros.portable_ros.graph.graph import forget_graph
from thymio_sim_ros.portable_ros.messages.message_class import message_type, service_type
from thymio_sim_ros.portable_ros.rclpy.context import Context
from thymio_sim_ros.portable_ros.rclpy.executors import SingleThreadedExecutor
from thymio_sim_ros.portable_ros.rclpy.node import Node
from thymio_sim_ros.portable_ros.rclpy.qos import DurabilityPolicy, QoSProfile

STRING, BOOL = message_type("std_msgs/msg/String"), message_type("std_msgs/msg/Bool")
TRIGGER = service_type("std_srvs/srv/Trigger")
RETAINED = QoSProfile(depth=5, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class Process:
    """What stands for a process: a graph with one node."""

    def __init__(self, name: str, domain: int) -> None:
        forget_graph(domain)
        self.context = Context()
        self.context.init([], domain_id=domain)
        self.node = Node(name, context=self.context, namespace="/class", start_parameter_services=False)
        self.executor = SingleThreadedExecutor(context=self.context)
        self.executor.add_node(self.node)
        self.hub = LinkHub(self.context.graph)
        self.heard: list[str] = []

    def subscribe(self, topic: str, qos: QoSProfile | int = 10) -> None:
        self.node.create_subscription(STRING, topic, lambda message: self.heard.append(message.data), qos)

    def work(self) -> None:
        """Handle all that has arrived."""
        last = self.executor.create_task(lambda: None)
        for _ in range(20):
            self.executor.spin_once(timeout_sec=0)
        assert last.done()


@pytest.fixture
def processes() -> Iterator[list[Process]]:
    """The test, and two programs: the graphs of the programs are linked with that of the test."""
    made = [Process("test", 1), Process("one", 2), Process("two", 3)]
    yield made
    for process in made:
        process.node.destroy_node()
        process.context.try_shutdown()


def linked(one: Process, other: Process) -> tuple[GraphLink, GraphLink]:
    """Both ends of a new link."""
    return GraphLink(one.hub), GraphLink(other.hub)


def exchange(*links: tuple[GraphLink, GraphLink], turns: int = 3) -> None:
    """Pass on what there is, as text."""
    for _ in range(turns):
        for one, other in links:
            other.apply(json.loads(json.dumps(one.take())))
            one.apply(json.loads(json.dumps(other.take())))


def text(content: str) -> object:
    return STRING(data=content)


def test_messages_go_both_ways_and_from_program_to_program(processes: list[Process]) -> None:
    test, one, two = processes
    links = linked(test, one), linked(test, two)
    for process in processes:
        process.subscribe("/chatter")
    publishers = [process.node.create_publisher(STRING, "/chatter", 10) for process in processes]
    exchange(*links)
    for process, publisher in zip(processes, publishers, strict=True):
        assert publisher.get_subscription_count() == 3
        publisher.publish(text(process.node.get_name()))
    exchange(*links)
    for process in processes:
        process.work()
        assert sorted(process.heard) == ["one", "test", "two"]


def test_all_see_the_nodes_topics_and_profiles_of_all(processes: list[Process]) -> None:
    test, one, two = processes
    links = linked(test, one), linked(test, two)
    one.node.create_publisher(STRING, "map", RETAINED)
    exchange(*links)
    names = {f"/class/{name}" for name in ("test", "one", "two")}
    assert set(two.node.get_fully_qualified_node_names()) == names
    assert ("/class/map", ["std_msgs/msg/String"]) in two.node.get_topic_names_and_types()
    found = two.node.get_publishers_info_by_topic("map")[0]
    assert (found.node_name, found.qos_profile.depth) == ("one", 5)
    assert found.qos_profile.durability == DurabilityPolicy.TRANSIENT_LOCAL


def test_a_late_subscription_gets_what_is_retained_once(processes: list[Process]) -> None:
    test, one, two = processes
    links = linked(test, one), linked(test, two)
    one.node.create_publisher(STRING, "map", RETAINED).publish(text("drawn"))
    exchange(*links)
    two.subscribe("map", RETAINED)
    exchange(*links)
    two.work()
    assert two.heard == ["drawn"]


def test_a_service_of_one_program_answers_another_one_and_the_test(processes: list[Process]) -> None:
    test, one, two = processes
    links = linked(test, one), linked(test, two)
    one.node.create_service(
        TRIGGER, "stop", lambda _request, response: setattr(response, "message", "stops") or response
    )
    clients = [process.node.create_client(TRIGGER, "stop") for process in (test, two)]
    exchange(*links)
    assert all(client.service_is_ready() for client in clients)
    answers = [client.call_async(TRIGGER.Request()) for client in clients]
    exchange(*links)
    one.work()
    exchange(*links)
    for process, answer in zip((test, two), answers, strict=True):
        process.work()
        assert answer.result().message == "stops"


def test_the_last_message_of_a_node_arrives_and_then_the_node_has_gone(processes: list[Process]) -> None:
    test, one, _ = processes
    link = linked(test, one)
    test.subscribe("/chatter")
    exchange(link)
    one.node.create_publisher(STRING, "/chatter", 10).publish(text("bye"))
    one.node.destroy_node()
    exchange(link)
    test.work()
    assert test.heard == ["bye"]
    assert test.node.get_node_names() == ["test"]
    assert test.node.count_publishers("/chatter") == 0


def test_a_closed_link_takes_all_of_the_other_process_with_it(processes: list[Process]) -> None:
    test, one, two = processes
    ends = linked(test, one)
    links = ends, linked(test, two)
    one.subscribe("/chatter")
    exchange(*links)
    publisher = two.node.create_publisher(STRING, "/chatter", 10)
    assert publisher.get_subscription_count() == 1
    ends[0].close()
    exchange(links[1])
    assert publisher.get_subscription_count() == 0
    assert sorted(two.node.get_node_names()) == ["test", "two"]


def test_different_types_are_no_connection(processes: list[Process]) -> None:
    test, one, _ = processes
    link = linked(test, one)
    test.subscribe("/chatter")
    exchange(link)
    publisher = one.node.create_publisher(BOOL, "/chatter", 10)
    exchange(link)
    assert publisher.get_subscription_count() == 0
    assert test.node.count_publishers("/chatter") == 1


def test_nothing_is_sent_without_a_change(processes: list[Process]) -> None:
    test, one, _ = processes
    link = linked(test, one)
    exchange(link)
    assert not any(end.has_news for end in link)
    test.node.create_publisher(STRING, "/chatter", 10).publish(text("unread"))
    assert [kind for kind, *_ in link[0].take()] == ["end"]
    assert link[0].take() == []


@pytest.mark.parametrize(
    "change",
    [["jump"], ["message", 1], ["end", 1, 99, "publisher", "/a", "std_msgs/msg/Bool"], ["end", 1, 1, "planet"]],
)
def test_what_is_no_change_of_a_graph_is_an_error_that_shows_it(processes: list[Process], change: list[object]) -> None:
    link, _ = linked(processes[0], processes[1])
    with pytest.raises(ValueError, match=r"found the change \[.*\], expected one of a graph"):
        link.apply([change])
