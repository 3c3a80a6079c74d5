"""Services that answer later."""

from __future__ import annotations

from std_srvs.srv import SetBool

from thymio_sim_ros.ros.rclpy_ext.deferred_service import create_deferred_service


def test_requests_are_answered_later_and_in_any_order(ros):
    waiting = []
    create_deferred_service(ros.node, SetBool, "/later", lambda request, respond: waiting.append((request, respond)))
    client = ros.node.create_client(SetBool, "/later")
    ros.until(client.service_is_ready)
    futures = [client.call_async(SetBool.Request(data=data)) for data in (True, False)]
    ros.until(lambda: len(waiting) == 2)
    assert not any(future.done() for future in futures)
    for request, respond in reversed(waiting):
        respond(SetBool.Response(success=request.data))
    ros.until(lambda: all(future.done() for future in futures))
    assert [future.result().success for future in futures] == [True, False]
