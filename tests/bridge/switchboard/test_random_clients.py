"""Clients that connect, subscribe and disconnect at random: the routes always equal the subscriptions."""

from __future__ import annotations

from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, rule

from tests.bridge.switchboard.boards import channel
from thymio_sim_ros.bridge import Capability, ServerInfo
from thymio_sim_ros.bridge.protocol import messages as ms
from thymio_sim_ros.bridge.switchboard import events as ev
from thymio_sim_ros.bridge.switchboard.switchboard import Switchboard


class RandomClients(RuleBasedStateMachine):
    """A model of clients, channels and subscriptions beside the switchboard; `wanted` follows the events."""

    def __init__(self) -> None:
        super().__init__()
        self.board = Switchboard(ServerInfo("random", tuple(Capability), ("cdr",)))
        self.clients: set[int] = set()
        self.channels: set[int] = set()
        self.wanted: set[int] = set()
        self.subscriptions: set[tuple[int, int, int]] = set()

    @rule(client=st.integers(1, 4))
    def connect_or_disconnect(self, client: int) -> None:
        if client in self.clients:
            self.clients.remove(client)
            self.follow(self.board.leave(client))
            self.subscriptions = {row for row in self.subscriptions if row[0] != client}
        else:
            self.clients.add(client)
            self.board.join(client)

    @rule(number=st.integers(1, 4))
    def add_or_remove_channel(self, number: int) -> None:
        if number in self.channels:
            self.channels.remove(number)
            self.wanted.discard(number)
            self.board.apply(ev.RemoveChannels((number,)))
            self.subscriptions = {row for row in self.subscriptions if row[2] != number}
        else:
            self.channels.add(number)
            self.board.apply(ev.AddChannels((channel(number),)))

    @rule(client=st.integers(1, 4), subscription=st.integers(0, 3), number=st.integers(1, 4))
    def subscribe(self, client: int, subscription: int, number: int) -> None:
        if client not in self.clients:
            return
        self.follow(self.board.receive(client, ms.Subscribe((ms.Subscription(subscription, number),))).events)
        mine = [row for row in self.subscriptions if row[0] == client]
        if number in self.channels and all(row[1] != subscription and row[2] != number for row in mine):
            self.subscriptions.add((client, subscription, number))

    @rule(client=st.integers(1, 4), subscription=st.integers(0, 3))
    def unsubscribe(self, client: int, subscription: int) -> None:
        if client in self.clients:
            self.follow(self.board.receive(client, ms.Unsubscribe((subscription,))).events)
            self.subscriptions = {row for row in self.subscriptions if row[:2] != (client, subscription)}

    def follow(self, events: list[ev.Event]) -> None:
        for event in events:
            if isinstance(event, ev.ChannelSubscribed):
                assert event.channel_id not in self.wanted
                self.wanted.add(event.channel_id)
            elif isinstance(event, ev.ChannelUnsubscribed):
                self.wanted.remove(event.channel_id)

    @invariant()
    def routes_are_the_subscriptions(self) -> None:
        routes = self.board.subscriptions.routes
        found = {(client, subscription, number) for number in range(1, 5) for client, subscription in routes(number)}
        assert found == self.subscriptions

    @invariant()
    def events_report_the_channels_with_subscribers(self) -> None:
        assert self.wanted == {number for _, _, number in self.subscriptions}


TestRandomClients = RandomClients.TestCase
TestRandomClients.settings = settings(max_examples=50, stateful_step_count=40)
