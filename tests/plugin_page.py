"""The package of docs/plugins.md, taken from the page and laid out as an installed one."""

from __future__ import annotations

import re
import sys
import tomllib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from thymio_sim_ros.device import behavior_host, bindings, layout
from thymio_sim_ros.files import registry

PAGE = Path(__file__).parents[1] / "docs" / "plugins.md"
_BLOCK = re.compile(r"^\*\*`([^`]+)`\*\*\n\n```\w+\n(.*?)^```$", re.DOTALL | re.MULTILINE)


def files() -> dict[str, str]:
    """Name → text of every file that the page shows."""
    return dict(_BLOCK.findall(PAGE.read_text()))


def lay_out(folder: Path, shown: dict[str, str]) -> None:
    """Write the files, and beside them what pip would write about the package."""
    for name, text in shown.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    project = tomllib.loads(shown["pyproject.toml"])["project"]
    (folder / project["name"] / "__init__.py").write_text("")
    about = folder / f"{project['name']}-{project['version']}.dist-info"
    about.mkdir()
    (about / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {project['name']}\nVersion: {project['version']}\n")
    groups = project["entry-points"]
    lines = [f"[{group}]\n" + "".join(f"{k} = {v}\n" for k, v in entries.items()) for group, entries in groups.items()]
    (about / "entry_points.txt").write_text("\n".join(lines))


@contextmanager
def installed(folder: Path, shown: dict[str, str], monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    """The package as if pip had installed it, for a while."""
    lay_out(folder, shown)
    with monkeypatch.context() as patch:
        patch.syspath_prepend(str(folder))
        _forget()
        try:
            yield
        finally:
            patch.undo()
            for name in [name for name in sys.modules if name.split(".")[0] == "thymio_extras"]:
                del sys.modules[name]
            _forget()


def _forget() -> None:
    """Whatever was derived from the plug-ins that there were."""
    registry.clear_cache()
    for cached in (bindings.sensors, bindings.outputs, bindings.natives, bindings.at_reset, layout.target,
                   layout.compatible_plugins, behavior_host.built_in):  # fmt: skip
        cached.cache_clear()
