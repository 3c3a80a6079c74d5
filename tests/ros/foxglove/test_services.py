"""Services of ROS, called by a real client."""

from __future__ import annotations

import functools

import pytest
from rclpy.serialization import deserialize_message, serialize_message
from std_srvs.srv import SetBool, Trigger

from tests.bridge.studio import Studio
from thymio_sim_ros.bridge.protocol import messages as ms
from thymio_sim_ros.bridge.protocol.constants import CDR, JSON
from thymio_sim_ros.ros.foxglove import node
from thymio_sim_ros.ros.foxglove.service_calls import ServiceCalls


def flip(request, response):
    response.success = request.data
    response.message = "done"
    return response


@pytest.mark.parametrize(
    ("encoding", "request_bytes"),
    [(CDR, serialize_message(SetBool.Request(data=True))), (JSON, b'{"data": true}')],
    ids=["cdr", "json"],  # the padding of serialized bytes differs from run to run
)
def test_a_service_answers(ros, studio, encoding, request_bytes):
    ros.node.create_service(SetBool, "/flip", flip)
    service = studio.service("/flip")
    studio.send(ms.ServiceRequest(service.id, 42, encoding, request_bytes))
    answer = studio.next(ms.ServiceResponse)
    assert (answer.service_id, answer.call_id, answer.encoding) == (service.id, 42, encoding)
    if encoding == CDR:
        assert deserialize_message(answer.payload, SetBool.Response) == SetBool.Response(success=True, message="done")
    else:
        assert answer.payload == b'{"success":true,"message":"done"}'


def test_a_service_carries_the_definitions_of_both_sides(ros, studio):
    ros.node.create_service(SetBool, "/flip", flip)
    service = studio.service("/flip")
    assert (service.type, service.request.schema_name) == ("std_srvs/srv/SetBool", "std_srvs/srv/SetBool_Request")
    assert "bool data" in service.request.schema
    assert "string message" in service.response.schema


@pytest.mark.parametrize(
    ("encoding", "payload", "text"),
    [
        (CDR, b"", "/flip: cannot decode the request"),
        (JSON, b'{"no": 1}', "/flip: cannot decode the request: message: no field no"),
        ("protobuf", b"", "/flip: cannot decode the request: expected encoding cdr or json, found protobuf"),
    ],
)
def test_a_request_that_cannot_be_decoded_fails_with_a_status(ros, studio, encoding, payload, text):
    ros.node.create_service(SetBool, "/flip", flip)
    studio.send(ms.ServiceRequest(studio.service("/flip").id, 1, encoding, payload))
    failure = studio.next(ms.ServiceCallFailure)
    assert failure.call_id == 1
    assert failure.message.startswith(text)
    assert studio.next(ms.Status).message == failure.message


def test_a_service_that_does_not_answer_fails_in_the_end(ros, bridge, monkeypatch):
    monkeypatch.setattr(node, "ServiceCalls", functools.partial(ServiceCalls, timeout_s=0.1))
    ros.node.create_service(Trigger, "/mute", lambda request, response: pytest.fail("not to be called"))
    with Studio(bridge().port, ros.until) as studio:
        service = studio.service("/mute")
        ros.node.destroy_service(next(item for item in ros.node.services if item.srv_name == "/mute"))
        studio.send(ms.ServiceRequest(service.id, 1, CDR, serialize_message(Trigger.Request())))
        failure = studio.next(ms.ServiceCallFailure)
    assert failure.call_id == 1


def test_a_service_is_withdrawn_when_its_server_ends_even_if_clients_remain(ros, studio):
    """The middleware's list of services includes those that only have clients, such as the bridge's own."""
    server = ros.node.create_service(SetBool, "/flip", flip)
    service = studio.service("/flip")
    studio.send(ms.ServiceRequest(service.id, 1, JSON, b'{"data": true}'))
    studio.next(ms.ServiceResponse)
    ros.node.destroy_service(server)
    ros.until(lambda: "/flip" not in studio.read().services, what="the bridge withdraws the service")
    ros.until(lambda: not ros.node.count_clients("/flip"), what="the bridge destroys its client")


def test_unlisted_and_hidden_services_are_not_offered(ros, bridge):
    for name in ("/arm/flip", "/arm/_hidden", "/leg/flip"):
        ros.node.create_service(SetBool, name, flip)
    with Studio(bridge(service_whitelist=("/arm/.*",)).port, ros.until) as studio:
        studio.service("/arm/flip")
        assert set(studio.services) == {"/arm/flip"}


def test_hidden_and_parameter_services_are_offered_on_demand(ros, bridge, peer):
    ros.node.create_service(SetBool, "/arm/_hidden", flip)
    with Studio(bridge(include_hidden=True).port, ros.until) as studio:
        for name in ("/arm/_hidden", "/peer/get_parameters"):
            assert studio.service(name).name == name


def test_parameter_services_are_not_offered(ros, studio, peer):
    ros.node.create_service(SetBool, "/flip", flip)
    studio.service("/flip")
    assert not [name for name in studio.services if name.startswith("/peer/")]
