"""The fair lock with several threads."""

from __future__ import annotations

import threading

from tests.patience import PATIENCE_S
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
    has_had_it, is_enough = threading.Event(), threading.Event()

    def take_it_again_and_again() -> None:
        while not is_enough.is_set():
            with lock:
                pass

    restless = threading.Thread(target=take_it_again_and_again)
    restless.start()

    def take_it_once() -> None:
        for _ in range(50):
            with lock:
                pass
        has_had_it.set()

    patient = threading.Thread(target=take_it_once)
    patient.start()
    came = has_had_it.wait(PATIENCE_S)
    is_enough.set()
    patient.join()
    restless.join()
    assert came


def test_an_error_releases_the_lock() -> None:
    lock = FairLock()
    try:
        with lock:
            raise ValueError
    except ValueError:
        lock.acquire()
