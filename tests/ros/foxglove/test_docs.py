"""docs/foxglove.md lists the parameters that the bridge declares."""

from __future__ import annotations

import dataclasses
import re
from pathlib import Path

from thymio_sim_ros.ros.foxglove.assets import ASSETS
from thymio_sim_ros.ros.foxglove.options import READ_ONLY_SERVICES, FoxgloveParams

PAGE = (Path(__file__).parents[3] / "docs" / "foxglove.md").read_text(encoding="utf-8")


def default_of(value):
    """A default value as the page shows it."""
    if value == (ASSETS,):
        return "files of 3D models and images"
    if value == READ_ONLY_SERVICES:
        return "services of this project that only read"
    if isinstance(value, tuple):
        value = ", ".join(filter(None, value))
    text = str(value).lower() if isinstance(value, bool) else str(value)
    return f"`{text}`" if text else ""


def row(item):
    """One parameter as a row of the page's table."""
    return f"| `{item.name}` | {default_of(getattr(FoxgloveParams(), item.name))} | {item.metadata['options'].text} |"


def test_the_table_of_parameters_is_the_declaration():
    expected = [row(item) for item in dataclasses.fields(FoxgloveParams)]
    found = re.findall(r"^\| `\w+` \|.*$", PAGE.partition("## Parameters")[2].partition("## Limits")[0], re.MULTILINE)
    assert found[:-1] == expected
    assert found[-1].startswith("| `use_sim_time` |")
