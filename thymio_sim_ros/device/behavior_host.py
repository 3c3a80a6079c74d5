"""Selects the program of a robot: the menu, a behavior chosen in it, or a program loaded by a user.

The menu and the behaviors of the firmware (docs/spec/thymio-behaviors.md section 1) are programs of the folder
`firmware/behaviors`. They request another program by an event that neither other robots nor ROS receive:

- `menu.start [entry]`: run the program of this entry (`ENTRIES`; 0 is the program of the user),
- `menu.back`: open the menu at the entry that was running.

A program that declares `menu.open` is a menu. The arguments of that event are the entry to show, 1 if the user has a
program, and the number of ticks of 20 ms during which the center button is ignored.
"""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from pathlib import Path

from thymio_sim_ros.device.device import AsebaDevice
from thymio_sim_ros.device.layout import THYMIO
from thymio_sim_ros.device.network_events import EmittedEvent
from thymio_sim_ros.device.programs.foreign import foreign_program
from thymio_sim_ros.device.programs.program import ProgramError, ThymioProgram, load_program
from thymio_sim_ros.device.programs.status import OFF
from thymio_sim_ros.files import registry

__all__ = ["ENTRIES", "MENU", "BehaviorHost", "built_in", "is_internal"]

MENU = "menu"

PROGRAM_ENTRY = 0
"""The entry of the program that a user has loaded."""

ENTRIES = {
    1: "friendly",
    2: "explorer",
    3: "fearful",
    5: "attentive",
    6: "investigator",
    7: "obedient",
    9: "thesis_basic",
    10: "thesis_explorer",
    11: "thesis_track_follower",
}
"""Built-in program of each entry: the numbers of the firmware up to 8, then programs that the menu does not show."""

MAX_REMEMBERED = 4
"""Programs whose bytecode is recognized when a tool loads it again."""

POWER_ON_TICKS = 100
"""Ticks of 20 ms after switching on in which the center button is ignored."""

_PREFIX = "menu."
_START, _BACK, _OPEN = "menu.start", "menu.back", "menu.open"
_FOLDER = Path(__file__).parent / "firmware" / "behaviors"


def is_internal(event: str) -> bool:
    """Whether an event of this name stays inside the robot."""
    return event.startswith(_PREFIX)


@cache
def built_in(name: str, layout: str = THYMIO) -> ThymioProgram:
    """Load the built-in program of this name, or that of another package.

    Raises FileNotFoundError if there is none, ProgramError if it uses what a robot of this layout does not have.
    """
    paths = [folder / f"{name}.aesl" for folder in (_FOLDER, *registry.folders("behaviours"))]
    path = next((path for path in paths if path.is_file()), paths[0])
    return load_program(path.read_text(encoding="utf-8"), path.name, layout)


