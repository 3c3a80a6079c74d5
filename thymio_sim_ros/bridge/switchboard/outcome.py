"""Results of a step of the switchboard: deliveries to clients and events for the data source."""

from __future__ import annotations

from dataclasses import dataclass, field

from thymio_sim_ros.bridge.protocol.constants import StatusLevel
from thymio_sim_ros.bridge.protocol.messages import ServerMessage, Status
from thymio_sim_ros.bridge.switchboard.events import Event

__all__ = ["MAX_REFUSALS", "Delivery", "Outcome"]

MAX_REFUSALS = 8
"""Rejections reported for one frame: a frame with many errors must not delay other clients."""


@dataclass(frozen=True, slots=True)
class Delivery:
    """A message and the clients that receive it."""

    clients: tuple[int, ...]
    message: ServerMessage


@dataclass(slots=True)
class Outcome:
    """The results of one message of a client, in order."""

    client: int
    deliveries: list[Delivery] = field(default_factory=list)
    events: list[Event] = field(default_factory=list)
    refusals: int = 0

    def send(self, message: ServerMessage) -> None:
        """Add a delivery to the client."""
        self.deliveries.append(Delivery((self.client,), message))

    def refuse(self, text: str, level: StatusLevel = StatusLevel.ERROR) -> None:
        """Add a status with the reason of a rejection; only the first `MAX_REFUSALS` are sent."""
        self.refusals += 1
        if self.refusals <= MAX_REFUSALS:
            self.send(Status(level, text))
