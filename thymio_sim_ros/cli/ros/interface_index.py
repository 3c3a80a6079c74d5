"""The definitions of interfaces as an installation has them, for one run of `ros2 interface` on the embedded graph."""

from __future__ import annotations

import contextlib
import os
import sys
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path

from thymio_sim_ros.cli.ros.workspace import add_to_path, packages
from thymio_sim_ros.portable_ros.messages.definition_text import DefinitionError
from thymio_sim_ros.portable_ros.messages.interface_files import PACKAGES, interfaces, is_package
from thymio_sim_ros.portable_ros.source_packages import INDEX, PREFIXES

__all__ = ["installed_interfaces"]


@contextlib.contextmanager
def installed_interfaces() -> Iterator[None]:
    """Let the tools find the interfaces that nodes can use: those of the embedded graph and of the workspace.

    They look for files in the folders of `AMENT_PREFIX_PATH`. A package of the workspace with a wrong file is reported
    and left out. The folder is removed at the end.
    """
    add_to_path()
    own = (one.name for one in packages(Path.cwd()))
    with tempfile.TemporaryDirectory(prefix="thymio_sim_ros2_", ignore_cleanup_errors=True) as folder:
        for package in sorted(filter(is_package, {*PACKAGES, *own})):
            try:
                _write(Path(folder), package, interfaces(package))
            except DefinitionError as error:
                print(f"thymio-sim ros2: {error}; the interfaces of {package} are left out", file=sys.stderr)
        os.environ[PREFIXES] = os.pathsep.join(filter(None, [folder, os.environ.get(PREFIXES)]))
        yield


def _write(prefix: Path, package: str, texts: Mapping[str, str]) -> None:
    """Write the definitions of a package, by `msg/Name` and the like, and its entries in the index."""
    files = {f"{name}.{name.partition('/')[0]}": text for name, text in texts.items()}
    entries = {Path("packages", package): "", Path("rosidl_interfaces", package): "".join(f"{one}\n" for one in files)}
    contents = {INDEX / entry: text for entry, text in entries.items()}
    contents |= {Path("share", package, file): text for file, text in files.items()}
    for name, text in contents.items():
        path = prefix / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
