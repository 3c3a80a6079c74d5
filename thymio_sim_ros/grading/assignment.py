"""Assignments: the tests, the expected files and the limits with which submissions are graded.

An assignment is a pytest file, or a TOML file beside its tests:

    tests = ["test_follower.py"]
    hidden = ["test_hidden.py"]      # pupils see the verdicts of these tests, but neither messages nor output
    files = ["follower.aesl"]        # what each submission must contain
    data = ["maze.json"]             # other files that the tests read
    solution = "solution"            # a submission that must get all points
    mission = "mission.json"         # beside the tests or in place of them: a point for each star

    [limits]
    cpu_s = 30
"""

from __future__ import annotations

import re
import tomllib
from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass, field, fields, replace
from pathlib import Path, PurePosixPath
from typing import Any

from thymio_sim_ros.grading.errors import GradingError

__all__ = ["MAX_FILES", "Assignment", "Limits", "load"]

MAX_FILES = 20_000
"""Files and folders that a submission may have at the same time."""

_LISTS = ("tests", "hidden", "files", "data")


@dataclass(frozen=True, slots=True)
class Limits:
    """Limits of one submission. All are above 0; times in s, sizes in MB (10⁶ bytes)."""

    cpu_s: float = 30.0
    """Processor time of one test, that of its start included."""
    total_cpu_s: float = 300.0
    """Processor time of all tests."""
    idle_s: float = 60.0
    """Real time in which no process of the submission computes or waits for a disk: it sleeps or waits in vain."""
    wall_s: float = 3600.0
    """Real time of all tests, the last resort."""
    memory_mb: float = 1000.0
    """Memory of all processes."""
    processes: int = 200
    """Processes and threads at the same time."""
    output_mb: float = 10.0
    """Output of one test."""
    disk_mb: float = 64.0
    """Size of all files that it writes."""


@dataclass(frozen=True, slots=True)
class Assignment:
    """The tests of an assignment as values. Paths are relative to its folder, with slashes."""

    name: str
    tests: tuple[str, ...]
    """Test files in the order in which they run, hidden ones last."""
    hidden: frozenset[str]
    expected: tuple[str, ...]
    """Files that a submission must contain."""
    content: Mapping[str, bytes] = field(repr=False)
    """Content of all files of the assignment."""
    limits: Limits = Limits()
    solution: Path | None = None
    """A submission that must get all points."""
    mission: Path | None = None
    """A mission whose stars are points, too; its test is not among `tests` yet."""
    has_installed_ros: bool = False
    """Whether nodes are tested on an installed ROS 2, not on the embedded graph."""

    def is_hidden(self, test: str) -> bool:
        """Whether a test, given by its pytest node ID, is one of a hidden file."""
        return test.partition("::")[0] in self.hidden

    def parts(self) -> list[Assignment]:
        """The visible tests and the hidden ones, each with the files that they need: each part has its own sandbox."""
        visible = tuple(test for test in self.tests if test not in self.hidden)
        secret = {*self.hidden, *self.hidden_data()}
        files = {name: data for name, data in self.content.items() if name not in secret}
        hidden_files = {name: data for name, data in self.content.items() if name not in visible}
        parts = [replace(self, tests=visible, content=files, hidden=frozenset())]
        parts.append(
            replace(self, tests=tuple(test for test in self.tests if test in self.hidden), content=hidden_files)
        )
        return [part for part in parts if part.tests]

    def hidden_data(self) -> list[str]:
        """The data that only hidden tests get: all that no visible test names, nor a file that one names.

        A test names a file by the last part of its path, a module without `.py`. `conftest.py` belongs to all tests.
        """
        if not self.hidden:
            return []
        data = [name for name in self.content if name not in self.tests]
        shown = {name for name in data if PurePosixPath(name).name == "conftest.py"}
        shown |= set(self.tests) - self.hidden
        while new := {name for name in data if name not in shown and self._is_named(name, shown)}:
            shown |= new
        return [name for name in data if name not in shown]

    def _is_named(self, name: str, files: Iterable[str]) -> bool:
        path = PurePosixPath(name)
        word = path.stem if path.suffix == ".py" else path.name
        pattern = re.compile(rb"(?<!\w)" + re.escape(word.encode()) + rb"(?!\w)")
        return any(pattern.search(self.content[file]) for file in files)


