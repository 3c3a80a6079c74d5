"""The switchboard under clients that come, go and subscribe at random: its routes are always the subscriptions."""

from __future__ import annotations

from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, invariant, rule

from tests.bridge.test_switchboard import channel
from thymio_sim_ros.bridge import Capability, ServerInfo
from thymio_sim_ros.bridge import events as ev
from thymio_sim_ros.bridge import messages as ms
from thymio_sim_ros.bridge.switchboard import Switchboard


class Storm(RuleBasedStateMachine):
    """Clients that come, go and subscribe at random; the owner keeps a list of what it was told."""

    def __init__(self) -> None:
        super().__init__()
        self.board = Switchboard(ServerInfo("storm", tuple(Capability), ("cdr",)))
        self.clients: set[int] = set()
        self.channels: set[int] = set()
        self.wanted: set[int] = set()
        self.subscriptions: set[tuple[int, int, int]] = set()

    @rule(client=st.integers(1, 4))
    def come_or_go(self, client: int) -> None:
        if client in self.clients:
            self.clients.remove(client)
            self.note(self.board.leave(client))
            self.subscriptions = {row for row in self.subscriptions if row[0] != client}
        else:
            self.clients.add(client)
            self.board.join(client)

    @rule(number=st.integers(1, 4))
    def offer_or_withdraw(self, number: int) -> None:
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
        self.note(self.board.receive(client, ms.Subscribe((ms.Subscription(subscription, number),))).events)
        mine = [row for row in self.subscriptions if row[0] == client]
        if number in self.channels and all(row[1] != subscription and row[2] != number for row in mine):
            self.subscriptions.add((client, subscription, number))

    @rule(client=st.integers(1, 4), subscription=st.integers(0, 3))
    def unsubscribe(self, client: int, subscription: int) -> None:
        if client in self.clients:
            self.note(self.board.receive(client, ms.Unsubscribe((subscription,))).events)
            self.subscriptions = {row for row in self.subscriptions if row[:2] != (client, subscription)}

    def note(self, events: list[ev.Event]) -> None:
        for event in events:
            if isinstance(event, ev.ChannelSubscribed):
                assert event.channel_id not in self.wanted
                self.wanted.add(event.channel_id)
            elif isinstance(event, ev.ChannelUnsubscribed):
                self.wanted.remove(event.channel_id)

    @invariant()
    def routes_are_the_subscriptions(self) -> None:
        routes = {(client, sub, number) for number in range(1, 5) for client, sub in self.board.routes(number)}
        assert routes == self.subscriptions

    @invariant()
    def the_owner_knows_what_is_wanted(self) -> None:
        assert self.wanted == {number for _, _, number in self.subscriptions}


TestStorm = Storm.TestCase
TestStorm.settings = settings(max_examples=50, stateful_step_count=40)
