"""Channels on which clients publish."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from thymio_sim_ros.bridge.protocol.constants import StatusLevel
from thymio_sim_ros.bridge.protocol.messages import ClientChannel
from thymio_sim_ros.bridge.switchboard.client_state import ClientState
from thymio_sim_ros.bridge.switchboard.events import ClientChannelClosed, ClientChannelOpened, ClientMessageReceived
from thymio_sim_ros.bridge.switchboard.outcome import Outcome

__all__ = ["MAX_ALL_CLIENT_CHANNELS", "MAX_CLIENT_CHANNELS", "ClientChannels"]

MAX_CLIENT_CHANNELS = 256
"""Channels that one client may open: each may need a publisher."""

MAX_ALL_CLIENT_CHANNELS = 512
"""Channels that all clients together may open."""


class ClientChannels:
    """Opens, closes and counts the channels of all clients."""

    def __init__(self, encodings: Sequence[str]) -> None:
        """`encodings` are those in which clients may publish."""
        self._encodings = encodings
        self._count = 0

    def open(self, client: ClientState, channels: Iterable[ClientChannel], outcome: Outcome) -> None:
        """Open channels; reject those with a used ID, with an unknown encoding, or above the limits."""
        for channel in channels:
            refusal = self._refusal(client, channel)
            if refusal is None:
                client.channels[channel.id] = channel
                self._count += 1
                outcome.events.append(ClientChannelOpened(client.id, channel))
            else:
                outcome.refuse(f"channel {channel.id} for {channel.topic}: {refusal}")

    def close(self, client: ClientState, channel_ids: Iterable[int], outcome: Outcome) -> None:
        """Close channels of a client."""
        for channel_id in channel_ids:
            if client.channels.pop(channel_id, None) is None:
                outcome.refuse(f"no client channel {channel_id}", StatusLevel.WARNING)
            else:
                self._count -= 1
                outcome.events.append(ClientChannelClosed(client.id, channel_id))

    def receive(self, client: ClientState, channel_id: int, payload: bytes, outcome: Outcome) -> None:
        """Pass on a message that a client publishes on one of its channels."""
        if channel_id in client.channels:
            outcome.events.append(ClientMessageReceived(client.id, channel_id, payload))
        else:
            outcome.refuse(f"message on client channel {channel_id}, which is not advertised")

    def remove_client(self, client: ClientState, outcome: Outcome) -> None:
        """Close all channels of a client that has disconnected."""
        self.close(client, tuple(client.channels), outcome)

    def _refusal(self, client: ClientState, channel: ClientChannel) -> str | None:
        if channel.id in client.channels:
            return f"the ID is in use for {client.channels[channel.id].topic}"
        if channel.encoding not in self._encodings:
            return f"expected encoding {' or '.join(self._encodings)}, found {channel.encoding}"
        if len(client.channels) >= MAX_CLIENT_CHANNELS:
            return f"more than {MAX_CLIENT_CHANNELS} channels"
        if self._count >= MAX_ALL_CLIENT_CHANNELS:
            return f"more than {MAX_ALL_CLIENT_CHANNELS} channels of all clients"
        return None
