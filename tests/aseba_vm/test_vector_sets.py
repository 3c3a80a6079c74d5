"""``--vectors DIR`` runs another set instead of the default one, in every engine."""

from __future__ import annotations

import gzip
import json
import subprocess
import sys
from itertools import pairwise
from pathlib import Path

import pytest

from tests.aseba_vm.engines import AVAILABLE
from tests.aseba_vm.vectors import SHIPPED, is_set, load
from tests.patience import PROGRAM_S

ROOT = Path(__file__).parents[2]


def lines(name, count):
    text = gzip.decompress((SHIPPED / f"{name}.jsonl.gz").read_bytes()).decode("utf-8")
    return text.splitlines()[:count]


def run(folder):
    """Run the vector tests on a folder; return the exit code and the numbers of passed and failed tests."""
    command = [
        sys.executable,
        "-m",
        "pytest",
        "-q",
        "-p",
        "no:cacheprovider",
        "tests/aseba_vm/test_vectors.py",
    ]
    ended = subprocess.run(
        [*command, "--vectors", str(folder)], cwd=ROOT, capture_output=True, text=True, timeout=PROGRAM_S, check=False
    )
    words = ended.stdout.splitlines()[-1].replace(",", "").split() if ended.stdout else []
    counts = {word: int(number) for number, word in pairwise(words) if number.isdigit()}
    return ended.returncode, counts.get("passed", 0), counts.get("failed", 0)


@pytest.mark.slow
@pytest.mark.process
def test_any_part_of_a_set_is_run_plain_or_compressed(tmp_path):
    (tmp_path / "aseba-compile.jsonl").write_text("\n".join(lines("aseba-compile", 5)), "utf-8")
    (tmp_path / "aseba-errors-more.jsonl.gz").write_bytes(gzip.compress("\n".join(lines("aseba-errors", 4)).encode()))
    (tmp_path / "aseba-execution-hidden.jsonl").write_text("\n".join(lines("aseba-execution", 3)), "utf-8")
    (tmp_path / "aseba-execution-hidden-2x.jsonl").write_text("\n".join(lines("aseba-execution-2x", 2)), "utf-8")
    engines = len(AVAILABLE) + 1
    own = 1  # the test of the target
    assert run(tmp_path) == (0, 5 + 4 + (3 + 2) * engines + own, 0)


@pytest.mark.process
def test_a_wrong_answer_in_a_set_is_found_in_every_engine(tmp_path):
    vector = json.loads(lines("aseba-execution", 1)[0])
    vector["expect"][-1]["memory_crc"] ^= 1
    (tmp_path / "aseba-execution.jsonl").write_text(json.dumps(vector), "utf-8")
    code, _, failed = run(tmp_path)
    assert (code, failed) == (1, len(AVAILABLE) + 1)


@pytest.mark.slow
@pytest.mark.process
def test_a_folder_without_vectors_is_refused(tmp_path):
    assert run(tmp_path)[0] != 0
    assert not is_set(tmp_path)


@pytest.mark.parametrize("name", ["aseba-execution", "aseba-execution-2x"])
def test_files_of_the_fork_are_read(name):
    assert {vector["id"] for vector in load(name)} == {json.loads(line)["id"] for line in lines(name, None)}
