"""SVG is drawn in a process of its own, which a picture cannot make last or grow."""

from __future__ import annotations

import os
import subprocess
import sys
import types
from pathlib import Path

import pytest

from tests.patience import PATIENCE_S
from thymio_sim_ros.sim.formats import svg_process, svg_worker
from thymio_sim_ros.sim.formats.svg_process import DrawError

resvg = pytest.importorskip("resvg_py")

HEAD = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 100" width="{side}" height="{side}">'
PLAIN = HEAD.format(side=20) + '<rect width="50" height="50" fill="#808080"/></svg>'
LAYERS = HEAD.format(side=2400) + '<g opacity=".5"><rect width="100" height="100"/></g>' * 1000 + "</svg>"
"""A thousand layers of 23 MB, one after the other: a minute of drawing."""
NESTED = HEAD.format(side=2400) + '<g opacity=".5">' * 40 + '<rect width="100" height="100"/>' + "</g>" * 40 + "</svg>"
"""Forty layers at once: 920 MB."""


def refused(text: str, seconds: float = 2.0) -> DrawError:
    with pytest.raises(DrawError) as caught:
        svg_process.draw(text, resvg, seconds=seconds)
    return caught.value


def test_the_process_draws_what_the_package_draws() -> None:
    drawn, seconds = svg_process.draw(PLAIN, resvg, seconds=30.0)
    assert drawn == resvg.svg_to_bytes(svg_string=PLAIN, dpi=svg_worker.CSS_DPI, skip_system_fonts=True)
    assert 0.0 < seconds < 30.0


def test_an_image_that_takes_too_long_is_refused_in_time() -> None:
    error = refused(LAYERS, seconds=0.5)
    assert (error.found, error.expected) == (
        "SVG images that take longer than 2 s to draw",
        "simpler SVG images, or PNG images",
    )


def test_no_process_is_started_when_no_time_is_left(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(subprocess, "run", None)
    assert "2 s" in refused(PLAIN, seconds=0.0).found


@pytest.mark.skipif(sys.platform != "linux", reason="memory is limited on Linux")
def test_an_image_that_takes_too_much_memory_is_refused() -> None:
    assert "512 MB" in refused(NESTED, seconds=30.0).expected


@pytest.mark.skipif(sys.platform == "win32", reason="processor time is limited on POSIX")
def test_the_process_limits_its_own_processor_time() -> None:
    assert "2 s" in refused(LAYERS, seconds=1.0).found


def test_the_time_of_a_picture_is_processor_time(tmp_path: Path) -> None:
    (tmp_path / "resvg_py").mkdir()
    module = tmp_path / "resvg_py" / "__init__.py"
    module.write_text("import time\ndef svg_to_bytes(**_: object) -> bytes:\n    time.sleep(2.0)\n    return b''\n")
    waiting = types.ModuleType("resvg_py")
    waiting.__file__ = str(module)
    assert svg_process.draw(PLAIN, waiting, seconds=30.0)[1] < 2.0  # in which it slept


def test_a_broken_image_is_refused_with_the_reason() -> None:
    error = refused("<svg")
    assert error.found.startswith("an SVG that cannot be drawn (")


@pytest.mark.parametrize("executable", ["", "/usr/bin/blender", "C:\\Program Files\\studio.exe"])
def test_a_program_that_embeds_python_is_not_started(monkeypatch: pytest.MonkeyPatch, executable: str) -> None:
    monkeypatch.setattr(sys, "executable", executable)
    monkeypatch.setattr(subprocess, "run", None)
    error = refused(PLAIN)
    assert "a program that embeds Python" in error.found
    assert "PNG" in error.expected


def test_an_interpreter_that_is_gone_is_reported(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    monkeypatch.setattr(sys, "executable", str(tmp_path / "python3"))
    assert "no process could be started" in refused(PLAIN).found


def test_the_worker_imports_neither_the_package_nor_ros() -> None:
    code = (
        "import runpy, sys; sys.argv = ['worker']; runpy.run_path(sys.orig_argv[-1]);"
        "print([name for name in sys.modules if name.split('.')[0] in ('thymio_sim_ros', 'rclpy', 'numpy', 'PIL')])"
    )
    command = [sys.executable, "-I", "-S", "-c", code, svg_worker.__file__]
    assert (
        subprocess.run(command, capture_output=True, text=True, check=True, timeout=PATIENCE_S).stdout.strip() == "[]"
    )


@pytest.mark.process
@pytest.mark.skipif(sys.platform == "win32", reason="closes descriptors of POSIX")
def test_it_draws_without_standard_streams_and_beside_threads(tmp_path: Path) -> None:
    code = f"""
import os, threading, sys
sys.stdin = sys.stdout = sys.stderr = None
for number in range(3):
    os.close(number)
stop = threading.Event()
for _ in range(4):
    threading.Thread(target=stop.wait, daemon=True).start()
import resvg_py
from thymio_sim_ros.sim.formats import svg_process
drawn, _ = svg_process.draw({PLAIN!r}, resvg_py, seconds=30.0)
with open({str(tmp_path / "drawn.png")!r}, "wb") as file:
    file.write(drawn)
os._exit(0)
"""
    environment = os.environ | {"PYTHONPATH": os.pathsep.join(sys.path)}
    subprocess.run([sys.executable, "-c", code], env=environment, check=True, timeout=PATIENCE_S)
    assert (tmp_path / "drawn.png").read_bytes() == svg_process.draw(PLAIN, resvg, seconds=30.0)[0]