class BehaviorHost:
    """A device and the selection of its program. Invariant: the device runs `program`."""

    def __init__(self, device: AsebaDevice) -> None:
        self.device = device
        self.program = load_program("", "none", device.layout)
        self._user_program: ThymioProgram | None = None
        self._first: ThymioProgram | str = self.program
        self._entry = PROGRAM_ENTRY
        self._notices: list[str] = []
        self.breakpoints: tuple[int, ...] = ()
        """The lines at which the user asked that the user program pauses, from 1."""
        self.own_starts = 0
        """How often the robot has started a program by itself."""
        self._loaded: list[ThymioProgram] = []
        """The programs that were loaded with their text, the last one at the end."""

    @property
    def behaviour(self) -> str:
        """Name of the built-in program that `restart` starts; "" if it starts that of the user."""
        return self._first if isinstance(self._first, str) else ""

    @property
    def user_program(self) -> ThymioProgram | None:
        """The program of the user, which `restart` starts or which waits in the menu."""
        return self._user_program if isinstance(self._first, str) else self._first

    def load(self, program: ThymioProgram) -> None:
        """Load a user program: stop the current one and the wheels, and start it."""
        self._set_user_program(program)
        self._run(program, warm=False)

    def adopt(self, words: Sequence[int]) -> None:
        """Make the program whose bytecode a tool has written to the device the user program.

        It is one of the last programs that were loaded with their text if it has the same words.
        """
        found = (known for known in (self.program, *reversed(self._loaded)) if known.program.words == tuple(words))
        names = self._loaded[-1].events if self._loaded else ()
        program = next(found, None) or foreign_program(words, self.device.layout, names)
        self._set_user_program(program)
        self.program, self.breakpoints = program, ()
        self.device.adopt(program)

    def set_breakpoints(self, lines: Sequence[int]) -> None:
        """Replace the breakpoints at lines of the user program, also for its next starts."""
        self.breakpoints = tuple(lines)
        if self._is_user_program(self.program):
            self.device.run_control.set_breakpoints(lines)

    def remember(self, program: ThymioProgram | None) -> None:
        """Remember the text of a program, so that `adopt` recognizes its bytecode."""
        if program is not None and not program.is_foreign:
            self._loaded = [*(known for known in self._loaded if known != program), program][-MAX_REMEMBERED:]

    def start(self, name: str, user_program: ThymioProgram | None = None) -> None:
        """Switch the robot on with a built-in program, such as the menu, from which `user_program` can be started.

        Raises the exceptions of `built_in`; the previous program then continues.
        """
        program = built_in(name, self.device.layout)
        self._first, self._user_program = name, _unless_empty(user_program)
        self.remember(user_program)
        self._entry = next((entry for entry, known in ENTRIES.items() if known == name), PROGRAM_ENTRY)
        self._run(program, warm=False, wait=POWER_ON_TICKS)

    def restart(self) -> None:
        """Reset the device to a new robot and repeat the last `load` or `start`."""
        self.device.reinitialize()
        self._begin()

    def resume(self) -> None:
        """Continue execution; switch a robot that is off on, as the last `load` or `start` did."""
        if self.device.status.state != OFF or self.program is self._first:
            self.device.run_control.resume()
        else:
            self.device.services.settings.restart()
            self._begin()

    def pop_events(self) -> list[EmittedEvent]:
        """Return and clear the emitted events for other robots; execute requests to change the program."""
        events = self.device.pop_events()
        request = next((event for event in events if is_internal(event.name)), None)
        if request is None:
            return events
        self._handle_request(request)
        return [event for event in events if not is_internal(event.name)]

    def pop_notices(self) -> list[str]:
        """Return and clear the notices for the user, including those of the device."""
        notices, self._notices = self._notices, []
        return self.device.notices.pop() + notices

    def _handle_request(self, event: EmittedEvent) -> None:
        try:
            if event.name == _BACK:
                self._start_by_itself(built_in(MENU, self.device.layout), warm=True)
            elif event.name == _START and event.args:
                self._start_entry(event.args[0])
        except ProgramError as error:
            self._notices.append(f"{event.name}: {error}")

    def _start_entry(self, entry: int) -> None:
        if entry == PROGRAM_ENTRY and self._user_program is not None:
            program = self._user_program
        elif entry in ENTRIES:
            program = built_in(ENTRIES[entry], self.device.layout)
        else:
            self._notices.append(f"{_START} {entry}: the robot has no such program")
            return
        self._entry = entry
        self._start_by_itself(program, warm=entry != PROGRAM_ENTRY)

    def _start_by_itself(self, program: ThymioProgram, *, warm: bool) -> None:
        self.own_starts += 1
        self._run(program, warm=warm)

    def _begin(self) -> None:
        if isinstance(self._first, str):
            self.start(self._first, self._user_program)
        else:
            self.load(self._first)

    def _set_user_program(self, program: ThymioProgram) -> None:
        self._first = program
        self._user_program = _unless_empty(program)
        self._entry = PROGRAM_ENTRY
        self.remember(program)

    def _run(self, program: ThymioProgram, *, warm: bool, wait: int = 0) -> None:
        self.program = program
        initial_event = EmittedEvent(_OPEN, (self._entry, int(self._user_program is not None), wait))
        self.device.load(program, warm=warm, initial_event=initial_event)
        if self.breakpoints and self._is_user_program(program):
            self.device.run_control.set_breakpoints(self.breakpoints)

    def _is_user_program(self, program: ThymioProgram) -> bool:
        return program is self._first or program is self._user_program


def _unless_empty(program: ThymioProgram | None) -> ThymioProgram | None:
    return program if program is not None and program.source.strip() else None
