"""`thymio-sim ros2` without the tools, and their installation."""

from __future__ import annotations

import importlib.util
import subprocess
from typing import Any
from urllib.error import URLError

import pytest

from thymio_sim_ros.cli import main
from thymio_sim_ros.cli.ros import ros2_installation

INSTEAD = "without it, use `thymio-sim topic`, `node`, `service`, `param`, `action` and `interface`\n"


@pytest.fixture(autouse=True)
def installed(monkeypatch: pytest.MonkeyPatch) -> set[str]:
    """The modules that are installed."""
    made: set[str] = set()
    monkeypatch.setattr(importlib.util, "find_spec", lambda name: name if name in made else None)
    return made


@pytest.mark.parametrize(
    ("command", "there", "missing"),
    [("topic list", [], "ros2cli"), ("launch lesson a.launch.py", ["ros2cli"], "ros2launch")],
)
def test_missing_tools_are_named_with_their_cure(
    installed: set[str], command: str, there: list[str], missing: str, capsys: pytest.CaptureFixture[str]
) -> None:
    installed.update(there)
    assert main.main(["ros2", *command.split()]) == 2
    assert capsys.readouterr().err == (
        f"thymio-sim: ros2: found no {missing}, expected it: `thymio-sim ros2 --install` installs it; " + INSTEAD
    )


def test_sources_that_cannot_be_reached_are_said_before_anything_is_installed(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def refuse(*_words: object, **_options: object) -> None:
        raise URLError("no route")

    monkeypatch.setattr(ros2_installation, "urlopen", refuse)
    monkeypatch.setattr(subprocess, "run", lambda *_words, **_options: pytest.fail("pip was called"))
    assert main.main(["ros2", "--install"]) == 1
    assert capsys.readouterr().err == (
        f"thymio-sim ros2: cannot be installed: https://github.com cannot be reached (no route); {INSTEAD}"
    )


@pytest.mark.parametrize(
    ("code", "errors", "said"),
    [(0, "", ""), (1, "ERROR: one\nERROR: two\nhint\n", f"thymio-sim ros2: cannot be installed: two; {INSTEAD}")],
)
def test_the_tools_are_installed_by_pip(
    code: int, errors: str, said: str, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    calls: list[list[str]] = []

    def run(words: list[str], **_options: Any) -> subprocess.CompletedProcess[str]:
        calls.append(words)
        return subprocess.CompletedProcess(words, code, "", errors)

    monkeypatch.setattr(ros2_installation, "_unreachable", lambda _url: "")
    monkeypatch.setattr(subprocess, "run", run)
    assert main.main(["ros2", "--install"]) == code
    assert capsys.readouterr().err == said
    assert "psutil" in calls[0]
    if not code:
        sources = dict(word.split(" @ ") for word in calls[1] if " @ " in word)
        github = "https://github.com/ros2"
        tools = f"{github}/ros2cli/archive/refs/tags/0.32.2.tar.gz"
        assert sources["ros2topic"] == f"{tools}#subdirectory=ros2topic"
        assert sources["rosidl_runtime_py"] == f"{github}/rosidl_runtime_py/archive/refs/tags/0.13.1.tar.gz"
        assert {"ros2launch", "launch_ros", "launch", "launch_xml", "launch_yaml", "ament_copyright"} < set(sources)


def test_an_installation_of_an_older_version_is_completed(installed: set[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(ros2_installation, "install", lambda: 7)
    installed.update(("ros2cli", "ros2topic"))
    assert main.main(["ros2", "--install"]) == 7
    installed.update(ros2_installation._MODULES)
    assert main.main(["ros2", "--install"]) == 0
