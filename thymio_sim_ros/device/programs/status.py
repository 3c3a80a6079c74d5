"""Status of the machine of a device."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

RUNNING, PAUSED, STOPPED, FAULT, OFF = "running", "paused", "stopped", "fault", "off"

INIT = "init"
"""Name used as event for the initialization of the program."""


@dataclass(frozen=True, slots=True)
class DeviceStatus:
    """State (`running`, `paused`, `stopped`, `fault`, `off`), event being handled, source line from 1, address.

    Between events, `event` is empty, and `line` and `pc` are None. After a fault they are its position, and `fault` is
    the reason.
    """

    state: str
    event: str = ""
    line: int | None = None
    fault: str = ""
    pc: int | None = field(default=None, compare=False)  # two statuses with the same line are equal
    faults: Mapping[str, str] = field(default_factory=dict, compare=False)
    """Language → the sentence of `fault` in it (`aseba_vm.languages.LANGUAGES`)."""
