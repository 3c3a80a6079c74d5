"""Targets of the Makefile that do more than call a program."""

import re
import shutil
import subprocess

import pytest

from tests.patience import PATIENCE_S
from tests.syntax import ROOT

pytestmark = pytest.mark.process


@pytest.mark.skipif(shutil.which("make") is None, reason="no make on this machine")
@pytest.mark.parametrize("arguments", [[], ["SEED=5"]])
def test_the_seed_that_is_printed_is_that_of_the_run(arguments: list[str]) -> None:
    command = ["make", "--dry-run", "test-all", *arguments]
    planned = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, timeout=PATIENCE_S, check=True).stdout
    seeds = re.findall(r"(?:seed |seed=|SEED=)(\d+)", planned)
    assert len(seeds) == 3, planned
    assert len(set(seeds)) == 1
