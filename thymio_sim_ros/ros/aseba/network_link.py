"""Connects the robots of a runtime to the network servers: messages of clients in, messages of the nodes out.

The servers run in the event loop of a thread (`thymio_sim_ros/network/servers.py`); robots belong to the thread of the
executor. A mailbox takes the messages of clients; answers of nodes are passed by calls in the thread of the servers.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial

from rclpy.node import Node

from aseba_vm.protocol import Message
from thymio_sim_ros.access.tokens import Tokens
from thymio_sim_ros.device.programs.program import ThymioProgram
from thymio_sim_ros.engine.devices import SentMessages
from thymio_sim_ros.engine.inputs import (
    ClientConnected,
    ClientDisconnected,
    MessagesReceived,
    ProgramInput,
    Remembered,
)
from thymio_sim_ros.network.hub import Network
from thymio_sim_ros.network.servers import NetworkServers
from thymio_sim_ros.network.settings import NetworkSettings
from thymio_sim_ros.ros.aseba.device_endpoints import DeviceEndpoints
from thymio_sim_ros.ros.aseba.robot_set import RobotSet
from thymio_sim_ros.ros.rclpy_ext.mailbox import Mailbox
from thymio_sim_ros.web.thread import ServerThread

__all__ = ["NetworkLink"]

CONNECT, DISCONNECT = "connect", "disconnect"

GROUP = 4
"""Messages that are executed without a break; after it other clients and the node's own work have their turn."""
CAPACITY = 32
"""Messages of one client that may wait before it is asked to pause."""


@dataclass(frozen=True, slots=True)
class _Post:
    """Something from a client of one robot: messages, that it has come or gone, or the text of a program."""

    robot: DeviceEndpoints
    client: int
    messages: Sequence[Message] = ()
    event: str = ""
    program: ThymioProgram | None = None


class NetworkLink:
    """The networks of all robots of a runtime, one for each robot."""

    def __init__(
        self,
        node: Node,
        robots: RobotSet,
        settings: NetworkSettings,
        *,
        first_id: int,
        tokens: Tokens,
        thread: ServerThread | None,
    ) -> None:
        """Start the servers. `first_id`: number of the robot at the first port; `tokens`: those that clients need.

        `thread`: that of a page in the same process, which serves them, too.
        """
        log = node.get_logger()
        self._robots, self._first_id = robots, first_id
        self._networks: dict[DeviceEndpoints, Network] = {}
        self._mailbox: Mailbox[_Post] = Mailbox(
            node,
            self._handle,
            sender=lambda post: post.client,
            weight=lambda post: len(post.messages),
            capacity=CAPACITY,
        )
        self.servers = NetworkServers(settings, tokens=tokens, warn=log.warning, info=log.info, thread=thread)
        robots.on_change = self.update
        robots.on_sent = self._deliver
        self.update()

    def update(self) -> None:
        """Add networks of new robots, and remove those of robots that are gone."""
        for robot in [robot for robot in self._networks if robot not in list(self._robots)]:
            robot.on_program = lambda program: None
            self.servers.call(self.servers.hub.remove, self._networks.pop(robot))
        for robot in self._robots:
            if robot not in self._networks:
                nodes = _Robot(robot, self._mailbox)
                network = Network(
                    robot.names.name,
                    nodes,
                    place=robot.number - self._first_id,
                    node_ids=(robot.number,) if robot.is_simulated else (),
                    is_simulated=robot.is_simulated,
                )
                network.remember = nodes.remember
                self._networks[robot] = network
                self.servers.call(network.set_program, robot.program)
                self.servers.call(self.servers.hub.add, network)
                robot.on_program = partial(self.servers.call, network.set_program)

    def drain(self) -> None:
        """Handle messages that clients sent before the node had an executor; nothing else handles them."""
        self._mailbox.drain()

    def close(self) -> None:
        """Stop the servers; a second call has no effect."""
        self._mailbox.close()
        self.servers.close()

    def _handle(self, post: _Post) -> None:
        """Execute the messages of a client. Replies stay in order with the messages that the node sends by itself."""
        robot = post.robot
        if robot not in self._networks:  # it is gone
            return
        if post.event == CONNECT:
            happened: ProgramInput = ClientConnected(robot.robot, post.client)
        elif post.event == DISCONNECT:
            happened = ClientDisconnected(robot.robot, post.client)
        elif post.program is not None:
            happened = Remembered(robot.robot, replace(post.program, layout=robot.device.layout))
        else:
            happened = MessagesReceived(robot.robot, post.client, tuple(post.messages))
        self._robots.owner.apply(happened)
        self._deliver(self._robots.owner.pop_sent())
        robot.publish()

    def _deliver(self, sent: Sequence[SentMessages]) -> None:
        """Send messages of the robots to the clients of their networks, in order."""
        networks = {robot.robot: network for robot, network in self._networks.items()}
        for messages in sent:
            if messages.robot in networks:
                self.servers.call(networks[messages.robot].deliver, messages.messages, messages.client)


class _Robot:
    """The nodes of a network whose node is a robot of this process. Only for the thread of the servers."""

    def __init__(self, robot: DeviceEndpoints, mailbox: Mailbox[_Post]) -> None:
        self._robot, self._mailbox = robot, mailbox

    def connect(self, client: int) -> None:
        self._mailbox.post(_Post(self._robot, client, event=CONNECT))

    def disconnect(self, client: int) -> None:
        self._mailbox.post(_Post(self._robot, client, event=DISCONNECT))

    def send(self, client: int, messages: Sequence[Message]) -> None:
        for start in range(0, len(messages), GROUP):
            self._mailbox.post(_Post(self._robot, client, messages[start : start + GROUP]))

    def remember(self, client: int, program: ThymioProgram) -> None:
        self._mailbox.post(_Post(self._robot, client, program=program))

    def is_full(self, client: int) -> bool:
        return self._mailbox.is_full(client)
