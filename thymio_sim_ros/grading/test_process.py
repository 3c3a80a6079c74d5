"""The process that runs the tests of a submission, supervised by `sandbox/supervisor.py`.

Usage: python -m thymio_sim_ros.grading.test_process <folder for logs> <test file>… <report> <control>

`report` and `control` are inherited files (`sandbox/pipes.py`); `sandbox/report_protocol.py` describes their content.
"""

from __future__ import annotations

import importlib.util
import json
import linecache
import os
import sys
import traceback
import warnings
from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from fractions import Fraction
from pathlib import Path
from typing import Any

import pytest

from thymio_sim_ros.files.test_files import trace_path
from thymio_sim_ros.grading.integrity import TestFunctions
from thymio_sim_ros.grading.points import points_of
from thymio_sim_ros.grading.sandbox.pipes import opened
from thymio_sim_ros.portable_ros import import_hook
from thymio_sim_ros.pytest_plugin import GRADED, Graded

__all__ = ["GradingPlugin", "main"]

_LONGEST = 20_000
"""Characters of a message that are reported."""

_ENDS: Mapping[type[BaseException], str] = {
    SystemExit: "exit()",
    KeyboardInterrupt: "KeyboardInterrupt",
    pytest.exit.Exception: "pytest.exit()",
}
"""Exceptions that end Python or pytest, and what raises them."""


def main(argv: Sequence[str]) -> None:
    """Run the tests; ends the process."""
    if sys.platform == "linux":
        from thymio_sim_ros.grading.sandbox.linux import syscalls

        syscalls.hide_memory()  # from programs that the tests start
    folder, *tests, report, control = argv
    commands = open(opened(control), encoding="utf-8")  # noqa: SIM115  # open to the end
    task = json.loads(commands.readline())
    graded = Graded(Path(task["assignment"]), frozenset(task["handed_in"]), task["output_bytes"])
    plugin = GradingPlugin(
        Path(folder), _Reporter(opened(report), task["secret"]).send, commands.readline, task["selected"], graded
    )
    if not task["has_installed_ros"]:
        import_hook.install(is_forced=True)
    options = ["-p", "thymio_sim_ros.pytest_plugin", "-p", "no:cacheprovider", "-p", "no:faulthandler", "-s"]
    options += ["-c", os.devnull, "--rootdir", os.getcwd(), "--confcutdir", os.getcwd(), "--run-logs", folder]
    options += ["--tb=short", *(["--ros"] if task["has_installed_ros"] else [])]
    pytest.main([*options, *tests], plugins=[plugin])
    plugin.finish()
    os._exit(0)  # threads of the submission may still run


class _Reporter:
    """Writes the report. A process that the submission forks has no access to it."""

    def __init__(self, file: int, secret: str) -> None:
        self._file: int | None = file
        self._secret = secret
        if hasattr(os, "register_at_fork"):
            os.register_at_fork(after_in_child=self._close)

    def send(self, kind: str, **content: object) -> None:
        """Write a line. In a forked process this ends the process, which would otherwise repeat the tests."""
        if self._file is None:
            os._exit(0)
        sys.stdout.flush()
        sys.stderr.flush()
        line = json.dumps({"secret": self._secret, "do": kind, **content}).encode() + b"\n"
        while line:
            line = line[os.write(self._file, line) :]

    def _close(self) -> None:
        if self._file is not None:
            os.close(self._file)
            self._file = None


