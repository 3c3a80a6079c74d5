"""Packages that course files import and that have no Python wheels: `tf2_ros`, `tf_transformations` and their kind.

Each folder in `packages` is a package with the name and the names of the original; its content is in
`thymio_sim_ros.tf` and `ros/compat`. `packages` is the last entry of `sys.path` wherever nodes of students run, so that
an installed package and a file beside the node have priority. Code of this project imports these names only if
`is_installed` confirms that they are installed packages.
"""

from __future__ import annotations

import importlib.util
import sys
from pathlib import Path

from thymio_sim_ros.portable_ros.import_hook import is_served

__all__ = ["STARTUP", "add_to_path", "is_installed"]

_FOLDER = Path(__file__).parent / "packages"
STARTUP = _FOLDER.with_name("startup")
"""The folder for PYTHONPATH that makes each Python program do what `add_to_path` does."""

_INSTALLED = {"site-packages", "dist-packages"}


def add_to_path() -> None:
    """Make the packages importable in this process where no others of the same names are."""
    if str(_FOLDER) not in sys.path:
        sys.path.append(str(_FOLDER))


def is_installed(name: str) -> bool:
    """Whether `import name` finds an installed package, or one of the embedded graph: not one of the packages here, nor
    a file of a student."""
    if is_served(name):
        return True
    try:
        spec = importlib.util.find_spec(name)
    except (ImportError, ValueError):  # ValueError: a module that was not imported in the usual way
        return False
    if spec is None or spec.origin is None:
        return False
    place = Path(spec.origin)
    return not place.is_relative_to(_FOLDER) and not _INSTALLED.isdisjoint(place.parts)
