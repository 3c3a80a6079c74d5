"""The packages of a workspace of ROS 2 that has not been built: their folders, and their programs in Python."""

from __future__ import annotations

import json
import os
import re
import subprocess
import sys
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

from thymio_sim_ros.portable_ros.source_packages import MANIFEST, declared_name

__all__ = ["Program", "SourcePackage", "add_to_path", "packages", "programs"]

_SRC = "src"
_SETUP = "setup.py"
_CMAKE = "CMakeLists.txt"
_LONGEST_PATH = 4
"""Folders between the folder of all packages and that of one: `src/course/week_3/my_package`."""
_NO_PACKAGES = {"build", "install", "log", "node_modules"}
_IGNORED = ("COLCON_IGNORE", "AMENT_IGNORE", "CATKIN_IGNORE")
_INSTALLED_PROGRAMS = re.compile(r"\binstall\s*\(\s*PROGRAMS\s+(.*?)\bDESTINATION\b", re.DOTALL | re.IGNORECASE)
_COMPILED = re.compile(r"\badd_(executable|library)\s*\(", re.IGNORECASE)
_COMMENT = re.compile(r"#.*")


@dataclass(frozen=True, slots=True)
class SourcePackage:
    """A package that is not installed."""

    name: str
    folder: Path

    @property
    def has_compiled_programs(self) -> bool:
        """Whether CMake builds programs or components of the package."""
        return _COMPILED.search(_cmake_text(self.folder)) is not None


@dataclass(frozen=True, slots=True)
class Program:
    """A program of a package in Python: a file, or else an entry point `module:function` of modules in a folder."""

    name: str
    file: Path | None = None
    entry_point: str = ""


def packages(folder: Path) -> list[SourcePackage]:
    """The packages of the workspace around a folder, sorted by name; of several with one name, the first one.

    They are in the nearest folder `src` of the folder and those above it, as colcon looks for them; else, the folder
    and those above it may be a package, beside which there may be others.
    """
    above = (folder, *folder.parents)
    if source := next((one / _SRC for one in above if _is_workspace(one)), None):
        found = _below(source, _LONGEST_PATH)
    elif package := next((one for one in above if (one / MANIFEST).is_file()), None):
        found = iter([package, *_below(package.parent, 1)])
    else:
        found = _below(folder, 1)
    by_name: dict[str, Path] = {}
    for one in found:
        if name := declared_name(one):
            by_name.setdefault(name, one)
    return [SourcePackage(name, by_name[name]) for name in sorted(by_name)]


def add_to_path() -> None:
    """Let this process find the types of the packages around the current folder, as after `source install/setup.bash`.

    Packages of messages are found in the folders from which Python imports (`portable_ros/source_packages.py`).
    """
    folders = dict.fromkeys(str(one.folder.parent) for one in packages(Path.cwd()))
    sys.path.extend(folder for folder in folders if folder not in sys.path)


def _is_workspace(folder: Path) -> bool:
    """Whether a folder has `src`, which is not that of a package."""
    return (folder / _SRC).is_dir() and not (folder / MANIFEST).is_file()


def _below(folder: Path, levels: int) -> Iterator[Path]:
    """The folders of packages below a folder, down to a number of levels; a package contains no other one."""
    try:
        inner = sorted(one for one in folder.iterdir() if one.is_dir())
    except OSError:  # a folder without permission to read
        return
    for one in inner:
        if one.name.startswith(".") or one.name in _NO_PACKAGES or any((one / name).exists() for name in _IGNORED):
            continue
        if (one / MANIFEST).is_file():
            yield one
        elif levels > 1:
            yield from _below(one, levels - 1)


def programs(found: list[SourcePackage]) -> tuple[Mapping[str, list[Program]], Mapping[str, str]]:
    """The programs in Python of each package by its name, and why those of some are not known.

    They are the console scripts of `setup.py`, which is executed as colcon does it, and the files that `CMakeLists.txt`
    installs by `install(PROGRAMS …)`.
    """
    result = {one.name: _installed_by_cmake(one.folder) for one in found}
    errors: dict[str, str] = {}
    with_setup = [one for one in found if (one.folder / _SETUP).is_file()]
    if not with_setup:
        return result, errors
    words = [sys.executable, "-m", f"{__package__}.console_scripts", *(str(one.folder) for one in with_setup)]
    done = subprocess.run(
        words, stdout=subprocess.PIPE, check=True, encoding="utf-8", env={**os.environ, "PYTHONUTF8": "1"}
    )
    for package, answer in zip(with_setup, json.loads(done.stdout), strict=True):
        if reason := answer.get("error"):
            errors[package.name] = f"{package.folder / _SETUP}: {reason}"
        result[package.name] += [Program(name, entry_point=point) for name, point in answer.get("scripts", [])]
    return result, errors


def _installed_by_cmake(folder: Path) -> list[Program]:
    found = _INSTALLED_PROGRAMS.findall(_cmake_text(folder))
    files = (folder / word.strip('"') for part in found for word in part.split())
    return [Program(file.name, file=file) for file in files if file.suffix == ".py" and file.is_file()]


def _cmake_text(folder: Path) -> str:
    """The CMakeLists.txt of a folder without comments, empty without one."""
    try:
        return _COMMENT.sub("", (folder / _CMAKE).read_text(encoding="utf-8", errors="replace"))
    except OSError:
        return ""
