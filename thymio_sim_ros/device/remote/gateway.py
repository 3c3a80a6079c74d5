"""A remote robot as a node for other clients: their messages go to the robot, and all that it sends goes to them.

The program that a client loads becomes the program of the robot, without the appended handlers: lights and sounds then
belong to that program.
"""

from __future__ import annotations

from aseba_vm import protocol
from aseba_vm.protocol import Message
from thymio_sim_ros.device.remote.remote_device import RemoteHost
from thymio_sim_ros.device.remote.session import Session

__all__ = ["Gateway"]

MAX_MESSAGES = 4096
"""Messages of the robot that wait for the owner; further ones are dropped."""
_CONTROLS = (protocol.SetBytecode, protocol.Reset, protocol.Run, protocol.Pause, protocol.Step, protocol.Stop)


class Gateway:
    """Passes messages between clients and the robot of a session. Invariant: messages are kept only for clients."""

    def __init__(self, session: Session, host: RemoteHost) -> None:
        self._session, self._host = session, host
        self._clients: set[int] = set()
        self._outbox: list[Message] = []
        self._words: list[int] = []
        """Bytecode that a client is writing."""

    def connect(self, client: int) -> None:
        """Add a client."""
        self._clients.add(client)

    def disconnect(self, client: int) -> None:
        """Remove a client; the program and its breakpoints stay."""
        self._clients.discard(client)
        if not self._clients:
            self._outbox.clear()

    def add(self, message: Message) -> None:
        """Keep a message of the robot for the clients, if there are any."""
        if self._clients and len(self._outbox) < MAX_MESSAGES:
            self._outbox.append(message)

    def pop_messages(self) -> list[Message]:
        """Return and clear the messages for all clients."""
        messages, self._outbox = self._outbox, []
        return messages

    def handle(self, client: int, message: Message) -> list[Message]:
        """Pass a message of a client to the robot; the replies are among `pop_messages`."""
        node = self._session.node
        if node is None or (isinstance(message, protocol.Command) and message.node != node.number):
            return []
        if isinstance(message, protocol.SetBytecode):
            end = message.start + len(message.words)
            if end > node.description.bytecode_size:
                return []
            self._words += [0] * (end - len(self._words))
            self._words[message.start : end] = message.words
        else:
            self.install_bytecode()
        if isinstance(message, _CONTROLS):
            self._host.device.run_control.release()
        self._session.client.send(message)
        self._host.device.on_run()
        return []

    def install_bytecode(self) -> None:
        """Note the bytecode that a client has written."""
        if self._words:
            words, self._words = self._words, []
            self._host.adopt(words)
