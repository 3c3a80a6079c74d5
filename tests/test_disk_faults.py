"""Every file that the project writes, on a disk that fails at each operation in turn (docs/reliability.md).

After a failure the file is whole, the old or the new one, no other file is left, and the error names it.
"""

from __future__ import annotations

import errno
import json
import os
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from pathlib import Path

import pytest

from aseba_vm.cli.main import main as aseba
from tests.disk import FailingDisk
from tests.sim.builders import make
from thymio_sim_ros.classroom.folder import ClassFolder, Work
from thymio_sim_ros.cli.main import main as thymio_sim
from thymio_sim_ros.cli.runner_sound import run_with_sound
from thymio_sim_ros.device.firmware.sd_card import SdCard
from thymio_sim_ros.device.firmware.settings import Settings
from thymio_sim_ros.device.programs.program import load_program
from thymio_sim_ros.engine.engine import Engine
from thymio_sim_ros.engine.run_log import RunLog, read
from thymio_sim_ros.errors import ThymioSimError
from thymio_sim_ros.grading.assignment import Assignment
from thymio_sim_ros.grading.finished import FinishedReports
from thymio_sim_ros.grading.reports.folder import write_reports, write_submission
from thymio_sim_ros.grading.reports.texts import file_name
from thymio_sim_ros.grading.results import Graded, GradedTest, Verdict
from thymio_sim_ros.grading.sandbox.job import Report
from thymio_sim_ros.grading.submissions import Submission
from thymio_sim_ros.sweep.description import Description
from thymio_sim_ros.sweep.grid import Sweep
from thymio_sim_ros.sweep.run import failed_row
from thymio_sim_ros.sweep.table import write_table

FAILURES = {"full disk": (errno.ENOSPC, True), "no permission": (errno.EACCES, False), "damaged": (errno.EIO, False)}
MOST_OPERATIONS = 200


class CommandError(Exception):
    """A command ended with an error; the text is what it printed."""


@dataclass(frozen=True)
class Writer:
    """Something that writes files: `write` gets a folder and whether it writes the first or the second version."""

    name: str
    write: Callable[[Path, bool], None]
    files: tuple[str, ...]


def _command(main: Callable[..., int], *arguments: str) -> None:
    if main([*arguments]) != 0:
        raise CommandError


def _format(folder: Path, second: bool) -> None:
    if second:
        _command(aseba, "fmt", "--write", str(folder / "a.aseba"))
    else:
        (folder / "a.aseba").write_text("  a=1\n")


def _compile(folder: Path, second: bool) -> None:
    source = folder.parent / "source.aseba"
    source.write_text(f"var a = {int(second)}\n")
    _command(aseba, "compile", str(source), "-o", str(folder / "words.hex"))


def _convert(folder: Path, second: bool) -> None:
    _command(thymio_sim, "convert", "gate" if second else "desk", "-o", str(folder / "playground.json"))


def _layout(folder: Path, second: bool) -> None:
    robot = "two" if second else "one"
    _command(thymio_sim, "foxglove-layout", "--robot", robot, "-o", str(folder / "layout.json"))


def _settings(folder: Path, second: bool) -> None:
    settings = Settings(folder / "deep" / "settings.json")
    settings[0] = int(second)
    problem = settings.flash()
    if problem:
        raise CommandError(problem)


def _recording(folder: Path, second: bool) -> None:
    card = SdCard(folder)
    if not card.write_sound("r1", bytes(900) if second else b"\x80" * 700):
        raise CommandError(card.refusal)


def _sound(folder: Path, second: bool) -> None:
    engine = Engine(make(), load_program("call sound.freq(440, 30)" if second else "", "test"))
    run_with_sound(engine, engine.steps(0.05), folder / "sound.wav")


@cache
def _sweep() -> Sweep:
    return Description(seconds=1.0, measures=("x_m",), seeds=(1, 2)).sweep()


def _table(suffix: str) -> Callable[[Path, bool], None]:
    def write(folder: Path, second: bool) -> None:
        rows = {number: [failed_row(_sweep(), number, "")] for number in range(1 + second)}
        write_table(folder / f"table{suffix}", _sweep(), rows)

    return write


def _class_folder(folder: Path, second: bool) -> None:
    ClassFolder(folder).places(["Ada", "Ben"] if second else ["Ada"])


def _pupils_program(folder: Path, second: bool) -> None:
    kept = ClassFolder(folder)
    (place,) = kept.places(["Ada"])
    kept.keep(place, Work(f"motor.left.target = {int(second)}\n", program_name=f"{int(second)}.aesl"))


def _reports(folder: Path, second: bool) -> None:
    test = GradedTest("test_a.py::test_it", Fraction(1 + second))
    graded = Graded(Submission("Ada"), [Verdict(test, "failed", files={"run.jsonl": b"{}" * (1 + second)})])
    write_submission(folder, graded)
    write_reports(folder, "task", "none", [test], {1: graded})


_TASK = Assignment("task", ("test_a.py",), frozenset(), (), {})
_KEPT = FinishedReports(Path(), _TASK)._path(Submission("Ada")).name


def _kept_report(folder: Path, second: bool) -> None:
    FinishedReports(folder / "kept", _TASK).add(Submission("Ada"), Report({}, remark="second" if second else "first"))


