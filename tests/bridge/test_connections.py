"""Slots of connections: time limits and eviction."""

from __future__ import annotations

import pytest

from thymio_sim_ros.bridge.connections import MIN_WAIT_S, TIME_LIMIT_S, Connections, ConnectionSlot, Phase


class Clock:
    def __init__(self) -> None:
        self.now_s = 0.0

    def __call__(self) -> float:
        return self.now_s


@pytest.fixture
def clock() -> Clock:
    return Clock()


@pytest.fixture
def connections(clock: Clock) -> Connections:
    return Connections(4, clock)


def admitted(connections: Connections, address: str, ended: list[ConnectionSlot] | None = None) -> ConnectionSlot:
    place = connections.add(address)
    if ended is not None:
        place.close = lambda: ended.append(place)
    return place


def test_a_stream_has_no_time_limit_and_is_not_evicted(connections, clock):
    streams = [admitted(connections, "a") for _ in range(4)]
    for one in streams:
        connections.set_phase(one, Phase.STREAMING)
    clock.now_s = 1e6
    assert connections.close_overdue() == 0
    assert connections.eviction_candidate() is None


@pytest.mark.parametrize("phase", TIME_LIMIT_S)
def test_a_connection_is_closed_after_the_time_of_its_phase(connections, clock, phase):
    ended: list[ConnectionSlot] = []
    place = admitted(connections, "a", ended)
    connections.set_phase(place, phase)
    clock.now_s = TIME_LIMIT_S[phase]
    assert connections.close_overdue() == 0
    clock.now_s += 0.01
    assert connections.close_overdue() == 1
    assert ended == [place]
    assert len(connections) == 0


def test_setting_the_same_phase_again_does_not_restart_its_time(connections, clock):
    place = admitted(connections, "a")
    connections.set_phase(place, Phase.READING)
    clock.now_s = 6.0
    connections.set_phase(place, Phase.READING)
    clock.now_s = 10.1
    assert connections.close_overdue() == 1


def test_the_oldest_silent_connection_of_the_address_with_the_most_is_evicted(connections, clock):
    visitor = admitted(connections, "visitor")
    clock.now_s = 1.0
    first = admitted(connections, "attacker")
    clock.now_s = 2.0
    for _ in range(2):
        admitted(connections, "attacker")
    clock.now_s = 20.0
    assert connections.is_full
    assert connections.eviction_candidate() is first
    connections.remove(first)
    connections.remove(visitor)
    assert not connections.is_full


def test_silent_connections_are_evicted_before_those_with_partial_requests(connections, clock):
    asking = admitted(connections, "a")
    connections.set_phase(asking, Phase.READING)
    clock.now_s = 1.0
    silent = admitted(connections, "a")
    clock.now_s = 10.0
    assert connections.eviction_candidate() is silent


@pytest.mark.parametrize("phase", MIN_WAIT_S)
def test_a_connection_that_has_waited_only_briefly_is_kept(connections, clock, phase):
    place = admitted(connections, "a")
    connections.set_phase(place, phase)
    clock.now_s = MIN_WAIT_S[phase] - 0.01
    assert connections.eviction_candidate() is None
    clock.now_s = MIN_WAIT_S[phase]
    assert connections.eviction_candidate() is place


def test_a_connection_that_is_answered_is_never_evicted(connections, clock):
    connections.set_phase(admitted(connections, "a"), Phase.ANSWERING)
    clock.now_s = 60.0
    assert connections.eviction_candidate() is None


def test_a_connection_with_pending_input_is_kept(connections, clock):
    ended: list[ConnectionSlot] = []
    place = admitted(connections, "a", ended)
    clock.now_s = 4.0
    since_s = place.since_s
    assert connections.eviction_candidate() is place
    connections.set_phase(place, Phase.READING)  # while the event loop had its turns
    connections.evict(place, since_s)
    assert ended == []
    place.has_pending_io = lambda: True
    clock.now_s = 9.0
    assert connections.eviction_candidate() is None
    place.has_pending_io = lambda: False
    connections.evict(place, place.since_s)
    assert ended == [place]


def test_removing_a_connection_twice_frees_one_slot(connections):
    places = [admitted(connections, "a") for _ in range(4)]
    connections.remove(places[0])
    connections.remove(places[0])
    assert len(connections) == 3
