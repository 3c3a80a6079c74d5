"""The barrier between the processes of a test: what it says when marks do not arrive."""

from __future__ import annotations

import re

import pytest

from thymio_sim_ros.lockstep import real_time
from thymio_sim_ros.lockstep.installed_ros.barrier import Barrier
from thymio_sim_ros.testing.ros import Ros


def test_marks_that_do_not_arrive_are_named_with_the_state_of_discovery(
    ros: Ros, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(real_time, "LAST_RESORT_S", 0.1)
    barrier = Barrier(ros.context, "test")
    try:
        with pytest.raises(real_time.NotAnsweredError) as found:
            barrier.wait({"test": 1, "program_1_0": 3})
    finally:
        barrier.node.destroy_node()
    text = str(found.value)
    assert "0.1 s of real time for the messages of program_1_0; test has received marks 0 of 3 from program_1_0" in text
    assert re.search(r"matched with \d of \d publishers$", text)