_ADA = file_name(Graded(Submission("Ada"), []))
_PUPIL = f"pupils/{_ADA}"
WRITERS = [
    Writer("aseba fmt", _format, ("a.aseba",)),
    Writer("aseba compile", _compile, ("words.hex",)),
    Writer("convert", _convert, ("playground.json",)),
    Writer("foxglove-layout", _layout, ("layout.json",)),
    Writer("settings", _settings, ("deep/settings.json",)),
    Writer("recording on the card", _recording, ("r1.wav",)),
    Writer("sound of a run", _sound, ("sound.wav",)),
    Writer("sweep as CSV", _table(".csv"), ("table.csv",)),
    Writer("sweep as Parquet", _table(".parquet"), ("table.parquet",)),
    Writer("folder of a class", _class_folder, ("class.json",)),
    Writer("program of a pupil", _pupils_program, ("class.json", "pupils/ada/program.aesl", "pupils/ada/work.json")),
    Writer("kept report of a grading", _kept_report, (f"kept/{_KEPT}",)),
    Writer("reports", _reports, (
        "marks.csv", "junit.xml", "index.html", f"{_PUPIL}/index.html", f"{_PUPIL}/results.json",
        f"{_PUPIL}/test-1.jsonl", f"teacher/{_ADA}.txt",
    )),
]  # fmt: skip


def _files(folder: Path) -> dict[str, bytes]:
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def _copy(files: Mapping[str, bytes], folder: Path) -> Path:
    for name, data in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(data)
    folder.mkdir(parents=True, exist_ok=True)
    return folder


def _is_whole(name: str, content: bytes, *versions: Mapping[str, bytes]) -> bool:
    if name == "class.json":  # has random tokens
        return {"Ada"} <= {pupil["name"] for pupil in json.loads(content)["pupils"]}
    return any(version.get(name) == content for version in versions)


CASES = [(writer, exists) for writer in WRITERS for exists in (False, True) if exists or writer.write is not _format]


@pytest.mark.parametrize("failure", FAILURES)
@pytest.mark.parametrize(("writer", "exists"), CASES, ids=lambda value: getattr(value, "name", str(value)))
def test_a_file_is_the_old_or_the_new_one_wherever_the_disk_fails(
    writer: Writer, failure: str, exists: bool, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    if "table.parquet" in writer.files:
        pytest.importorskip("pyarrow")
    code, stays_broken = FAILURES[failure]
    first = _copy({}, tmp_path / "first")
    if exists:
        writer.write(first, False)
    old = _files(first)
    done = _copy(old, tmp_path / "done")
    writer.write(done, True)
    new = _files(done)
    assert set(new) == set(writer.files)
    for number in range(1, MOST_OPERATIONS):
        folder = _copy(old, tmp_path / str(number) / "here")
        capsys.readouterr()
        disk = FailingDisk(folder, number, code, stays_broken=stays_broken)
        try:
            with disk.failing():
                writer.write(folder, True)
        except (OSError, CommandError, ThymioSimError) as error:
            text = f"{error} {getattr(error, 'filename', '')} {capsys.readouterr().err}"
            assert disk.has_failed, text
            assert str(folder) in text, f"operation {number}: the error names no file"
            assert os.strerror(code) in text
        found = _files(folder)
        for name, content in found.items():
            assert _is_whole(name, content, old, new), f"operation {number}: {name}"
        assert set(old) <= set(found)
        if not disk.has_failed:
            break
    assert number > 3, "the disk has hardly been used: is the file written past it?"
    assert set(found) == set(new)


def _logged(path: Path) -> None:
    with open(path, "w", encoding="utf-8", newline="\n") as file:
        log = RunLog(file)
        engine = Engine(make(), seed=3)
        log.begin("faults", engine)
        for _ in range(250):
            engine.step()
        log.close()


def test_a_run_log_is_valid_up_to_where_the_disk_failed(tmp_path: Path) -> None:
    _logged(tmp_path / "whole.jsonl")
    whole = [repr(entry) for _, entry in read(tmp_path / "whole.jsonl")]
    lengths = set()
    for number in range(1, MOST_OPERATIONS):
        path = _copy({}, tmp_path / str(number)) / "run.jsonl"
        disk = FailingDisk(path.parent, number, errno.ENOSPC, stays_broken=True)
        with disk.failing(), suppress(OSError):
            _logged(path)
        if not disk.has_failed:
            break
        if path.exists() and path.stat().st_size > 200:
            found = [repr(entry) for _, entry in read(path)]
            assert found == whole[: len(found)]
            lengths.add(len(found))
    assert [repr(entry) for _, entry in read(path)] == whole
    assert lengths


def test_an_error_of_a_run_log_names_the_file(tmp_path: Path) -> None:
    disk = FailingDisk(tmp_path, 2, errno.ENOSPC)
    with disk.failing(), pytest.raises(OSError, match=r"No space left on device: .*run\.jsonl"):
        _logged(tmp_path / "run.jsonl")


def test_words_that_cannot_be_written_to_the_card_are_reported_with_the_file(tmp_path: Path) -> None:
    for number in range(1, MOST_OPERATIONS):
        card = SdCard(tmp_path / str(number))
        file = card.folder / "u7.dat"
        disk = FailingDisk(card.folder, number, errno.ENOSPC)
        with disk.failing():
            is_open = card.open(7)
            refusal = card.refusal
            written = card.write([1, 2, 3, 4]) if is_open else 0
        if not disk.has_failed:
            break
        assert written == 0
        assert (refusal or card.refusal) == f"{file}: {os.strerror(errno.ENOSPC)}"
        assert card.open(7)
        assert card.write([5, 6]) == 2, "the card works again when the disk has room"
    assert number > 2
    assert file.read_bytes() == b"\1\0\2\0\3\0\4\0"
