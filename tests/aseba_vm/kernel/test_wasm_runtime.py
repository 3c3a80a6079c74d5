"""WebAssembly that does not work: no package, a broken one, too little memory."""

from __future__ import annotations

import resource
import subprocess
import sys
from pathlib import Path

import pytest

from aseba_vm.kernel import wasm_runtime
from aseba_vm.kernel.wasm_runtime import is_usable
from tests.patience import PROGRAM_S

ROOT = Path(__file__).parents[3]
ENOUGH, TOO_LITTLE = 1 << 30, 300 << 20
"""Bytes of address space."""

PROGRAM = """
import sys
from aseba_vm import VirtualMachine, compile
from aseba_vm.kernel import wasm_runtime
from aseba_vm.targets import THYMIO_II
machine = VirtualMachine(THYMIO_II)
machine.load(compile("var n = 0\\nwhile n < 9000 do\\nn = n + 3\\nend", THYMIO_II))
machine.run()
print(machine.variables[128])
print(wasm_runtime.is_usable(), file=sys.stderr)
"""

BATCH_SCRIPT = """
import sys
from dataclasses import replace
from aseba_vm.kernel import wasm_runtime
from thymio_sim_ros.files.loading import load_playground, read_assignments
from thymio_sim_ros.engine.engine import Engine
playground = load_playground("borderless")[1]
start = playground.robots[0]
robots = tuple(replace(start, name=f"r{n}", x_m=0.3 * (n % 5) - 0.6, y_m=0.3 * (n // 5) - 0.6) for n in range(20))
shares = read_assignments("line_follower", [robot.name for robot in robots], "thymio")
runner = Engine(replace(playground, robots=robots), {name: share.program for name, share in shares.items()})
for _ in runner.steps(1.0):
    pass
print([robot.pose for robot in runner.world.robots.values()])
print(wasm_runtime.is_usable(), file=sys.stderr)
"""


def run(script: str, *, path: Path = ROOT, address_space: int = resource.RLIM_INFINITY) -> tuple[str, list[str]]:
    """What a script printed in a process with this limit, on stdout and on stderr; `path` comes first."""
    head = f"import resource\nresource.setrlimit(resource.RLIMIT_AS, ({address_space}, {address_space}))\n"
    head += f"import sys\nsys.path[:0] = [{str(path)!r}, {str(ROOT)!r}]\n"
    done = subprocess.run(
        [sys.executable, "-c", head + script], capture_output=True, text=True, timeout=PROGRAM_S, check=False
    )
    assert done.returncode == 0, done.stderr
    return done.stdout, done.stderr.splitlines()


@pytest.fixture(scope="module")
def poses() -> str:
    return run(BATCH_SCRIPT)[0]


@pytest.fixture(
    params=["raise ImportError('libwasmtime.so: no such file')", "import ctypes; ctypes.CDLL('nowhere.so')"]
)
def broken(request, tmp_path) -> Path:
    """Create a folder with a package of that name."""
    (tmp_path / "wasmtime").mkdir()
    (tmp_path / "wasmtime" / "__init__.py").write_text(request.param)
    return tmp_path


def check_reported_once(stderr: list[str]) -> None:
    reason, usable = stderr
    assert reason.startswith("wasmtime cannot be used, programs and robots run slower: ")
    assert usable == "False"


@pytest.mark.process
def test_a_broken_package_is_reported_once_and_programs_run(broken):
    stdout, stderr = run(PROGRAM, path=broken)
    assert stdout == "9000\n"
    check_reported_once(stderr)


@pytest.mark.slow
@pytest.mark.process
def test_a_broken_package_is_reported_once_and_crowds_move_the_same(broken, poses):
    stdout, stderr = run(BATCH_SCRIPT, path=broken)
    assert stdout == poses
    check_reported_once(stderr)


@pytest.mark.process
def test_a_missing_package_is_reported_once_and_programs_run():
    stdout, stderr = run(f"sys.modules['wasmtime'] = None\n{PROGRAM}")
    assert stdout == "9000\n"
    check_reported_once(stderr)


@pytest.mark.process
@pytest.mark.skipif(not is_usable(), reason="wasmtime is not installed")
def test_memories_take_no_more_address_space_than_their_size(poses):
    assert run(PROGRAM, address_space=ENOUGH) == ("9000\n", ["True"])
    assert run(BATCH_SCRIPT, address_space=ENOUGH) == (poses, ["True"])


@pytest.mark.slow
@pytest.mark.process
@pytest.mark.skipif(not is_usable(), reason="wasmtime is not installed")
def test_where_memory_is_short_everything_works_without(poses):
    for script, expected in ((PROGRAM, "9000\n"), (BATCH_SCRIPT, poses)):
        stdout, stderr = run(script, address_space=TOO_LITTLE)
        assert stdout == expected
        check_reported_once(stderr)


@pytest.mark.skipif(not is_usable(), reason="wasmtime is not installed")
def test_a_version_without_these_options_works_too(monkeypatch):
    class Config:
        pass

    runtime = wasm_runtime.WasmRuntime.get()
    monkeypatch.setattr(runtime, "wasmtime", type("Old", (), {"Config": Config}))
    assert vars(runtime._config()) == {}
