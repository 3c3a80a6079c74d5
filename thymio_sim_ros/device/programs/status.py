"""What a device tells about its machine."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

RUNNING, PAUSED, STOPPED, FAULT, OFF = "running", "paused", "stopped", "fault", "off"

INIT = "init"
"""In place of an event: the beginning of the program."""


@dataclass(frozen=True, slots=True)
class DeviceStatus:
    """State (`running`, `paused`, `stopped`, `fault`, `off`), the event being handled, its source line from 1, its pc.

    Between events, event is empty, line and pc None. After a fault they say where it happened, and `fault` why.
    """

    state: str
    event: str = ""
    line: int | None = None
    fault: str = ""
    pc: int | None = field(default=None, compare=False)  # the place is the line
    faults: Mapping[str, str] = field(default_factory=dict, compare=False)
    """Language → the sentence of `fault` in it (`aseba_vm.languages.LANGUAGES`)."""
