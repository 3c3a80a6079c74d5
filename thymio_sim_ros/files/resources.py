"""Finds the files that are installed with the code: playgrounds, missions, behaviors, the built page.

The same search works in a source tree, a wheel, an editable installation and a colcon workspace: first the source
tree, then `share/thymio_sim_ros` beside the installed code, then the ament prefixes, then the prefix of the interpreter
(docs/spec/ros-packaging.md section 1.1: the wheels leave AMENT_PREFIX_PATH unset).
"""

from __future__ import annotations

import difflib
import os
import sys
from collections.abc import Iterator
from pathlib import Path

from thymio_sim_ros.errors import ThymioSimError
from thymio_sim_ros.files import registry

_PACKAGE = Path(__file__).resolve().parents[1]
_PLAYGROUND_FILES = ("*.json", "*.playground")
_SHARE = Path("share") / "thymio_sim_ros"

PAGE_BUILD_HINT = "The page is not built yet: run `make web` in the source folder, then start again."
"""Hint for the user if the page is not built, as in a colcon workspace."""


class ResourceError(ThymioSimError):
    """A file that is missing or cannot be read; the text has the name or path."""


def _roots() -> Iterator[Path]:
    """Folders that may contain `playgrounds/`, in order of preference."""
    yield _PACKAGE.parent
    for parent in _PACKAGE.parents:
        yield parent / _SHARE
    for prefix in os.environ.get("AMENT_PREFIX_PATH", "").split(os.pathsep):
        if prefix:
            yield Path(prefix) / _SHARE
    yield Path(sys.prefix) / _SHARE


def _folder(*names: str) -> Path | None:
    """The first folder with one of these names below a root, or None."""
    for root in _roots():
        for name in names:
            folder = root / name
            if folder.is_dir():
                return folder
    return None


def playgrounds() -> dict[str, Path]:
    """Files of the shipped playgrounds by name, then those of other packages, each in order of name."""
    folder = _folder("playgrounds")
    return _files([folder] if folder else [], "playgrounds", _PLAYGROUND_FILES)


def missions_folder() -> Path | None:
    """Folder of the shipped missions, or None if they are not installed."""
    folders = (root / "playgrounds" / "missions" for root in _roots())
    return next((folder for folder in folders if (folder / "index.json").is_file()), None)


def behaviours() -> dict[str, Path]:
    """`.aesl` files of the built-in behaviors by name, then those of other packages, each in order of name."""
    return _files([_PACKAGE / "device" / "firmware" / "behaviors"], "behaviours", ("*.aesl",))


def _files(ours: list[Path], group: str, patterns: tuple[str, ...]) -> dict[str, Path]:
    """Files of these folders and of those of other packages, by name; the first file of a name is used."""
    found: dict[str, Path] = {}
    for folder in (*ours, *registry.folders(group)):
        for path in sorted(path for pattern in patterns for path in folder.glob(pattern)):
            if not path.name.endswith(".schema.json"):
                found.setdefault(path.stem, path)
    return found


def find_playground(name: str) -> Path:
    """The file of a shipped playground or of a path. Raises ResourceError if there is neither."""
    return _find(name, playgrounds(), "playground")


def find_program(name: str) -> Path:
    """The file of a built-in behavior or of a path. Raises ResourceError if there is neither."""
    return _find(name, behaviours(), "program")


def check_behaviour(name: str) -> str:
    """The same name. Raises ResourceError if it is neither empty nor that of a built-in behavior."""
    if name and name not in behaviours():
        raise ResourceError(_unknown(name, behaviours(), "behaviour", "not"))
    return name


def page() -> Path | None:
    """Folder of the built web page, or None if it has not been built."""
    for root in _roots():
        for folder in (root / "web_ui" / "dist", root / "web_ui"):
            if (folder / "index.html").is_file() and (folder / "assets").is_dir():
                return folder
    return None


def expanded(text: str) -> Path:
    """Path with `~` expanded; unchanged if the user is unknown."""
    path = Path(text)
    try:
        return path.expanduser()
    except RuntimeError:
        return path


def _find(name: str, shipped: dict[str, Path], kind: str) -> Path:
    if name in shipped:
        return shipped[name]
    path = expanded(name)
    try:
        if path.is_file():
            return path
        if path.is_dir():
            raise ResourceError(f"{kind} '{name}' is a folder; expected a file")
    except OSError as error:  # a folder that cannot be read, a name that is too long
        raise ResourceError(f"{kind} '{name}': {error.strerror}; expected a file that can be read") from error
    raise ResourceError(_unknown(name, shipped, kind, "neither a file nor"))


def _unknown(name: str, shipped: dict[str, Path], kind: str, nor: str) -> str:
    near = difflib.get_close_matches(name, shipped, 1)
    hint = f"; did you mean '{near[0]}'?" if near else ""
    return f"no {kind} '{name}': {nor} one of {', '.join(shipped)}{hint}"
