"""Prints the console scripts of packages: `python -m thymio_sim_ros.cli.ros.console_scripts FOLDER ...`.

A process of its own, because the `setup.py` of each folder is executed, up to the point at which its arguments are
known. The answer is JSON, an object for each folder: `scripts`, pairs of a name and `module:function`, or `error`.
"""

from __future__ import annotations

import configparser
import contextlib
import json
import os
import sys
import warnings
from collections.abc import Iterable, Mapping
from importlib import import_module
from typing import Any

__all__ = ["main", "scripts_of"]

_SETUP = "setup.py"
_GROUP = "console_scripts"


def main(folders: Iterable[str]) -> None:
    """Print the answer about these folders; what a `setup.py` prints goes to stderr."""
    warnings.filterwarnings("ignore", "Unknown distribution option")  # `tests_require`, as `ros2 pkg create` writes it
    with contextlib.redirect_stdout(sys.stderr):
        answers = [_answer(folder) for folder in folders]
    json.dump(answers, sys.stdout)


def _answer(folder: str) -> Mapping[str, Any]:
    try:
        return {"scripts": scripts_of(folder)}
    except (Exception, SystemExit) as error:  # a program of the user
        return {"error": f"{type(error).__name__}: {error}"}


def scripts_of(folder: str) -> list[tuple[str, str]]:
    """The name and the entry point of each console script of a folder. Raises what its `setup.py` raises."""
    import_module("setuptools")  # provides distutils
    run_setup = import_module("distutils.core").run_setup
    os.chdir(folder)
    sys.path[0] = folder
    distribution = run_setup(_SETUP, script_args=[], stop_after="config")
    points = distribution.entry_points or {}
    if isinstance(points, str):
        parser = configparser.ConfigParser(delimiters=("=",), interpolation=None)
        parser.optionxform = str  # type: ignore[assignment, method-assign]
        parser.read_string(points)
        return [*parser.items(_GROUP)] if parser.has_section(_GROUP) else []
    lines = points.get(_GROUP, [])
    lines = lines.splitlines() if isinstance(lines, str) else lines
    pairs = (line.partition("=") for line in lines if "=" in line)
    return [(name.strip(), point.partition("[")[0].strip()) for name, _, point in pairs]


if __name__ == "__main__":
    main(sys.argv[1:])
