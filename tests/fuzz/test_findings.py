"""What campaigns have found: readable errors in place of tracebacks, and files that are read after all."""

from __future__ import annotations

from dataclasses import fields

import pytest

from tests.fuzz.table import TARGETS
from tests.fuzz.target import FOLDER
from thymio_sim_ros.device.firmware import wav
from thymio_sim_ros.engine import command_codec, run_log
from thymio_sim_ros.engine.command_codec import CommandJsonError

BIG = b"9" * 400
"""An integer above all floats."""
NESTED = b"[" * 3000
LOG = b'{"format": "thymio-sim run log", "version": 1, "made_by": "0.1.0"}\n'


@pytest.mark.parametrize(
    ("target", "data", "message"),
    [
        ("settings", NESTED, "settings .*settings.json: maximum recursion depth"),
        ("target-description", NESTED, "target.json: not JSON"),
        ("sweep-json", b'{"seconds": %s}' % BIG, "seconds: found 9+, expected a number"),
        ("sweep-json", NESTED, "sweep.json: .*; expected a sweep in JSON"),
        ("sweep-toml", b"seeds = 1979-05-27", 'seeds: found "1979-05-27", expected a list of integers'),
        ("sweep-toml", b"[parameters]\n" + b"a." * 1500 + b"b = 1", "parameters: found tables nested without measure"),
        ("assignment", b"a = " + NESTED, "task.toml: .*; expected TOML"),
        ("assignment", b'tests = ["a\\u0000"]', "tests: found .*, expected a list of relative paths"),
        ("class-folder", NESTED, "class.json: .*; expected the file as this program wrote it"),
        ("class-request", b"message\n" + NESTED, "not JSON"),
        ("pupils", b'"' + b"a" * 140_000, "names.csv: field larger than .*; expected a table"),
        ("robot-address", b"tcp:a:" + b"1" * 5000, "found port '1+', expected a number from 1 to 65535"),
        ("robot-address", b"tcp:[[a]]:5", r"found host '\[a\]', expected a name or an address"),
        ("aesl", b'<?xml version="1.0" encoding="idna"?><network>\xff</network>', "idna"),
        ("run-log", LOG + NESTED + b"\n", "line 2: found nesting without measure"),
        ("test-report", b'{"secret":"s3cret","do":"_eq__"}', "a line of an unknown kind"),
    ],
)
def test_a_rejected_input_is_explained(target: str, data: bytes, message: str) -> None:
    found = TARGETS[target]
    with pytest.raises(found.rejects, match=message):
        found.run(data)


def test_a_number_that_no_float_can_hold_is_rejected_in_every_command_with_floats() -> None:
    for name, kind in command_codec.kinds().items():
        if any("float" in str(field.type) for field in fields(kind)):
            with pytest.raises(CommandJsonError):
                command_codec.decode(name, {field.name: 10**400 for field in fields(kind)})


def test_the_version_of_a_log_that_was_cut_off_within_a_character_is_known() -> None:
    path = FOLDER / "cut.jsonl"
    path.write_bytes(LOG + '{"tick": 0, "remove": "ä'.encode()[:-1])
    assert list(run_log.read(path)) == []
    assert run_log.made_by(path) == "0.1.0"


def test_a_sound_with_a_damaged_chunk_is_played_with_a_message() -> None:
    path = FOLDER / "p7.wav"
    path.write_bytes(b"RIFF\x88\0\0\0WAVEfmfmt t \x10\0\0\0\1\0\1\0\x84\x1e\0\0\x84\x1e\0\0\1\0\x08\0datad\0\0")
    assert wav.format_problem(path).startswith("p7.wav: no WAV file found")
