"""`thymio-sim ros2` without the tools, and their installation."""

from __future__ import annotations

import importlib.util
import subprocess
from urllib.error import URLError

import pytest

from thymio_sim_ros.cli import main, ros2

INSTEAD = "without it, use `thymio-sim topic`, `node`, `service`, `param`, `action` and `interface`\n"


@pytest.fixture(autouse=True)
def _not_installed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(importlib.util, "find_spec", lambda _name: None)


def test_missing_tools_are_named_with_their_cure(capsys: pytest.CaptureFixture[str]) -> None:
    assert main.main(["ros2", "topic", "list"]) == 2
    assert capsys.readouterr().err == (
        "thymio-sim: ros2: found no ros2cli, expected it: `thymio-sim ros2 --install` installs it; " + INSTEAD
    )


def test_sources_that_cannot_be_reached_are_said_before_anything_is_installed(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def refuse(*_words: object, **_options: object) -> None:
        raise URLError("no route")

    monkeypatch.setattr(ros2, "urlopen", refuse)
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

    def run(words: list[str], **_options: object) -> subprocess.CompletedProcess[str]:
        calls.append(words)
        return subprocess.CompletedProcess(words, code, "", errors)

    monkeypatch.setattr(ros2, "_unreachable", lambda _url: "")
    monkeypatch.setattr(subprocess, "run", run)
    assert main.main(["ros2", "--install"]) == code
    assert capsys.readouterr().err == said
    assert "psutil" in calls[0]
    if not code:
        assert calls[1][-1].startswith("ros2topic @ https://github.com/ros2/ros2cli/")
