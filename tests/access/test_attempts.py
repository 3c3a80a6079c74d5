"""How often a wrong token may be tried."""

from __future__ import annotations

import pytest

from thymio_sim_ros.access.attempts import AttemptLimiter, TooManyAttemptsError


def test_wrong_tokens_may_be_tried_some_times_and_then_slowly() -> None:
    now_s = 0.0
    attempts = AttemptLimiter(lambda: now_s)
    assert [attempts.begin("10.0.0.1") for _ in range(30)] == [0.0] * 30
    assert [attempts.begin("10.0.0.1") for _ in range(5)] == [1.0, 2.0, 3.0, 4.0, 5.0]
    with pytest.raises(TooManyAttemptsError):
        attempts.begin("10.0.0.1")
    assert attempts.begin("10.0.0.2") == 0.0
    now_s = 6.0
    assert [attempts.begin("10.0.0.1") for _ in range(2)] == [0.0, 1.0]


def test_right_tokens_are_not_counted_and_their_address_gets_an_allowance_of_its_own() -> None:
    attempts = AttemptLimiter(lambda: 0.0)
    for _ in range(100):
        assert attempts.begin("fd00::1") == 0.0
        attempts.succeed("fd00::1")
    for _ in range(35):  # another computer of the same network
        attempts.begin("fd00::2")
    with pytest.raises(TooManyAttemptsError):
        attempts.begin("fd00::2")
    assert attempts.begin("fd00::1") == 0.0


def test_one_computer_does_not_get_more_attempts_by_several_ipv6_addresses() -> None:
    attempts = AttemptLimiter(lambda: 0.0)
    for number in range(30):
        attempts.begin(f"fd00::{number:x}")
    assert attempts.begin("fd00::ffff") == 1.0
    assert attempts.begin("fd01::1") == 0.0


def test_the_number_of_remembered_addresses_is_limited() -> None:
    attempts = AttemptLimiter(lambda: 0.0)
    for number in range(2000):
        address = f"10.0.{number // 250}.{number % 250}"
        attempts.begin(address)
        attempts.succeed(address)
    assert len(attempts._remaining_by_key) == len(attempts._known) == 1000
