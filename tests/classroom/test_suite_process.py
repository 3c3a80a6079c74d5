"""Command line, environment and end of a pupil's suite."""

from __future__ import annotations

import subprocess
import sys
import textwrap
from dataclasses import replace
from pathlib import Path

import pytest

from tests.patience import PROGRAM_S
from thymio_sim_ros.classroom.folder import Place
from thymio_sim_ros.classroom.seat import FIRST_WAIT_S, MAX_WAIT_S, STEADY_S, next_wait_s
from thymio_sim_ros.classroom.suite_process import SuiteOptions, command, environment, reason_of_end

OPTIONS = SuiteOptions("desk", "welcome")
PARAMETERS = Path("/class/parameters.yaml")
PLACE = Place("ada", "Ada", 2, "secret-token", "other-token")


def test_a_pupil_has_a_port_of_loopback_an_embedded_graph_and_no_servers_for_other_programs() -> None:
    line = " ".join(command(OPTIONS, 8105, "welcome", PARAMETERS))
    assert line.startswith("--portable ")
    assert "--address localhost --trusted-proxy 127.0.0.1" in line
    assert "--port 8105 --no-foxglove-port" in line
    assert "--no-aseba --no-tdm" in line
    assert line.endswith(
        "--ros-args -p simulator:batch_ticks:=3 -p simulator:clock_rate:=20.0 --params-file /class/parameters.yaml"
    )
    assert "ROS_DOMAIN_ID" not in environment(OPTIONS, PLACE, {})


def test_with_ros_a_pupil_has_a_domain() -> None:
    options = replace(OPTIONS, first_domain=1)
    assert command(options, 8105, "welcome", PARAMETERS)[0] == "--ros"
    assert environment(options, PLACE, {})["ROS_DOMAIN_ID"] == "3"


def test_pupils_run_nodes_of_the_page_only_if_the_class_says_so() -> None:
    assert "--no-nodes" in command(OPTIONS, 8105, "welcome", PARAMETERS)
    assert "--nodes" in command(replace(OPTIONS, has_nodes=True), 8105, "welcome", PARAMETERS)


def test_tokens_are_in_the_environment_only() -> None:
    assert "token" not in " ".join(command(OPTIONS, 8105, "welcome", PARAMETERS))
    assert environment(OPTIONS, PLACE, {"PATH": "/bin"})["THYMIO_SIM_TOKEN"] == "secret-token"


def test_discovery_stays_on_this_computer_unless_the_environment_says_more() -> None:
    name = "ROS_AUTOMATIC_DISCOVERY_RANGE"
    assert environment(OPTIONS, PLACE, {})[name] == "LOCALHOST"
    assert environment(OPTIONS, PLACE, {name: "SUBNET"})[name] == "SUBNET"


@pytest.mark.parametrize(
    ("code", "output", "reason"),
    [
        (2, "line\nthymio-sim: port 8105 is used\n", "thymio-sim: port 8105 is used"),
        (1, "  File x\nMemoryError: none left\n", "MemoryError: none left"),
        (-9, "", "ended by SIGKILL"),
        (3, "", "ended with exit code 3"),
    ],
)
def test_the_reason_of_an_end_is_its_last_error(tmp_path: Path, code: int, output: str, reason: str) -> None:
    log = tmp_path / "suite.log"
    log.write_text(output)
    assert reason_of_end(code, log) == reason


def test_a_suite_that_ends_again_and_again_is_started_less_often() -> None:
    waits = [0.0]
    for _ in range(9):
        waits.append(next_wait_s(waits[-1], 1.0))
    assert waits[1] == FIRST_WAIT_S
    assert waits == sorted(waits)
    assert waits[-1] == MAX_WAIT_S
    assert next_wait_s(MAX_WAIT_S, STEADY_S) == FIRST_WAIT_S


@pytest.mark.process
@pytest.mark.skipif(sys.platform != "linux", reason="suites are forked on Linux only")
def test_a_suite_that_cannot_be_forked_is_an_error_of_the_system(tmp_path: Path) -> None:
    (tmp_path / "no_memory.py").write_text("raise MemoryError\n")
    program = textwrap.dedent("""\
        import asyncio
        from pathlib import Path
        from thymio_sim_ros.classroom.suite_process import SuiteProcess, preload

        preload("no_memory")
        try:
            asyncio.run(SuiteProcess.start(["--headless"], {}, Path("suite.log")))
        except OSError as error:
            print(error)
    """)
    (tmp_path / "start.py").write_text(program)
    done = subprocess.run(
        [sys.executable, "start.py"], cwd=tmp_path, capture_output=True, text=True, check=False, timeout=PROGRAM_S
    )
    assert "has ended" in done.stdout, done.stderr


@pytest.mark.process
def test_the_suites_of_a_class_share_what_one_has_made() -> None:
    program = textwrap.dedent("""\
        import threading
        from thymio_sim_ros.classroom.suite_process import preload

        preload("thymio_sim_ros.cli.preload", "maze")
        import thymio_sim_ros.cli.preload
        from aseba_vm.kernel.wasm_runtime import WasmRuntime
        from thymio_sim_ros.engine.engine import Engine
        from thymio_sim_ros.files.loading import load_playground
        from thymio_sim_ros.sim.playground import reader

        del reader.load, WasmRuntime.compile
        name, playground = load_playground("maze")
        Engine(playground).run(1.0)
        print(name, threading.active_count())
    """)
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, check=False, timeout=PROGRAM_S
    )
    assert done.stdout == "maze 1\n", done.stderr
