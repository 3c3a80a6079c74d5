"""A suite of a notebook."""

from __future__ import annotations

import json
import os
import signal
import socket
import subprocess
import sys
from pathlib import Path

import pytest

from tests.patience import PROGRAM_S, until

pytestmark = pytest.mark.process

ROOT = Path(__file__).parents[2]
NOTEBOOK = json.loads((ROOT / "docs" / "drive.ipynb").read_text(encoding="utf-8"))
CELLS = ["".join(cell["source"]) for cell in NOTEBOOK["cells"] if cell["cell_type"] == "code"]


def run(program: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, timeout=PROGRAM_S, check=False
    )


def test_the_cells_of_the_page_on_jupyter_drive_the_robot() -> None:
    done = run("\n".join([*CELLS[:-1], "print(poses[-1].x - poses[0].x, suite.view()._repr_html_())", CELLS[-1]]))
    assert done.returncode == 0, done.stderr
    moved, _, view = done.stdout.splitlines()[-1].partition(" ")
    assert float(moved) > 0.02
    assert "/#token=" in view


def test_arguments_that_the_suite_refuses_are_said_and_nothing_remains() -> None:
    program = """
from thymio_sim_ros.notebook import Suite
from thymio_sim_ros.notebook.suite import SuiteError
try:
    Suite("--playground", "no_such")
except SuiteError as error:
    print(error)
"""
    done = run(program)
    assert "the suite has not started" in done.stdout, done.stderr
    assert "no_such" in done.stdout


def test_the_suite_ends_with_its_notebook_however_that_ends() -> None:
    program = (
        "import sys, time; from thymio_sim_ros.notebook import Suite; print(Suite().port, flush=True); time.sleep(999)"
    )
    with subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, text=True) as notebook:
        assert notebook.stdout is not None
        port = int(notebook.stdout.readline())
        os.kill(notebook.pid, signal.SIGKILL)

    def is_closed() -> bool:
        with socket.socket() as client:
            return client.connect_ex(("127.0.0.1", port)) != 0

    until(is_closed)
