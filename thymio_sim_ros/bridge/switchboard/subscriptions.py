"""Channels of the data source and the clients that subscribe to them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from thymio_sim_ros.bridge.protocol.constants import StatusLevel
from thymio_sim_ros.bridge.protocol.messages import Advertise, Channel, MessageData, Subscription
from thymio_sim_ros.bridge.switchboard.client_state import ClientState
from thymio_sim_ros.bridge.switchboard.events import ChannelSubscribed, ChannelUnsubscribed
from thymio_sim_ros.bridge.switchboard.outcome import Delivery, Outcome
from thymio_sim_ros.bridge.switchboard.retained_messages import RetainedMessages

__all__ = ["MAX_ENDED", "Routes", "Subscriptions"]

MAX_ENDED = 1000
"""Subscriptions of removed channels that are remembered for each client."""

Routes = tuple[tuple[int, int], ...]
"""Pairs of a client and the ID of its subscription."""


class Subscriptions:
    """Routes of channels to clients. Invariant: `routed` lists exactly the subscriptions in the clients' states."""

    def __init__(self, clients: Mapping[int, ClientState]) -> None:
        self.retained = RetainedMessages()
        self.routed: dict[int, Routes] = {}
        """Routes of all channels with subscribers; each change creates a new tuple. Read-only for others."""
        self._clients = clients
        self._channels: dict[int, Channel] = {}
        self._advertisement: Advertise | None = None
        """All channels for new clients, None after a change."""

    def routes(self, channel_id: int) -> Routes:
        """(client, subscription ID) of all subscriptions to a channel."""
        return self.routed.get(channel_id, ())

    @property
    def advertisement(self) -> Advertise:
        """All channels; the same object until they change, so that its encoding can be cached."""
        if self._advertisement is None:
            self._advertisement = Advertise(tuple(self._channels.values()))
        return self._advertisement

    def add_channels(self, channels: Iterable[Channel]) -> None:
        """Add channels, which clients can then subscribe to."""
        self._advertisement = None
        self._channels.update((channel.id, channel) for channel in channels)

    def remove_channels(self, channel_ids: Iterable[int]) -> None:
        """Remove channels with their subscriptions, without events. Unknown IDs are ignored."""
        self._advertisement = None
        for channel_id in channel_ids:
            self._channels.pop(channel_id, None)
            self.retained.drop(channel_id)
            for client, subscription_id in self.routed.pop(channel_id, ()):
                state = self._clients[client]
                del state.subscriptions[subscription_id]
                state.ended.pop(subscription_id, None)  # the order of the keys is their age
                state.ended[subscription_id] = None
                if len(state.ended) > MAX_ENDED:
                    del state.ended[next(iter(state.ended))]

    def subscribe(self, client: ClientState, subscriptions: Iterable[Subscription], outcome: Outcome) -> None:
        """Add subscriptions of a client and send it the retained messages; reject invalid ones one by one."""
        subscribed = set(client.subscriptions.values())
        for item in subscriptions:
            where = f"subscription {item.id}"
            if item.id in client.subscriptions:
                outcome.refuse(f"{where} exists already")
            elif item.channel_id not in self._channels:
                outcome.refuse(f"{where}: no channel {item.channel_id}", StatusLevel.WARNING)
            elif item.channel_id in subscribed:
                topic = self._channels[item.channel_id].topic
                outcome.refuse(f"{where}: already subscribed to {topic}", StatusLevel.WARNING)
            else:
                client.subscriptions[item.id] = item.channel_id
                subscribed.add(item.channel_id)
                self._set_routes(item.channel_id, (*self.routes(item.channel_id), (client.id, item.id)), outcome)
                for data in self.retained[item.channel_id]:
                    outcome.send(MessageData(item.id, data.time_ns, data.payload))

    def unsubscribe(self, client: ClientState, subscription_ids: Iterable[int], outcome: Outcome) -> None:
        """End subscriptions of a client. Those that ended with their channel are ignored: clients may not know yet."""
        for subscription_id in subscription_ids:
            channel_id = client.subscriptions.pop(subscription_id, None)
            if channel_id is not None:
                self._remove_route(client, channel_id, outcome)
            elif subscription_id not in client.ended:
                outcome.refuse(f"no subscription {subscription_id}", StatusLevel.WARNING)

    def remove_client(self, client: ClientState, outcome: Outcome) -> None:
        """End all subscriptions of a client that has disconnected."""
        for channel_id in client.subscriptions.values():
            self._remove_route(client, channel_id, outcome)

    def retain_last(self, channel_id: int, depth: int) -> None:
        """Retain the last `depth` messages of a channel from now on; 0 drops them, before they become outdated."""
        self.retained.set_depth(channel_id, depth)

    def resend_retained(self, time_ns: int) -> list[Delivery]:
        """Deliveries of all retained messages to all their subscribers, with a new time."""
        return [
            Delivery((client,), MessageData(subscription_id, time_ns, data.payload))
            for channel_id, retained in self.retained.by_channel.items()
            for client, subscription_id in self.routes(channel_id)
            for data in retained
        ]

    def _remove_route(self, client: ClientState, channel_id: int, outcome: Outcome) -> None:
        # A client subscribes to a channel at most once.
        routes = tuple(route for route in self.routes(channel_id) if route[0] != client.id)
        self._set_routes(channel_id, routes, outcome)

    def _set_routes(self, channel_id: int, routes: Routes, outcome: Outcome) -> None:
        """Set the routes of a channel; add an event for its first and its last subscriber."""
        was_subscribed = channel_id in self.routed
        if routes:
            self.routed[channel_id] = routes
            if not was_subscribed:
                outcome.events.append(ChannelSubscribed(channel_id))
        elif was_subscribed:
            del self.routed[channel_id]
            outcome.events.append(ChannelUnsubscribed(channel_id))
