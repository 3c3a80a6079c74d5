"""A client that sends rubbish harms nobody else."""

from __future__ import annotations

import random

from geometry_msgs.msg import Twist, Vector3
from rclpy.serialization import deserialize_message, serialize_message
from std_srvs.srv import SetBool

from tests.bridge.studio import Studio, set_and_answer
from thymio_sim_ros.bridge import messages as ms
from thymio_sim_ros.bridge.vocabulary import CDR, JSON


def flip(request, response):
    response.success = request.data
    response.message = "done"
    return response


def test_a_storm_of_changed_bytes_harms_nobody_else(ros, bridge, peer):
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
