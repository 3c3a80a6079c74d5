"""Where packages of users are: in source folders beside their programs, and in folders of `AMENT_PREFIX_PATH`.

A package is a folder of its name. It is looked for in each folder from which Python imports modules, such as that of
the program, and in each folder above one of these; so a program of a workspace finds all packages of the workspace
without an installation. The folder of the program, and those above it, may also be a package of another folder name, if
their `package.xml` has the name. Last come the source folders that prefixes name as resources, such as those of
`thymio-sim ros2 run` for all packages of a workspace.
"""

from __future__ import annotations

import os
import re
import sys
from collections.abc import Iterator
from functools import cache
from pathlib import Path

__all__ = [
    "INDEX",
    "MANIFEST",
    "PREFIXES",
    "SOURCES",
    "declared_name",
    "installed_folder",
    "prefixes",
    "source_folders",
]

PREFIXES = "AMENT_PREFIX_PATH"
"""The variable with the folders of installed packages."""
MANIFEST = "package.xml"
INDEX = Path("share", "ament_index", "resource_index")
"""The resources of a prefix: a folder for each type."""
SOURCES = "source_folder"
"""The type of resources whose files, named by packages, contain the paths of source folders, in UTF-8."""
_NAME = re.compile(r"<name>\s*(\S+?)\s*</name>")


def source_folders(name: str) -> Iterator[Path]:
    """Folders that may be a package, the nearest first; a caller checks what it needs of them."""
    places = (Path(place or ".").absolute() for place in sys.path)
    for folder in dict.fromkeys(one for place in places for one in (place, *place.parents)):
        yield folder / name
        if declared_name(folder) == name:
            yield folder
    for file in (prefix / INDEX / SOURCES / name for prefix in prefixes()):
        if file.is_file():
            yield Path(file.read_text(encoding="utf-8"))


def prefixes() -> list[Path]:
    """The folders of installed packages: those of the environment, and that of Python."""
    named = [Path(one) for one in os.environ.get(PREFIXES, "").split(os.pathsep) if one]
    return [one for one in dict.fromkeys((*named, Path(sys.prefix))) if one.is_dir()]


def installed_folder(name: str) -> Path | None:
    """The share folder of an installed package, None without one."""
    folders = (prefix / "share" / name for prefix in prefixes())
    return next((folder for folder in folders if (folder / MANIFEST).is_file()), None)


@cache
def declared_name(folder: Path) -> str:
    """The name in the manifest of a folder, empty without one."""
    try:
        text = (folder / MANIFEST).read_text(encoding="utf-8", errors="replace")
    except OSError:
        return ""
    found = _NAME.search(text)
    return found[1] if found else ""
