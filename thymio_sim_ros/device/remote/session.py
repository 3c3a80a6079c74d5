"""The connection of a remote device to one node: what is known of it, and what is sent to it."""

from __future__ import annotations

from collections.abc import Sequence

from aseba_vm.protocol import Command, NodeClient, RemoteNode, Run, UserMessage
from thymio_sim_ros.device.programs.program import load_program
from thymio_sim_ros.device.remote.ros_handlers import RemoteProgram

__all__ = ["COMPUTER", "Session"]

COMPUTER = 0
"""Number of this client on the network."""


class Session:
    """A client with the one node that it uses, and the program loaded there. Nothing is sent while there is no node."""

    def __init__(self, layout: str) -> None:
        self.client = NodeClient(source=COMPUTER)
        self.node: RemoteNode | None = None
        self.problem = "not connected yet"
        """Why there is no node, for the user."""
        own = load_program("", "none", layout)
        self.program = RemoteProgram(own, own.program)

    def load(self, program: RemoteProgram) -> None:
        """Load a program and start it."""
        self.program = program
        if self.node is not None:
            self.client.load(self.node.number, program.program)
            self.command(Run)

    def adopt(self, program: RemoteProgram) -> None:
        """Note the program that another client has loaded."""
        self.program = program
        if self.node is not None:
            self.node.set_program(program.program)

    def command(self, *kinds: type[Command]) -> None:
        """Send commands that have no content, such as `Run`."""
        if self.node is not None:
            self.client.send(*(kind(COMPUTER, self.node.number) for kind in kinds))

    def emit(self, number: int, words: Sequence[int], *, source: int = COMPUTER) -> None:
        """Send an event by its number in the list of the program."""
        if self.node is not None:
            self.client.send(UserMessage(source, number, tuple(words)))

    def value(self, name: str) -> tuple[int, ...] | None:
        """Words of a variable as last read or written; None if it is unknown."""
        if self.node is None or name not in self.node.addresses:
            return None
        return self.node.value(name)

    def write(self, name: str, words: Sequence[int]) -> None:
        """Write a variable if the node has it."""
        if self.node is not None and name in self.node.addresses:
            self.client.write(self.node.number, name, words)
