"""An installation of the packages of a workspace for one run of `ros2 run`, `launch` or `pkg`, without a build.

It is a folder as colcon makes it: `lib/PACKAGE/NAME` starts a program, and the index of packages has their names. Its
programs are those of the source folders, so nothing is copied, and a change acts at the next start. The folder is
removed at the end. Environment variables pass it on, and the server, to all processes that are started.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import shlex
import sys
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from importlib import import_module
from pathlib import Path

from thymio_sim_ros import examples
from thymio_sim_ros.access.tokens import TOKEN_VARIABLE
from thymio_sim_ros.cli.ros.membership import CONNECT_VARIABLE
from thymio_sim_ros.cli.ros.workspace import Program, SourcePackage, packages, programs
from thymio_sim_ros.portable_ros.source_packages import INDEX, PREFIXES, SOURCES
from thymio_sim_ros.ros.profiles import all_profiles

__all__ = ["Overlay"]

_OURS = "thymio_sim_ros"
_OF_SUITE = ("aseba_runtime", "foxglove_bridge", "simulator", "thymio", "web_ui")
"""Programs of this package that are the suite: on the embedded graph it is one process, which is there already."""
_NO_SUITE = """\
import sys

sys.exit("thymio-sim: {name} runs on an installed ROS 2 only; without it, start `thymio-sim`, whose robots are shared")
"""
_ENTRY_POINT = """\
import sys

sys.path.insert(0, {folder!r})
from {module} import {first}

sys.exit({function}())
"""
_START = """\
import sys
from thymio_sim_ros.entry_points import thymio_sim

if __name__ == "__main__":
    sys.argv[:1] = {words!r}
    sys.exit(thymio_sim())
"""
_SCRIPT = """\
#!/bin/sh
'''exec' {python} "$0" "$@"
' '''
"""
"""The first lines of a script for sh and Python; the path of Python may be too long for one line, or have spaces."""


class Overlay:
    """The folder of one run: made when the context is entered, and removed at its end."""

    def __init__(self, folder: Path, found: Sequence[SourcePackage]) -> None:
        self._folder = folder
        self._packages = {one.name: one for one in found if one.name != _OURS}
        self._programs, self._errors = programs(list(self._packages.values()))

    @classmethod
    @contextlib.contextmanager
    def made(cls, options: argparse.Namespace) -> Iterator[Overlay]:
        """Install the packages around the current folder, for the graph that the options choose, and announce them."""
        with tempfile.TemporaryDirectory(prefix="thymio_sim_ros2_", ignore_cleanup_errors=True) as folder:
            overlay = cls(Path(folder), packages(Path.cwd()))
            overlay._install()
            for reason in overlay._errors.values():
                print(f"thymio-sim ros2: {reason}; its programs are not there", file=sys.stderr)
            os.environ.update(overlay._variables(options))
            yield overlay

    def missing(self, words: Sequence[str]) -> str:
        """Why `ros2 run` with these words finds no program, if that is known; otherwise empty."""
        package, name, *_ = (*words, "", "")
        if package.startswith("-") or package not in self._packages or package in self._errors:
            return ""
        names = [one.name for one in self._programs[package]]
        if not name or name in names:
            return ""
        there = f"one of {', '.join(sorted(names))}" if names else "a program in Python, but it has none"
        return f"{self._packages[package].folder}: found no program {name}, expected {there}{self._why(package)}"

    def not_in_python(self) -> str:
        """A sentence on packages that have programs which have to be built; empty without one."""
        names = [name for name, one in self._packages.items() if one.has_compiled_programs]
        return f"without ROS 2, programs run in Python only; there are others in {', '.join(names)}" if names else ""

    def _why(self, package: str) -> str:
        return "; programs in C++ need an installed ROS 2" if self._packages[package].has_compiled_programs else ""

    def _install(self) -> None:
        for name, package in self._packages.items():
            self._index("packages", name, "")
            self._index(SOURCES, name, str(package.folder))
            folder = self._folder / "lib" / name
            folder.mkdir(parents=True)
            for program in self._programs[name]:
                file = program.file or self._written(name, program, package.folder)
                _make_start(folder, program.name, ["thymio-sim", "node", str(file)])
        self._index("packages", _OURS, "")
        ours = self._folder / "lib" / _OURS
        ours.mkdir(parents=True)
        for example in sorted(Path(examples.__file__).parent.glob("[!_]*.py")):
            _make_start(ours, example.stem, ["thymio-sim", "node", str(example)])
        for name in _OF_SUITE:
            file = self._file(_OURS, name, _NO_SUITE.format(name=name))
            _make_start(ours, name, ["thymio-sim", "node", str(file)])
        for name, modules in self._of_profiles().items():
            self._index("packages", name, "")
            folder = self._folder / "lib" / name
            folder.mkdir(parents=True)
            for program_name, module in modules.items():
                _make_start(folder, program_name, ["thymio-sim", "node", "-m", module])
        (self._folder / "bin").mkdir()
        _make_start(self._folder / "bin", "ros2", ["thymio-sim", "ros2"])

    def _of_profiles(self) -> Mapping[str, Mapping[str, str]]:
        """Modules by package and program, of the packages of other robots that the workspace does not have."""
        found: dict[str, dict[str, str]] = {}
        for profile in all_profiles():
            for package, modules in profile.programs.items():
                if package not in self._packages:
                    found.setdefault(package, {}).update(modules)
        return found

    def _index(self, kind: str, name: str, text: str) -> None:
        folder = self._folder / INDEX / kind
        folder.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")

    def _written(self, package: str, program: Program, folder: Path) -> Path:
        """The file of a program that is an entry point."""
        module, _, function = program.entry_point.partition(":")
        first = function.partition(".")[0]
        text = _ENTRY_POINT.format(folder=str(folder), module=module, function=function, first=first)
        return self._file(package, program.name, text)

    def _file(self, package: str, name: str, text: str) -> Path:
        folder = self._folder / "programs" / package
        folder.mkdir(parents=True, exist_ok=True)
        file = folder / f"{name}.py"
        file.write_text(text, encoding="utf-8")
        return file

    def _variables(self, options: argparse.Namespace) -> Mapping[str, str]:
        values = {
            PREFIXES: os.pathsep.join(filter(None, [str(self._folder), os.environ.get(PREFIXES)])),
            "PATH": os.pathsep.join([str(self._folder / "bin"), os.environ.get("PATH", "")]),
            TOKEN_VARIABLE: options.token,
        }
        if options.connect:
            values[CONNECT_VARIABLE] = options.connect
        return values


def _make_start(folder: Path, name: str, words: Sequence[str]) -> None:
    """Make a program that starts `thymio-sim`: a script, or on Windows an `.exe`, with which its Python ends."""
    start = _START.format(words=list(words))
    if os.name == "nt":
        maker = import_module("distlib.scripts").ScriptMaker(None, str(folder))
        maker.variants = {""}
        maker.script_template = start.replace("%", "%%")
        maker.make(f"{name} = no_module:no_function")  # the template uses neither
        return
    script = folder / name
    script.write_text(_SCRIPT.format(python=shlex.quote(sys.executable)) + start, encoding="utf-8")
    script.chmod(0o755)
