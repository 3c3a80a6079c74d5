"""The sending half of infrared communication, and what a program sees of it."""

from __future__ import annotations

import pytest

from thymio_sim_ros.sim.actuators.comm import ACTUATOR, CommState
from thymio_sim_ros.sim.commands import EnableComm, SetCommPayload

(ENABLE,) = ACTUATOR.aseba.natives


def test_switching_off_forgets_the_value() -> None:
    state = CommState()
    ACTUATOR.apply(state, EnableComm(True), 0)
    ACTUATOR.apply(state, SetCommPayload(5), 0)
    assert state.is_sending
    ACTUATOR.apply(state, EnableComm(False), 0)
    assert state == CommState()


def test_the_value_survives_switching_on() -> None:
    state = CommState()
    ACTUATOR.apply(state, SetCommPayload(5), 0)
    ACTUATOR.apply(state, EnableComm(True), 0)
    assert state == CommState(is_enabled=True, payload=5)


@pytest.mark.parametrize(("argument", "is_enabled"), [(1, True), (0, False), (-1, True)])
def test_the_native_switches(argument: int, is_enabled: bool) -> None:
    assert ENABLE.name == "prox.comm.enable"
    assert ENABLE.command([argument]) == EnableComm(is_enabled)


def test_the_native_zeroes_what_was_sent_and_received_when_it_switches_off() -> None:
    assert ENABLE.writes([1]) == {}
    assert ENABLE.writes([0]) == {"prox.comm.rx": (0,), "prox.comm.tx": (0,)}


def test_a_reset_switches_off() -> None:
    assert ACTUATOR.aseba.at_reset == (EnableComm(False),)
