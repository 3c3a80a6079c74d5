"""Retained messages: the last messages of channels, which new subscribers receive first.

They correspond to the transient local durability of ROS topics.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable

from thymio_sim_ros.bridge.switchboard.events import Data

__all__ = ["RetainedMessages"]


class RetainedMessages:
    """The last messages of each retained channel, oldest first."""

    def __init__(self) -> None:
        self.by_channel: dict[int, deque[Data]] = {}
        """Messages by channel ID; a channel without an entry is not retained. Read-only for others."""

    def __getitem__(self, channel_id: int) -> Iterable[Data]:
        return self.by_channel.get(channel_id, ())

    def set_depth(self, channel_id: int, depth: int) -> None:
        """Retain the last `depth` messages of a channel from now on; 0 drops them and retains none."""
        if depth:
            self.by_channel[channel_id] = deque(self[channel_id], maxlen=depth)
        else:
            self.drop(channel_id)

    def drop(self, channel_id: int) -> None:
        """Drop the messages of a channel and retain none."""
        self.by_channel.pop(channel_id, None)

    def add(self, data: Data) -> None:
        """Retain a message if its channel is retained; a repeated payload is kept once, as the latest.

        A topic may have several publishers, each with its own last message. When the bridge subscribes again, with
        another QoS, each publisher sends it again; these repetitions must not displace those of other publishers.
        """
        retained = self.by_channel.get(data.channel_id)
        if retained is None:
            return
        repeated = next((old for old in retained if old.payload == data.payload), None)
        if repeated is not None:
            retained.remove(repeated)
        retained.append(data)
