"""`aseba compile` and `aseba dis`: words, JSON, stages, listing."""

import json
import os
import subprocess

import pytest

from aseba_vm.cli.main import main
from tests.aseba_vm.cli.samples import AESL, ASEBA, GOOD


def test_a_program_is_written_as_words(file, capsys):
    assert main(["compile", file("var n = 1")]) == 0
    assert capsys.readouterr().out.split() == ["0003", "ffff", "0003", "1001", "4080", "0000"]


def test_a_program_is_written_as_json(file, tmp_path):
    output = tmp_path / "out.json"
    assert main(["compile", file("var n = 1"), "--format", "json", "-o", str(output)]) == 0
    data = json.loads(output.read_text("utf-8"))
    assert data["words"] == [3, 65535, 3, 0x1001, 0x4080, 0]
    assert data["variables"] == [["n", 128, 1]]


@pytest.mark.parametrize("stage", ["tokens", "tree", "expanded", "optimized", "optimised", "code", "words"])
def test_every_stage_can_be_shown(stage, file, capsys):
    assert main(["dis", file(GOOD), "--global", "ping=1", "--stage", stage]) == 0
    assert capsys.readouterr().out.strip()


def test_a_program_is_written_as_a_listing(file, capsys):
    assert main(["compile", file("var n = 1"), "--format", "listing"]) == 0
    assert "push 1" in capsys.readouterr().out


def test_the_listing_shows_lines_names_and_use(file, capsys):
    name = file(AESL.format(code="START + 1"), "robot.aesl")
    assert main(["compile", name, "--format", "listing"]) == 0
    shown = capsys.readouterr().out
    assert "onevent ping" in shown
    assert "store 128 (n)" in shown
    assert "|    7  n = START + 1" in shown
    assert "of  1534 words" in shown


@pytest.mark.process
@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="no /dev/full here")
def test_a_full_disk_is_reported_with_the_name_of_the_output(file, capsys):
    name = file(GOOD.replace("ping", "timer0").replace("emit timer0 n\n", ""))
    assert main(["compile", name, "-o", "/dev/full"]) == 2
    assert capsys.readouterr().err == "aseba: /dev/full: No space left on device\n"
    with open("/dev/full", "w") as full:
        ended = subprocess.run([*ASEBA, "dis", name], stdout=full, stderr=subprocess.PIPE, text=True, check=False)
    assert (ended.returncode, ended.stderr) == (2, "aseba: standard output: No space left on device\n")
