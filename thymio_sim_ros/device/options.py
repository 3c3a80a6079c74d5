"""What a user may choose about a simulated Thymio, the same on the command line and in parameters."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

from thymio_sim_ros.device.event_queue import FIRMWARE, POLICIES
from thymio_sim_ros.device.layout import LAYOUTS, THYMIO
from thymio_sim_ros.errors import ThymioSimError

__all__ = ["DEFAULTS", "DeviceOptions", "OptionError"]


class OptionError(ThymioSimError, ValueError):
    """A choice that does not exist; the text is one line."""


@dataclass(frozen=True, slots=True)
class DeviceOptions:
    """Layout and event policy by name; folders that stand for the card and for the robot's flash memory, if any."""

    layout: str = THYMIO
    events: str = FIRMWARE
    card: Path | None = None
    settings: Path | None = None

    def __post_init__(self) -> None:
        for what, found, known in (("layout", self.layout, LAYOUTS), ("events", self.events, POLICIES)):
            if found not in known:
                raise OptionError(f"{what} '{found}' found, expected one of {', '.join(known)}")

    @property
    def settings_file(self) -> Path | None:
        """Where flashed settings are kept, if anywhere."""
        return None if self.settings is None else self.settings / "settings.json"

    def for_robot(self, name: str, *, alone: bool) -> DeviceOptions:
        """The options of one robot: alone it has the folders to itself, among others a folder of its name in each."""
        if alone:
            return self
        return replace(
            self,
            card=None if self.card is None else self.card / name,
            settings=None if self.settings is None else self.settings / name,
        )


DEFAULTS = DeviceOptions()
"""A robot as it is sold: its own layout and events, no card."""