def load(path: Path) -> Assignment:
    """Load an assignment. Raises GradingError with file, key, found and expected."""
    if path.suffix == ".toml":
        return _load_toml(path)
    if path.suffix != ".py":
        raise GradingError(f"{path}: expected a pytest file (*.py) or an assignment (*.toml)")
    data = sorted(other.name for other in path.parent.glob("conftest.py"))
    return _assignment(path.stem, path.parent, {"tests": [path.name], "data": data}, Limits())


def _load_toml(path: Path) -> Assignment:
    try:
        table = tomllib.loads(path.read_text(encoding="utf-8"))
    except OSError as error:
        raise GradingError(f"{path}: {error.strerror}; expected a file that can be read") from error
    except (ValueError, RecursionError) as error:
        raise GradingError(f"{path}: {error}; expected TOML in UTF-8") from error
    limits = _limits(path, table.pop("limits", {}))
    solution = _below(path, table, "solution", "the relative path of a folder, file or zip")
    mission = _below(path, table, "mission", "the relative path of a mission")
    for key, value in table.items():
        if key not in _LISTS:
            raise GradingError(
                f"{path}: found the key {key!r}, expected {', '.join(_LISTS)}, solution, mission or limits"
            )
        if not isinstance(value, list) or not all(isinstance(name, str) and _is_inside(name) for name in value):
            raise GradingError(f"{path}: {key}: found {value!r}, expected a list of relative paths below its folder")
    if not table.get("tests") and not table.get("hidden") and mission is None:
        raise GradingError(f"{path}: tests: found none, expected a list of test files, or a mission")
    return replace(_assignment(path.stem, path.parent, table, limits), solution=solution, mission=mission)


def _below(path: Path, table: dict[str, Any], key: str, expected: str) -> Path | None:
    """Take a path below the folder of an assignment from its table; None: it has none. Raises GradingError."""
    name = table.pop(key, "")
    if not isinstance(name, str) or (name and not _is_inside(name)):
        raise GradingError(f"{path}: {key}: found {name!r}, expected {expected}")
    return path.parent / name if name else None


def _is_inside(name: str) -> bool:
    path = PurePosixPath(name)
    return bool(path.parts) and not path.is_absolute() and ".." not in path.parts and not {"\\", "\0"} & set(name)


def _limits(path: Path, table: object) -> Limits:
    known = asdict(Limits())
    if not isinstance(table, dict):
        raise GradingError(f"{path}: limits: found {table!r}, expected a table")
    for key, value in table.items():
        if key not in known:
            raise GradingError(f"{path}: limits.{key}: unknown, expected one of {', '.join(known)}")
        kind = int if isinstance(known[key], int) else (int, float)
        if isinstance(value, bool) or not isinstance(value, kind) or not 0 < value < 1e9:
            raise GradingError(f"{path}: limits.{key}: found {value!r}, expected a number above 0")
    return Limits(
        **{item.name: type(known[item.name])(table.get(item.name, known[item.name])) for item in fields(Limits)}
    )


def _assignment(name: str, folder: Path, lists: Mapping[str, Any], limits: Limits) -> Assignment:
    hidden = tuple(lists.get("hidden", ()))
    tests = (*(test for test in lists.get("tests", ()) if test not in hidden), *hidden)
    content: dict[str, bytes] = {}
    for file in (*tests, *lists.get("data", ())):
        try:
            content[file] = (folder / file).read_bytes()
        except OSError as error:
            raise GradingError(f"{folder / file}: {error.strerror}; expected a file of the assignment") from error
    return Assignment(name, tests, frozenset(hidden), tuple(lists.get("files", ())), content, limits)