class GradingPlugin:
    """pytest plug-in that reports to the supervisor, and waits for it between collecting and running."""

    def __init__(
        self,
        folder: Path,
        send: Callable[..., None],
        wait: Callable[[], str],
        selected: Sequence[str] | None,
        graded: Graded,
    ) -> None:
        """`folder`: where pictures go. `selected`: the tests that run, in order; None: they are only collected."""
        self._folder, self._send, self._wait, self._selected = folder, send, wait, selected
        self._graded = graded
        self._functions = TestFunctions()
        self._broken: list[str] = []
        self._skipped: list[str] = []
        self._points: dict[str, Fraction] = {}
        self._reports: list[pytest.TestReport] = []
        self._failures: list[str] = []
        """Exceptions of the test that runs, whatever its reports say."""
        self._path = list(sys.path)
        self._tests = os.getcwd()
        self._has_run = False

    @pytest.hookimpl(trylast=True)
    def pytest_configure(self, config: pytest.Config) -> None:
        """Remove pytest's own output, so that only that of the submission is left."""
        config.pluginmanager.unregister(name="terminalreporter")
        config.stash[GRADED] = self._graded

    def pytest_collectreport(self, report: pytest.CollectReport) -> None:
        """Note test files that cannot be imported, or are skipped as a whole."""
        if report.failed:
            self._broken.append(report.longreprtext)
        elif report.skipped and isinstance(report.longrepr, tuple):
            self._skipped.append(f"{report.nodeid}: {report.longrepr[2]}")

    @pytest.hookimpl(trylast=True)
    def pytest_collection_modifyitems(self, items: list[pytest.Item]) -> None:
        """Compute the points of all tests, then keep those that are selected."""
        try:
            self._points = dict(zip([item.nodeid for item in items], points_of(items), strict=True))
        except pytest.UsageError as error:
            self._broken.append(str(error))
        if self._selected is not None:
            found = {item.nodeid: item for item in items}
            items[:] = [found[test] for test in self._selected if test in found]

    @pytest.hookimpl(trylast=True)
    def pytest_collection_finish(self, session: pytest.Session) -> None:
        """Report the tests; continue when the supervisor has replaced their sources by the submission."""
        if not self._broken and (reason := _import_for(session.items, is_run=self._selected is not None)):
            self._broken.append(reason)
        if self._broken:
            self._send("broken", message="\n".join(self._broken)[-_LONGEST:])
            os._exit(0)
        _keep_sources(Path.cwd())
        self._functions.remember(Path.cwd())
        tests = [(item.nodeid, str(self._points[item.nodeid])) for item in session.items]
        self._send("collected", tests=tests, notes=self._skipped)
        if not self._wait():
            os._exit(0)
        sys.path[:] = self._path  # without the folder of the tests, where the submission is now
        self._has_run = True

    def pytest_runtest_logstart(self, nodeid: str) -> None:
        """Report the begin of a test, and wait until its files are there."""
        self._reports.clear()
        self._failures.clear()
        self._send("begin", test=nodeid)
        self._wait()

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Keep the report of a phase."""
        self._reports.append(report)

    @pytest.hookimpl(wrapper=True, tryfirst=True)
    def pytest_runtest_setup(self) -> Generator[None, object, object]:
        """Keep the submission from ending the tests."""
        return (yield from _not_ended(self._tests))

    @pytest.hookimpl(wrapper=True, tryfirst=True)
    def pytest_runtest_call(self) -> Generator[None, object, object]:
        """Keep the submission from ending the tests."""
        return (yield from _not_ended(self._tests))

    @pytest.hookimpl(wrapper=True, tryfirst=True)
    def pytest_runtest_teardown(self) -> Generator[None, object, object]:
        """Keep the submission from ending the tests."""
        return (yield from _not_ended(self._tests))

    @pytest.hookimpl(wrapper=True)
    def pytest_runtest_makereport(self, item: pytest.Item, call: pytest.CallInfo[None]) -> Iterator[None]:
        """Draw the paths of the robots when a test fails, while they are there."""
        report = yield
        if call.excinfo is not None and not call.excinfo.errisinstance((pytest.skip.Exception, pytest.xfail.Exception)):
            self._failures.append(call.excinfo.exconly())
        if call.when == "call" and report.failed:  # type: ignore[attr-defined]
            _draw(item, trace_path(self._folder, item.nodeid))
        return report

    def pytest_runtest_logfinish(self, nodeid: str) -> None:
        """Report the outcome of a test: that of its first phase that did not pass."""
        outcome, phase, message = "passed", "", ""
        for report in self._reports:
            if (report.outcome != "passed" or report.longrepr) and outcome == "passed":
                outcome, phase, message = report.outcome, report.when, _message(report)
        if outcome == "passed":  # an expected failure is reported as skipped
            message = "\n".join([*self._failures, *self._functions.replaced()])
        self._send("result", test=nodeid, outcome=outcome, phase=phase, message=message[-_LONGEST:])

    def finish(self) -> None:
        """Report the end, or why there was nothing to run."""
        if self._has_run:
            self._send("end")
        else:
            self._send("broken", message="\n".join(self._broken) or "pytest ended before it had collected the tests")


def _not_ended(folder: str) -> Generator[None, object, object]:
    """Run a phase of a test, in which exceptions that end Python or pytest are failures of this test.

    `folder`: folder of the files whose lines are named.
    """
    try:
        return (yield)
    except tuple(_ENDS) as error:
        stack = traceback.extract_tb(error.__traceback__)
        frames = [frame for frame in stack if Path(frame.filename).is_relative_to(folder)]
        where = f"{frames[-1].filename}, line {frames[-1].lineno}: " if frames else ""
        what = next(text for kind, text in _ENDS.items() if isinstance(error, kind))
        text = f"{where}{what} ends the program before the test is over: remove it"
        raise pytest.fail.Exception(text, pytrace=False) from None


def _message(report: pytest.TestReport) -> str:
    if report.skipped and isinstance(report.longrepr, tuple):
        return str(report.longrepr[2])
    return str(report.longreprtext)


def _keep_sources(folder: Path) -> None:
    """Keep the lines of all sources of the tests in memory: failure messages quote them when the files are gone."""
    for path in folder.rglob("*.py"):
        lines = linecache.getlines(str(path))
        linecache.cache[str(path)] = (len(lines), None, lines, str(path))  # without a time, it is never checked again


def _import_for(items: Sequence[pytest.Item], *, is_run: bool) -> str:
    """Import what the fixtures of tests import, before the submission is there; return why that is not possible.

    `is_run`: whether the tests are run afterwards, and not only collected.
    """
    if is_run:
        import thymio_sim_ros.testing

    used = {name for item in items for name in getattr(item, "fixturenames", ())}
    if used & {"ros", "simulation", "runtime"} and importlib.util.find_spec("rclpy") is not None:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", DeprecationWarning)  # lark, imported with the first node's messages
            try:
                import thymio_sim_ros.testing.ros  # noqa: F401 - imported before the submission
            except ImportError as error:
                return f"ROS cannot be imported: {error}"
    return ""


def _draw(item: pytest.Item, path: Path) -> None:
    """Draw the world of a test, if it has one."""
    arguments: Mapping[str, Any] = getattr(item, "funcargs", {})
    stage = arguments.get("classroom") or getattr(arguments.get("thymio"), "stage", None)
    stage = stage or getattr(arguments.get("ros"), "simulation", None)
    if stage is None:
        return
    from thymio_sim_ros.testing.trace_picture import draw_traces

    traces = {thymio.name: [moment.pose for moment in thymio.path] for thymio in stage}
    try:
        path.write_text(draw_traces(stage.world.playground, traces), encoding="utf-8")
    except OSError:
        return  # the submission has filled the disk: its verdict stays without a picture


if __name__ == "__main__":
    main(sys.argv[1:])
