"""The location of a program: a file, a module, or an executable of a package."""

from __future__ import annotations

import importlib.metadata
import os
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from thymio_sim_ros.testing.ros.student_errors import StudentError
from thymio_sim_ros.testing.sources import beside

__all__ = ["Target", "find"]


@dataclass(frozen=True, slots=True)
class Target:
    """A program that was found; `options` are some of `lockstep.main.Options`."""

    title: str
    options: dict[str, Any]


def find(source: str | Path, executable: str, folder: Path | None) -> Target:
    """Find a program; relative paths start in `folder`.

    Raises StudentError if there is none, with the places that were searched.
    """
    here = (Path() if folder is None else folder).absolute()
    if executable:
        return _executable(str(source), executable, here)
    path = Path(beside(str(source), folder)).absolute()
    if path.is_file():
        return Target(path.name, {"file": str(path), "folder": str(path.parent)})
    if path.suffix == ".py" or os.sep in str(source):
        raise StudentError(f"{source}: no such file in {here}")
    return Target(f"python -m {source}", {"module": str(source), "folder": str(here)})


def _executable(package: str, executable: str, here: Path) -> Target:
    title = f"{package} {executable}"
    for root in (here, here / package):  # sources that are not installed
        for file in ("setup.py", "setup.cfg"):
            if function := _declared(root / file, executable):
                return Target(title, {"function": function, "folder": str(root)})
    for script in importlib.metadata.entry_points(group="console_scripts"):
        if script.name == executable and script.dist is not None and _same(script.dist.name, package):
            return Target(title, {"function": script.value, "folder": str(here)})
    for path in _installed(package, executable):
        if path.is_file():
            return Target(title, {"file": str(path), "folder": str(path.parent)})
    raise StudentError(
        f"{title}: no such executable: expected it in the entry points of {here / package / 'setup.py'},"
        " of an installed package, or in lib/ of a ROS prefix"
    )


def _declared(file: Path, executable: str) -> str:
    """The function of an entry point in a file of setuptools, or ""."""
    if not file.is_file():
        return ""
    found = re.search(rf"\b{re.escape(executable)}\s*=\s*([\w.]+:\w+)", file.read_text(encoding="utf-8"))
    return found[1] if found else ""


def _same(distribution: str, package: str) -> bool:
    return re.sub(r"[-_.]+", "-", distribution).lower() == re.sub(r"[-_.]+", "-", package).lower()


def _installed(package: str, executable: str) -> Iterator[Path]:
    for prefix in os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep):
        if prefix:
            yield Path(prefix, "lib", package, executable)
