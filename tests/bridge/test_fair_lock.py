"""The fair lock with several threads."""

from __future__ import annotations

import threading

from tests.patience import PATIENCE_S, until
from thymio_sim_ros.bridge.fair_lock import FairLock


def test_one_thread_at_a_time_has_the_lock() -> None:
    lock = FairLock()
    count, rounds = 0, 2000

    def add() -> None:
        nonlocal count
        for number in range(rounds):
            if number % 2:
                with lock:
                    seen = count
                    count = seen + 1
            else:
                lock.acquire()
                seen = count
                count = seen + 1
                lock.release()

    threads = [threading.Thread(target=add) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(PATIENCE_S)
    assert count == len(threads) * rounds


def test_a_waiting_thread_gets_the_lock_before_the_thread_that_released_it() -> None:
    lock = FairLock()
    order: list[str] = []

    def wait_for_it() -> None:
        with lock:
            order.append("the one that waited")

    for _ in range(50):
        lock.acquire()
        waiting = threading.Thread(target=wait_for_it)
        waiting.start()
        until(lambda: lock._is_awaited, every_s=0.001)
        lock.release()
        with lock:
            order.append("the one that released it")
        waiting.join(PATIENCE_S)
    assert order == ["the one that waited", "the one that released it"] * 50


def test_an_error_releases_the_lock() -> None:
    lock = FairLock()
    try:
        with lock:
            raise ValueError
    except ValueError:
        lock.acquire()
