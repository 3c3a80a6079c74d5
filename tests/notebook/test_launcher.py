"""The tile of JupyterLab."""

from __future__ import annotations

import importlib.metadata
from pathlib import Path

import pytest

from thymio_sim_ros.access.tokens import TOKEN_VARIABLE
from thymio_sim_ros.cli import suite
from thymio_sim_ros.notebook.launcher import launcher


def test_jupyter_server_proxy_finds_the_tile() -> None:
    (found,) = importlib.metadata.entry_points(group="jupyter_serverproxy_servers", name="thymio")
    assert found.load() is launcher


def test_the_suite_gets_a_token_that_only_the_tile_knows() -> None:
    first, second = launcher(), launcher()
    token = first["environment"][TOKEN_VARIABLE]
    assert len(token) > 20
    assert first["launcher_entry"]["path_info"] == f"thymio/?token={token}"
    assert second["environment"][TOKEN_VARIABLE] != token
    assert token not in " ".join(first["command"])


def test_a_container_of_one_user_opens_without_a_tile(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("BINDER_LAUNCH_HOST", "https://mybinder.org/")
    found = launcher()
    assert found["launcher_entry"]["path_info"] == "thymio/"
    assert found["environment"] == {}


def test_the_options_are_those_of_the_suite() -> None:
    command = [word.format(port=8123) for word in launcher()["command"]]
    options = suite._parser().parse_args(command[3:])
    assert options.port == 8123


def test_the_tile_has_a_picture_if_the_page_is_built() -> None:
    icon = launcher()["launcher_entry"].get("icon_path")
    assert icon is None or Path(icon).suffix == ".svg"
