"""A switchboard with channels, a service and clients, and short forms of what clients send."""

from __future__ import annotations

from collections.abc import Sequence

from thymio_sim_ros.bridge import Capability, ServerInfo
from thymio_sim_ros.bridge.protocol import messages as ms
from thymio_sim_ros.bridge.protocol.connection_graph import ConnectionGraph
from thymio_sim_ros.bridge.switchboard import events as ev
from thymio_sim_ros.bridge.switchboard.outcome import Delivery
from thymio_sim_ros.bridge.switchboard.switchboard import Switchboard

A, B = 1, 2
SIDE = ms.ServiceSide("cdr", "std_srvs/srv/Empty_Request", "ros2msg", "")
SERVICE = ms.Service(5, "/s", "std_srvs/srv/Empty", SIDE, SIDE)

GRAPH = ConnectionGraph({"/t": ("/n",)})


def channel(number: int, topic: str = "/t") -> ms.Channel:
    return ms.Channel(number, topic, "cdr", "std_msgs/msg/Bool", "bool data", "ros2msg")


def client_channel(number: int, topic: str = "/cmd_vel", encoding: str = "cdr") -> ms.ClientChannel:
    return ms.ClientChannel(number, topic, encoding, "geometry_msgs/Twist")


def switchboard(*clients: int, capabilities: Sequence[Capability] = tuple(Capability)) -> Switchboard:
    """A board with channels 10 and 11, one service, and the clients connected."""
    board = Switchboard(ServerInfo("test", tuple(capabilities), ("cdr", "json"), session_id="first"))
    board.apply(ev.AddChannels((channel(10), channel(11, "/u"))))
    board.apply(ev.AddServices((SERVICE,)))
    for client in clients:
        board.join(client)
    return board


def subscribe(board: Switchboard, client: int, subscription: int, channel_id: int) -> list[ev.Event]:
    outcome = board.receive(client, ms.Subscribe((ms.Subscription(subscription, channel_id),)))
    assert not [delivery for delivery in outcome.deliveries if isinstance(delivery.message, ms.Status)]
    return outcome.events


def refusals(deliveries: Sequence[Delivery]) -> list[tuple[int, str]]:
    """(client, text) of each status; every delivery must be one."""
    found = []
    for delivery in deliveries:
        assert isinstance(delivery.message, ms.Status)
        found.append((delivery.clients[0], delivery.message.message))
    return found


def call(number: int, payload: bytes = b"") -> ms.ServiceRequest:
    return ms.ServiceRequest(5, number, "cdr", payload)
