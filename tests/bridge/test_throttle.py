"""Which clients of an event loop are paused, by a clock of the test."""

from __future__ import annotations

import asyncio

import pytest

from tests.patience import PATIENCE_S
from thymio_sim_ros.bridge import throttle
from thymio_sim_ros.bridge.throttle import ClientTime, Throttle

SLICE_S = 0.002


class Clock:
    """Processor time and wall time, both set by the test."""

    def __init__(self) -> None:
        self.spent_s = self.now_s = 0.0

    def thread_time(self) -> float:
        return self.spent_s

    def monotonic(self) -> float:
        return self.now_s


@pytest.fixture
def clock(monkeypatch: pytest.MonkeyPatch) -> Clock:
    """The clock of the module."""
    made = Clock()
    monkeypatch.setattr(throttle, "time", made)
    return made


async def is_paused(throttle: Throttle, client: ClientTime) -> bool:
    """Whether a client waits for its turn to pause."""
    async with throttle._turns.take(0.0):
        task = asyncio.create_task(client.pause_if_busy())
        await asyncio.sleep(0)
        task.cancel()
        return not task.done()


def spend(clock: Clock, *shares: tuple[ClientTime, float]) -> None:
    """A second passes, in which clients use shares of the processor time."""
    for client, share in shares:
        with client.measured():
            clock.spent_s += share
    clock.now_s += 1.0


def test_thirty_clients_that_occupy_the_loop_together_are_paused_and_one_beside_them_is_not(clock: Clock) -> None:
    """A request to another robot took half a second beside thirty clients, each of which used little of the time."""

    async def scenario() -> list[bool]:
        made = throttle.Throttle(SLICE_S)
        busy, other = [made.client() for _ in range(30)], made.client()
        spend(clock, (other, 0.004), *((client, 0.03) for client in busy))
        return [await is_paused(made, client) for client in (*busy, other)]

    assert asyncio.run(scenario()) == [True] * 30 + [False]


def test_clients_that_have_left_do_not_count(clock: Clock) -> None:
    async def scenario() -> bool:
        made = throttle.Throttle(SLICE_S)
        client = made.client()
        for _ in range(30):
            made.client()
        spend(clock, (client, 0.1))
        return await is_paused(made, client)

    assert not asyncio.run(scenario())


def test_of_the_busy_clients_the_one_with_the_least_share_comes_first(clock: Clock) -> None:
    async def scenario() -> list[str]:
        made = throttle.Throttle(SLICE_S)
        clients = {name: made.client() for name in ("much", "more", "less")}
        spend(clock, (clients["much"], 0.3), (clients["more"], 0.5), (clients["less"], 0.1))
        order: list[str] = []

        async def pause(name: str) -> None:
            await clients[name].pause_if_busy()
            order.append(name)

        async with made._turns.take(0.0):
            tasks = [asyncio.create_task(pause(name)) for name in clients]
            await asyncio.sleep(0)
        await asyncio.gather(*tasks)
        return order

    assert asyncio.run(scenario()) == ["less", "much", "more"]


def test_clients_that_are_disconnected_while_they_pause_or_wait_stop_no_other_one() -> None:
    async def scenario() -> None:
        made = throttle.Throttle(SLICE_S)
        pausing, waiting, other = (asyncio.create_task(made.pause(spent_s)) for spent_s in (3600.0, 3600.0, 0.0))
        await asyncio.sleep(0)
        waiting.cancel()
        pausing.cancel()
        await other

    asyncio.run(asyncio.wait_for(scenario(), PATIENCE_S))


def test_a_client_that_is_disconnected_as_its_turn_comes_stops_no_other_one() -> None:
    async def scenario() -> None:
        made = throttle.Throttle(SLICE_S)
        async with made._turns.take(0.0):
            pauses = [asyncio.create_task(made.pause(0.0)) for _ in range(2)]
            await asyncio.sleep(0)
        pauses[0].cancel()
        await pauses[1]

    asyncio.run(asyncio.wait_for(scenario(), PATIENCE_S))


def test_a_client_that_leaves_pauses_for_the_rest_of_its_time(clock: Clock) -> None:
    """A client that connects again after a few messages would otherwise never be paused."""

    async def scenario() -> bool:
        made = throttle.Throttle(SLICE_S)
        client = made.client()
        spend(clock, (client, 0.001))
        async with made._turns.take(0.0):
            task = asyncio.create_task(client.pause_at_end())
            await asyncio.sleep(0)
            task.cancel()
            return not task.done()

    assert asyncio.run(scenario())
