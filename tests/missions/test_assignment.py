"""A mission as an assignment: the test of docs/missions.md."""

from __future__ import annotations

import shutil
from pathlib import Path

import pytest

from tests import pages
from tests.patience import PROGRAM_S

LESSON = Path(__file__).parents[2] / "docs" / "course" / "3-blocks"


@pytest.mark.process
@pytest.mark.parametrize(("program", "passed", "failed"), [("solution", 2, 0), ("start", 0, 2)])
def test_stars_are_points(pytester: pytest.Pytester, program: str, passed: int, failed: int) -> None:
    (example,) = pages.blocks(pages.read("missions.md"), "python")
    pytester.makepyfile(test_bus=example)
    for name in ("bus.json", "mission.json"):
        shutil.copy(LESSON / name, pytester.path)
    shutil.copy(LESSON / "programs" / f"{program}.aesl", pytester.path / "bus.aesl")
    result = pytester.runpytest_subprocess("-p", "no:cacheprovider", timeout=PROGRAM_S)
    result.assert_outcomes(passed=passed, failed=failed)
