"""Clients that send damaged frames, connect and disconnect: others are not affected, and nothing is left behind."""

from __future__ import annotations

import gc
import random
from collections import Counter

import pytest
from geometry_msgs.msg import Twist, Vector3
from rclpy.node import Node
from rclpy.publisher import Publisher
from rclpy.serialization import deserialize_message, serialize_message
from rclpy.subscription import Subscription
from std_msgs.msg import String
from std_srvs.srv import SetBool

from tests.bridge.studio import Studio, set_and_answer
from thymio_sim_ros.bridge.protocol import messages as ms
from thymio_sim_ros.bridge.protocol.constants import CDR, JSON


def flip(request, response):
    response.success = request.data
    response.message = "done"
    return response


def test_many_damaged_frames_do_not_affect_other_clients(ros, bridge, peer):
    rng = random.Random(7)
    ros.node.create_subscription(Twist, "/cmd_vel", lambda _: None, 10)
    ros.node.create_service(SetBool, "/flip", flip)
    port = bridge().port
    with Studio(port, ros.until) as fuzzer, Studio(port, ros.until) as other:
        fuzzer.advertise(1, "/cmd_vel", "geometry_msgs/Twist")
        fuzzer.advertise(2, "/cmd_vel", "geometry_msgs/Twist", JSON)
        service = fuzzer.service("/flip").id
        fuzzer.parameter("/peer.speed")

        def changed(data):
            at = rng.randrange(len(data))
            return data[:at] + rng.randbytes(rng.randrange(3)) + data[at + 1 :]

        for _ in range(60):
            fuzzer.send(
                ms.ClientMessageData(1, changed(serialize_message(Twist()))),
                ms.ClientMessageData(2, changed(b'{"linear": {"x": 1.0}, "angular": {"z": [1]}}')),
                ms.ServiceRequest(service, 1, CDR, changed(serialize_message(SetBool.Request()))),
                ms.ServiceRequest(service, 2, JSON, changed(b'{"data": true}')),
                ms.SetParameters((ms.Parameter("/peer.speed", rng.choice([1, "x", 2.5, (1, 2), None, True, 2**80])),)),
            )
            ros.spin()
        assert set_and_answer(other, ms.Parameter("/peer.count", 5))[-1].parameters == (ms.Parameter("/peer.count", 5),)
        other.subscribe(1, "/cmd_vel")
        other.advertise(1, "/cmd_vel", "geometry_msgs/Twist")
        other.send(ms.ClientMessageData(1, serialize_message(Twist(linear=Vector3(x=0.25)))))
        other.next(ms.MessageData, lambda data: deserialize_message(data.payload, Twist).linear.x == 0.25)


@pytest.mark.slow
def test_500_clients_that_come_and_go_leave_nothing_of_ros_behind(ros, bridge):
    publisher = ros.node.create_publisher(String, "/chat", 10)
    port = bridge().port

    def visit(number):
        with Studio(port, ros.until) as studio:
            studio.subscribe(number, "/chat")
            studio.advertise(number, "/back", "std_msgs/msg/String")
            if number % 50 == 0:
                ros.until(lambda: publisher.get_subscription_count() and ros.node.count_publishers("/back"))

    def settle():
        ros.until(lambda: publisher.get_subscription_count() == 0 and ros.node.count_publishers("/back") == 0)
        gc.collect()
        return Counter(type(thing) for thing in gc.get_objects() if type(thing) in (Publisher, Subscription))

    visit(0)
    before = settle()
    for number in range(500):
        visit(number)
    assert settle() == before


def test_nodes_that_come_and_go_while_clients_do_are_followed(ros, bridge):
    port = bridge().port
    with Studio(port, ros.until) as watcher:
        watcher.send(ms.SubscribeConnectionGraph())
        for number in range(10):
            node = Node(f"guest_{number}", context=ros.context, enable_rosout=False)
            node.create_publisher(String, f"/guest_{number}", 10)
            node.create_service(SetBool, f"/flip_{number}", flip)
            with Studio(port, ros.until) as visitor:
                visitor.subscribe(1, f"/guest_{number}")
                visitor.service(f"/flip_{number}")
                node.destroy_node()
        ros.until(lambda: not [topic for topic in watcher.read().channels if topic.startswith("/guest_")])
        ros.until(lambda: not [name for name in watcher.read().services if name.startswith("/flip_")])
        graph = [update for update in watcher.received if isinstance(update, ms.ConnectionGraphUpdate)]
        assert {name for update in graph for name in update.removed_topics} <= {f"/guest_{n}" for n in range(10)}
        assert not [status for status in watcher.received if isinstance(status, ms.Status)]


def test_a_client_that_disconnects_during_its_call_does_not_affect_others(ros, bridge):
    calls = []

    def slow(request, response):
        calls.append(request)
        return flip(request, response)

    ros.node.create_service(SetBool, "/flip", slow)
    port = bridge().port
    with Studio(port, ros.until) as other:
        with Studio(port, ros.until) as leaving:
            leaving.send(ms.ServiceRequest(leaving.service("/flip").id, 1, JSON, b'{"data": true}'))
        ros.until(lambda: calls)
        other.send(ms.ServiceRequest(other.service("/flip").id, 2, JSON, b'{"data": false}'))
        assert other.next(ms.ServiceResponse).call_id == 2
