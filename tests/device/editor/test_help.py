"""The help of names."""

from __future__ import annotations

import pytest

from aseba_vm.languages import LANGUAGES, texts
from thymio_sim_ros.device.layout import target

KINDS = {"variables": target().variables, "events": target().local_events, "natives": target().natives}


def test_there_is_help_for_every_name_of_the_robot_and_no_other():
    names = {f"{kind}.{entry.name}" for kind, entries in KINDS.items() for entry in entries}
    assert texts("help").keys() == names


@pytest.mark.parametrize("language", LANGUAGES)
def test_help_is_one_line_without_a_full_stop(language):
    assert [text for text in texts("help", language).values() if "\n" in text or text.endswith(".")] == []
