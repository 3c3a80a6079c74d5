"""What a user may choose about a robot."""

from __future__ import annotations

from pathlib import Path

import pytest

from thymio_sim_ros.device.options import DEFAULTS, DeviceOptions, OptionError


def test_a_robot_as_it_is_sold_has_its_own_layout_and_no_card() -> None:
    assert DeviceOptions("thymio", "firmware", None, None) == DEFAULTS
    assert DEFAULTS.settings_file is None


@pytest.mark.parametrize(
    ("chosen", "found"),
    [
        ({"layout": "aseba"}, "layout 'aseba' found, expected one of thymio, playground"),
        ({"events": "none"}, "events 'none' found, expected one of firmware, playground"),
    ],
)
def test_a_choice_that_does_not_exist_is_refused(chosen: dict[str, str], found: str) -> None:
    with pytest.raises(OptionError, match=found):
        DeviceOptions(**chosen)  # type: ignore[arg-type]  # only names are given


def test_a_robot_alone_has_the_folders_to_itself_and_others_share_them() -> None:
    options = DeviceOptions(card=Path("card"), settings=Path("flash"))
    assert options.for_robot("anna", alone=True) == options
    shared = options.for_robot("anna", alone=False)
    assert (shared.card, shared.settings_file) == (Path("card/anna"), Path("flash/anna/settings.json"))
    assert DEFAULTS.for_robot("anna", alone=False) == DEFAULTS
