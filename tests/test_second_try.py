"""Tests that pass only when they run again are named at the end."""

import pytest

CASES = """
import pytest

count = 0

@pytest.mark.flaky(reruns=1)
def test_by_chance():
    global count
    count += 1
    assert count == 2

def test_as_always():
    pass
"""


def test_what_passed_only_at_the_second_try_is_named(
    pytester: pytest.Pytester, pytestconfig: pytest.Config, monkeypatch: pytest.MonkeyPatch
) -> None:
    if not pytestconfig.pluginmanager.hasplugin("rerunfailures"):
        pytest.skip("needs pytest-rerunfailures")
    monkeypatch.syspath_prepend(pytestconfig.rootpath)
    pytester.makeconftest("from tests.conftest import pytest_terminal_summary")
    pytester.makepyfile(CASES)
    result = pytester.runpytest("-p", "no:xdist", "-p", "no:thymio_sim_ros")
    result.assert_outcomes(passed=2)
    result.stdout.re_match_lines(["=+ passed only at the second try.*", r"test_what.*\.py::test_by_chance"])
    result.stdout.no_re_match_line("test_what.*::test_as_always$")
