"""What natives and events cost a program, in instructions (`aseba_vm.machine.costs`).

The unit is an instruction on the interpreter, the slowest engine: 0.25 µs of a core where this was measured. A budget
of 5000 is then at most a few milliseconds of processor time, whatever a program does in it. `benchmarks/aseba_costs.py`
measures natives and prints them beside this table. Natives that read or write sounds are charged for their bytes
besides.
"""

from __future__ import annotations

from aseba_vm.machine.costs import Cost, Costs
from aseba_vm.machine.natives import NATIVES

__all__ = ["BYTES_PER_INSTRUCTION", "COSTS"]

BYTES_PER_INSTRUCTION = 100
"""Bytes of a sound that are read from the card and sent, or written to it, in the time of an instruction."""

_CALL = Cost(16)
"""A call from the machine into Python."""
_VECTOR = Cost(12, 1)
"""A native of the machine itself, which may use all words of its arguments."""
_COMMAND = Cost(30)
"""A command for an actuator."""

COSTS = Costs(
    natives={
        **dict.fromkeys(NATIVES, _VECTOR),
        **dict.fromkeys(("math.atan2", "math.sin", "math.cos"), Cost(12, 3)),
        **dict.fromkeys(("deque.size", "sd.seek", "_system.settings.read", "_rf.nodeid", "_rf.setup"), _CALL),
        **dict.fromkeys(("_system.reboot", "_poweroff"), _CALL),
        "_system.settings.write": Cost(60),
        "_system.settings.flash": Cost(3000),
        "sound.record": Cost(2000),
        "sound.play": Cost(350),
        "sound.replay": Cost(350),
        "sound.system": Cost(200),
        "sound.duration": Cost(150),
        "sound.wave": Cost(40),
        "sd.open": Cost(200),
        "sd.write": Cost(70, 1),
        "sd.read": Cost(50, 1),
    },
    others=_COMMAND,
    emit=Cost(150, 1),
)
"""The table. `others` are the natives of actuators, those of plug-ins among them."""
