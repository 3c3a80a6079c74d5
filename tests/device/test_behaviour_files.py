"""The built-in programs as files: formatted, without warnings, small enough for a robot."""

from __future__ import annotations

import pytest

from aseba_vm.cli.main import main
from thymio_sim_ros.device.behavior_host import ENTRIES, MENU, built_in
from thymio_sim_ros.files import resources

BEHAVIOURS = resources.behaviours()


def test_every_behaviour_of_the_menu_has_its_file():
    assert set(BEHAVIOURS) >= {MENU, *ENTRIES.values()}


@pytest.mark.parametrize("name", BEHAVIOURS)
def test_a_built_in_program_is_formatted(name: str):
    assert main(["fmt", "--check", str(BEHAVIOURS[name])]) == 0


@pytest.mark.parametrize("name", BEHAVIOURS)
def test_a_built_in_program_fits_a_robot_with_room_to_spare(name: str):
    program = built_in(name).program
    assert len(program.words) <= 1000


@pytest.mark.parametrize("name", BEHAVIOURS)
def test_a_built_in_program_begins_with_what_it_does(name: str):
    assert built_in(name).source.startswith("# ")
