"""The console scripts: they import nothing before they may be interrupted, and start without standard streams."""

from __future__ import annotations

import json
import os
import select
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from tests.patience import PATIENCE_S, until
from thymio_sim_ros import entry_points

ROOT = Path(__file__).parent.parent
NODES = {
    "aseba_runtime": "aseba.node",
    "foxglove_bridge": "foxglove.node",
    "simulator": "simulator.node",
    "thymio": "combined",
    "web_ui": "web.node",
}
EXAMPLES = sorted(path.stem for path in (ROOT / "thymio_sim_ros" / "examples").glob("[a-z]*.py"))
IN_A_SHELL = (
    f"import sys; sys.path.insert(0, '{ROOT}'); "
    "from thymio_sim_ros.entry_points import thymio_sim; sys.exit(thymio_sim())"
)


class _Program:
    """Stands for `import_module`, and for what it gives."""

    def __init__(self) -> None:
        self.asked = ""

    def __call__(self, module: str) -> _Program:
        self.asked = module
        return self

    def open_standard_streams(self) -> None:
        pass

    def main(self) -> int:
        return 2


def test_each_script_runs_its_program(monkeypatch):
    program = _Program()
    monkeypatch.setattr(entry_points, "import_module", program)
    assert (entry_points.thymio_sim(), program.asked) == (2, "thymio_sim_ros.cli.main")
    for name, module in NODES.items():
        assert (getattr(entry_points, name)(), program.asked) == (2, f"thymio_sim_ros.ros.{module}")
    for name in EXAMPLES:
        assert (getattr(entry_points, name)(), program.asked) == (0, f"thymio_sim_ros.examples.{name}")


def test_an_ignored_interrupt_stays_ignored(monkeypatch):
    monkeypatch.setattr(entry_points, "import_module", _Program())
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    entry_points.thymio_sim()
    assert signal.getsignal(signal.SIGINT) is signal.SIG_IGN


@pytest.mark.process
def test_nothing_that_takes_time_is_imported_first():
    code = "import sys, thymio_sim_ros.entry_points; print(*sorted(name for name in sys.modules if '.' not in name))"
    names = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split()
    assert "thymio_sim_ros" in names
    assert {"rclpy", "numpy", "pymunk", "PIL", "websockets", "aseba_vm"}.isdisjoint(names)


def script(name: str, *arguments: str) -> list[str]:
    """The command of a console script, which writes a line when its function is called."""
    code = f"import sys, thymio_sim_ros.entry_points as start; print('begun', flush=True); sys.exit(start.{name}())"
    return [sys.executable, "-c", code, *arguments]


def interrupted(command: list[str], after_s: float) -> tuple[int, str]:
    """Exit code and output of a command to which SIGINT comes so long after its begin."""
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, cwd=ROOT) as process:
        assert process.stdout is not None
        assert process.stdout.readline() == b"begun\n"
        select.select([process.stdout], [], [], after_s)  # the moment is what is tested
        process.send_signal(signal.SIGINT)
        try:
            output, _ = process.communicate(timeout=PATIENCE_S)
        finally:
            process.kill()
        return process.returncode, output.decode()


@pytest.mark.process
def test_an_interrupt_while_a_command_is_imported_ends_it_without_a_word():
    command = script("thymio_sim", "runner", "--seconds", "1e7")
    for moment in range(1, 11):
        code, output = interrupted(command, 0.03 * moment)
        assert (code, output) == (-signal.SIGINT, "") or "stopped after" in output


@pytest.mark.slow
@pytest.mark.process
@pytest.mark.parametrize(("name", "codes"), [("thymio_sim", {0, -signal.SIGINT}), ("simulator", {0})])
def test_an_interrupt_at_any_moment_of_a_start_ends_it_without_a_traceback(ros_domain, name, codes):
    for moment in range(1, 11):
        code, output = interrupted(script(name, *(["--headless"] if name == "thymio_sim" else [])), 0.15 * moment)
        assert "Traceback" not in output
        assert "KeyboardInterrupt" not in output
        assert code in codes, output


@pytest.mark.process
@pytest.mark.parametrize(
    "closed", [*(pytest.param(one, marks=pytest.mark.slow) for one in ("<&-", ">&-", "2>&-")), "<&- >&- 2>&-"]
)
def test_a_run_with_closed_standard_streams_is_a_run(tmp_path, closed):
    log = tmp_path / "run.jsonl"
    command = f'"{sys.executable}" -c "{IN_A_SHELL}" runner --seconds 1 --log "{log}" {closed}'
    done = subprocess.run(["sh", "-c", command], capture_output=True, text=True, timeout=PATIENCE_S, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    assert json.loads(log.read_text().splitlines()[-1]) == {"end": True}, "nothing else was written to the log"
    assert bool(done.stdout) == (">&-" not in closed.replace("2>&-", ""))


@pytest.mark.process
@pytest.mark.parametrize(
    "closed", [*(pytest.param(one, marks=pytest.mark.slow) for one in (">&-", "2>&-")), "<&- >&- 2>&-"]
)
def test_nodes_start_with_closed_standard_streams(ros_domain, tmp_path, closed):
    log = tmp_path / "run.jsonl"
    command = f'exec "{sys.executable}" -c "{IN_A_SHELL}" --headless --log "{log}" {closed}'
    with subprocess.Popen(["sh", "-c", command], stdout=subprocess.PIPE, stderr=subprocess.STDOUT) as process:
        try:
            until(lambda: (log.exists() and log.stat().st_size) or process.poll() is not None)
            process.send_signal(signal.SIGINT)
            output, _ = process.communicate(timeout=PATIENCE_S)
        finally:
            process.kill()
    assert log.exists(), output
    assert b"Error" not in output
    assert process.returncode == 0, output


@pytest.mark.process
@pytest.mark.parametrize("home", [pytest.param(None, marks=pytest.mark.slow), "/proc/nowhere"])
def test_nodes_start_without_a_home_folder(ros_domain, tmp_path, home):
    environment = {name: value for name, value in os.environ.items() if name not in ("HOME", "ROS_LOG_DIR", "ROS_HOME")}
    environment |= {"TMPDIR": str(tmp_path)} | ({} if home is None else {"HOME": home})
    with subprocess.Popen(
        script("thymio_sim", "--headless"), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, cwd=ROOT, env=environment
    ) as process:
        assert process.stdout is not None
        try:
            lines = []
            for line in process.stdout:
                lines.append(line.decode())
                if line.startswith(b"Stop"):
                    break
            process.send_signal(signal.SIGINT)
            output, _ = process.communicate(timeout=PATIENCE_S)
        finally:
            process.kill()
    assert any(line.startswith(f"thymio-sim: log files go to {tmp_path}/thymio-sim-log-") for line in lines), lines
    assert process.returncode == 0, (lines, output)
