"""Options of a simulated Thymio, shared by the command line and ROS parameters."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

from thymio_sim_ros.device.event_queue import FIRMWARE, POLICIES
from thymio_sim_ros.device.layout import LAYOUTS, THYMIO
from thymio_sim_ros.errors import ThymioSimError

__all__ = ["DEFAULTS", "DeviceOptions", "OptionError"]


class OptionError(ThymioSimError, ValueError):
    """An unknown layout or policy; the text is one line."""


@dataclass(frozen=True, slots=True)
class DeviceOptions:
    """Names of layout and event policy; folders used as memory card and as flash memory, if any.

    Raises OptionError for an unknown name.
    """

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
        """File in which flashed settings are kept, or None."""
        return None if self.settings is None else self.settings / "settings.json"

    def for_robot(self, name: str, *, alone: bool) -> DeviceOptions:
        """Return the options of one robot: the same if it is alone, otherwise with the subfolders of its name."""
        if alone:
            return self
        return replace(
            self,
            card=None if self.card is None else self.card / name,
            settings=None if self.settings is None else self.settings / name,
        )


DEFAULTS = DeviceOptions()
"""Options of a new robot: layout and events of the firmware, no card."""
