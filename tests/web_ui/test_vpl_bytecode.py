"""Programs of VPL compile, and to the words of the original (`programs.jsonl.gz`); as blocks they do the same."""

from __future__ import annotations

import json
import random
import subprocess
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

from aseba_vm import VirtualMachine
from aseba_vm import compile as compile_program
from aseba_vm.machine.machine_messages import NativeCalled
from aseba_vm.targets import THYMIO_II
from web_ui import build

SCRIPT = Path(__file__).with_name("print_vpl.js")
RANDOM_PROGRAMS = 8
EVENTS = (("pair_run", 1), ("debug_log", 14), ("PairExecuted", 1))

pytestmark = pytest.mark.process


@pytest.fixture(scope="module")
def printed() -> list[dict[str, Any]]:
    node = build.find_node()
    if node is None:
        pytest.skip("no Node on this machine")
    command = [node.folder / "node", SCRIPT, str(RANDOM_PROGRAMS)]
    done = subprocess.run(command, capture_output=True, text=True, check=True)
    return [json.loads(line) for line in done.stdout.splitlines()]


def words(text: str, events: Sequence[tuple[str, int]] = EVENTS) -> list[int]:
    return list(compile_program(text, THYMIO_II, events).words)


def test_the_golden_programs_have_the_words_of_the_original(printed: list[dict[str, Any]]) -> None:
    golden = [program for program in printed if "words" in program]
    assert len(golden) == 203
    assert [each["id"] for each in golden if words(each["text"], EVENTS[:2]) != each["words"]] == []


def test_what_any_version_generates_compiles(printed: list[dict[str, Any]]) -> None:
    others = [program for program in printed if "words" not in program]
    assert len(others) > RANDOM_PROGRAMS
    for program in others:
        assert words(program["text"]), program["id"]


SENSED = {
    "prox.horizontal": (0, 400, 999, 1000, 1001, 1999, 2000, 2001, 4500),
    "prox.ground.delta": (0, 150, 399, 400, 401, 449, 450, 451, 1000),
    "prox.ground.reflected": (0, 149, 150, 301, 1000),
    "acc": (-23, -12, 0, 1, 12, 23),
    "rc5.command": (1, 5, 16, 32, 80, 85, 87),
    **{f"button.{name}": (0, 1) for name in ("backward", "left", "center", "forward", "right")},
}
"""Values of sensors around the limits of blocks."""
HANDLED = ("buttons", "prox", "acc", "tap", "mic", "timer0", "rc5", "sound.finished")
COMMANDED = ("motor.left.target", "motor.right.target", "timer.period", "mic.threshold")
EVENTS_RUN = 40
PLACES: dict[str, slice] = {}
"""Variables of the robot in its memory."""
for _variable in THYMIO_II.variables:
    _start = max((place.stop for place in PLACES.values()), default=0)
    PLACES[_variable.name] = slice(_start, _start + _variable.size)


def behavior(text: str) -> list[Any]:
    """What a program commands at its start and in random events: functions with their numbers, and variables."""
    machine = VirtualMachine(THYMIO_II)
    machine.load(compile_program(text, THYMIO_II, EVENTS))
    events = [event.name for event in THYMIO_II.local_events]
    drawn = random.Random(1)
    commands: list[Any] = []

    def run() -> None:
        machine.run()
        calls = [message for message in machine.pop_messages() if isinstance(message, NativeCalled)]
        numbers = [(call.name, [words for _, _, words in call.arguments]) for call in calls]
        commands.append((numbers, [list(machine.variables.words[PLACES[name]]) for name in COMMANDED]))

    machine.reset()
    machine.resume()
    run()
    for _ in range(EVENTS_RUN):
        for name, values in SENSED.items():
            place = PLACES[name]
            machine.write_variables(place.start, drawn.choices(values, k=place.stop - place.start))
        machine.start_local(events.index(drawn.choice(HANDLED)))
        run()
    return commands


def test_programs_do_the_same_as_blocks(printed: list[dict[str, Any]]) -> None:
    shown = [program for program in printed if "prox.ground.reflected" not in program["text"]]
    assert len(shown) > 0.9 * len(printed)  # blocks have no such sensor, and only VPL before 1.4 uses it
    assert [each["id"] for each in shown if each["problems"]] == []
    assert any(calls for program in shown for calls, _ in behavior(program["text"])[1:])
    assert [each["id"] for each in shown if behavior(each["text"]) != behavior(each["blocks"])] == []


def test_a_text_without_blocks_says_which_line_has_none(printed: list[dict[str, Any]]) -> None:
    others = [program for program in printed if "prox.ground.reflected" in program["text"]]
    assert others
    for program in others:
        (unknown,) = program["problems"]
        assert program["text"].splitlines()[unknown["line"] - 1].strip() == unknown["text"]
        assert "prox.ground.reflected" in unknown["text"]
