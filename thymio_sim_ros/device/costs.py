"""Costs of native functions and events in instructions (`aseba_vm.machine.costs`).

The unit is an instruction of the interpreter, without translation: 0.25 µs of a core where this was measured. A budget
of 5000 instructions is then at most a few milliseconds of processor time, whatever the program calls. Functions that
read or write sounds are also charged for each byte.
"""

from __future__ import annotations

from aseba_vm.machine.costs import Cost, Costs
from aseba_vm.machine.natives import NATIVES

__all__ = ["BYTES_PER_INSTRUCTION", "COSTS", "PROGRAM_START"]

BYTES_PER_INSTRUCTION = 100
"""Bytes of a sound that can be read from the card, or written to it, in the time of one instruction."""

PROGRAM_START = 3000
"""Instructions in the time of which a robot starts again, also with another program of its menu."""

_CALL = Cost(16)
"""A call from the machine into Python."""
_VECTOR = Cost(12, 1)
"""A native function of the machine, which may process all words of its arguments."""
_COMMAND = Cost(30)
"""A command for an actuator."""

COSTS = Costs(
    natives={
        **dict.fromkeys(NATIVES, _VECTOR),
        **dict.fromkeys(("math.atan2", "math.sin", "math.cos"), Cost(12, 3)),
        **dict.fromkeys(("deque.size", "sd.seek", "_system.settings.read", "_rf.nodeid", "_rf.setup"), _CALL),
        **dict.fromkeys(("_system.reboot", "_poweroff"), Cost(PROGRAM_START)),
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
"""Cost by name. `others` is that of the functions declared by actuators, including plug-ins."""
