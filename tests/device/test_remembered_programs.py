"""A program that comes as bytecode has its text if that was given before."""

from __future__ import annotations

import pytest

from tests.device.remote.pair import Pair
from thymio_sim_ros.device.behavior_host import BehaviorHost
from thymio_sim_ros.device.device import AsebaDevice
from thymio_sim_ros.device.programs.program import load_program


def simulated_host():
    return BehaviorHost(AsebaDevice())


def remote_host():
    pair = Pair()
    pair.plug_in()
    return pair.robot.host


@pytest.mark.parametrize("host", [simulated_host, remote_host])
def test_a_program_that_is_remembered_is_recognized(host):
    host = host()
    known = load_program("var a = 5", "known", host.device.layout)
    other = load_program("var b = 6", "other", host.device.layout)
    host.remember(known)
    host.adopt(other.program.words)
    assert host.program.is_foreign
    host.adopt(known.program.words)
    assert host.program == known
