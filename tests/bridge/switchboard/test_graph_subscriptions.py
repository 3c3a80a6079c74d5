"""Subscriptions to the connection graph."""

from __future__ import annotations

from tests.bridge.switchboard.boards import GRAPH, A, B, switchboard
from thymio_sim_ros.bridge.protocol import messages as ms
from thymio_sim_ros.bridge.protocol.connection_graph import ConnectionGraph
from thymio_sim_ros.bridge.switchboard import events as ev
from thymio_sim_ros.bridge.switchboard.outcome import Delivery


def test_only_the_first_and_the_last_graph_subscriber_cause_an_event() -> None:
    board = switchboard(A, B)
    assert board.receive(A, ms.SubscribeConnectionGraph()).events == [ev.GraphSubscriptionChanged(True)]
    assert board.receive(B, ms.SubscribeConnectionGraph()).events == []
    assert board.receive(A, ms.UnsubscribeConnectionGraph()).events == []
    assert board.leave(B) == [ev.GraphSubscriptionChanged(False)]


def test_each_subscriber_receives_the_whole_graph_and_then_differences() -> None:
    board = switchboard(A, B)
    board.receive(A, ms.SubscribeConnectionGraph())
    whole = ms.ConnectionGraphUpdate((ms.PublishedTopic("/t", ("/n",)),))
    assert board.apply(ev.SetGraph(GRAPH)) == [Delivery((A,), whole)]
    assert board.receive(B, ms.SubscribeConnectionGraph()).deliveries == [Delivery((B,), whole)]
    assert board.apply(ev.SetGraph(GRAPH)) == []
    gone = ms.ConnectionGraphUpdate(removed_topics=("/t",))
    assert board.apply(ev.SetGraph(ConnectionGraph())) == [Delivery((A,), gone), Delivery((B,), gone)]


def test_a_second_subscription_to_the_graph_has_no_effect() -> None:
    board = switchboard(A)
    board.receive(A, ms.SubscribeConnectionGraph())
    outcome = board.receive(A, ms.SubscribeConnectionGraph())
    assert (outcome.deliveries, outcome.events) == ([], [])
