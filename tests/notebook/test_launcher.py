"""The tile of JupyterLab."""

from __future__ import annotations

import importlib.metadata
import os
import subprocess
import sys
from pathlib import Path

import pytest

from tests.patience import PROGRAM_S
from tests.processes import free_port
from thymio_sim_ros.access.tokens import TOKEN_VARIABLE
from thymio_sim_ros.cli import suite
from thymio_sim_ros.notebook.launcher import launcher

READY = """
import sys
from thymio_sim_ros.cli.main import main
from thymio_sim_ros.ros import combined
combined.run = lambda *arguments, on_ready: on_ready() or 0
sys.exit(main())
"""
"""A suite that is ready and ends at once."""


def test_jupyter_server_proxy_finds_the_tile() -> None:
    (found,) = importlib.metadata.entry_points(group="jupyter_serverproxy_servers", name="thymio")
    assert found.load() is launcher


def test_the_suite_gets_a_token_that_only_the_tile_knows() -> None:
    first, second = launcher(), launcher()
    token = first["environment"][TOKEN_VARIABLE]
    assert len(token) > 20
    assert first["launcher_entry"]["path_info"] == f"thymio/#token={token}"
    assert second["environment"][TOKEN_VARIABLE] != token
    assert token not in " ".join(first["command"])


@pytest.mark.process
def test_the_suite_prints_no_token_into_the_log_of_jupyter() -> None:
    found = launcher()
    arguments = [word.format(port=free_port()) for word in found["command"][3:]]
    done = subprocess.run(
        [sys.executable, "-c", READY, *arguments],
        env={**os.environ, **found["environment"]},
        capture_output=True,
        text=True,
        timeout=PROGRAM_S,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert found["environment"][TOKEN_VARIABLE] not in done.stdout + done.stderr


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
