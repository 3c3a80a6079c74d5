"""Programs of blocks open wherever programs open, converted by the code of the page."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from tests.network.http.test_gateway import Bench
from thymio_sim_ros.cli.main import main
from thymio_sim_ros.device.programs.program_assignment import RobotId
from thymio_sim_ros.files import block_files, resources
from thymio_sim_ros.files.block_files import BlocksError, is_of_blocks, open_program
from thymio_sim_ros.files.loading import read_text
from thymio_sim_ros.files.resources import ResourceError
from thymio_sim_ros.testing.sources import programs_of

DATA = Path(__file__).parents[1] / "data" / "web" / "blockly"
WORKSPACE = DATA / "follow_line.xml"
EXPECTED = (DATA / "follow_line.aseba").read_text(encoding="utf-8")

pytestmark = [pytest.mark.process, pytest.mark.usefixtures("scratch_project")]


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig", "utf-16"])
def test_a_workspace_becomes_the_program_that_the_page_shows(tmp_path: Path, encoding: str) -> None:
    path = tmp_path / "line.xml"
    path.write_text(WORKSPACE.read_text(encoding="utf-8"), encoding=encoding)
    (program,) = programs_of(path, {"thymio": RobotId("", 1)}).values()
    assert program.name == "line.xml"
    assert program.source.split() == EXPECTED.split()


def test_a_workspace_may_be_a_text() -> None:
    (program,) = programs_of(WORKSPACE.read_text(encoding="utf-8"), {"thymio": RobotId("", 1)}).values()
    assert program.source.split() == EXPECTED.split()


def test_a_scratch_project_runs_and_says_what_was_left_out(
    tmp_path: Path, scratch_project: bytes, capsys: pytest.CaptureFixture[str], caplog: pytest.LogCaptureFixture
) -> None:
    path = tmp_path / "follower.sb3"
    path.write_bytes(scratch_project)
    assert main(["runner", "--program", str(path), "--seconds", "0.1"]) == 0
    assert json.loads(capsys.readouterr().out)["seconds"] == 0.1
    assert "follower.sb3: left out: looks_sayforsecs (1 times)" in caplog.text


def test_a_scratch_project_is_loaded_over_http(scratch_project: bytes) -> None:
    reply = Bench("").ask("PUT", "/nodes", scratch_project)
    assert (reply.status, reply.body) == (200, b"left out: looks_sayforsecs (1 times)\n")


def test_a_damaged_project_is_an_error(tmp_path: Path, scratch_project: bytes) -> None:
    path = tmp_path / "follower.sb3"
    path.write_bytes(scratch_project.replace(b'"targets"', b'"tarjets"'))
    with pytest.raises(ResourceError, match=r"follower\.sb3: .*project\.json"):
        read_text(str(path))


def test_blocks_with_a_mistake_do_not_run() -> None:
    call = '<block type="procedures_callnoreturn" x="0" y="0"><mutation name="turn"/></block>'
    with pytest.raises(BlocksError, match="There is no subroutine called turn"):
        open_program(f"<xml>{call}</xml>".encode())


def test_without_node_the_error_says_what_to_do(
    tmp_path: Path, scratch_project: bytes, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.setattr(block_files.importlib.util, "find_spec", lambda name: None)
    with pytest.raises(BlocksError, match=r"Scratch project; open .* on the page .*; or install Node"):
        open_program(scratch_project)
    monkeypatch.undo()
    monkeypatch.setattr(resources, "page", lambda: None)
    with pytest.raises(BlocksError, match="make web"):
        open_program(scratch_project)


def test_only_blocks_without_a_text_are_converted(scratch_project: bytes) -> None:
    assert is_of_blocks(scratch_project)
    assert is_of_blocks(WORKSPACE.read_bytes())
    assert not any(
        map(is_of_blocks, (b"", b"var a", b"<network></network>", b"<html></html>", b"\x89PNG", b"PK\x03\x04"))
    )
