"""The command of the benchmarks: what is missing, and what is broken."""

from __future__ import annotations

import importlib

import pytest

from benchmarks.lib import command


def fail_import(monkeypatch: pytest.MonkeyPatch, name: str) -> None:
    def import_module(_module: str) -> None:
        raise ModuleNotFoundError(name=name)

    monkeypatch.setattr(importlib, "import_module", import_module)


def test_a_missing_package_of_others_has_an_exit_code(monkeypatch, capsys) -> None:
    fail_import(monkeypatch, "rclpy.node")
    assert command.run("start", ["--help"]) == command.MISSING
    out, err = capsys.readouterr()
    assert err == "missing module: rclpy\n"
    assert "Needs ROS." in out


def test_a_missing_module_of_this_repository_is_a_defect(monkeypatch) -> None:
    fail_import(monkeypatch, "thymio_sim_ros.sim.gone")
    with pytest.raises(ModuleNotFoundError):
        command.run("start", [])


@pytest.mark.process
def test_a_missing_program_has_an_exit_code(monkeypatch, capsys) -> None:
    page = pytest.importorskip("benchmarks.page", exc_type=ModuleNotFoundError)
    monkeypatch.setattr(page, "CHROMIUM", None)
    assert command.run("page", ["--quick"]) == command.MISSING
    assert capsys.readouterr().err == "missing program: chromium\n"


def test_the_list_of_benchmarks_has_a_line_for_each(capsys) -> None:
    with pytest.raises(SystemExit):
        command.main(["--help"])
    out = capsys.readouterr().out
    assert all(f"\n  {name} " in out for name in command.names())
