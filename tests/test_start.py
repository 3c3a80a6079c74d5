"""The console scripts: they import nothing before they may be interrupted."""

from __future__ import annotations

import subprocess
import sys

import pytest

from thymio_sim_ros import start

NODES = {
    "aseba_runtime": "aseba_node",
    "foxglove_bridge": "foxglove_node",
    "simulator": "simulator_node",
    "thymio": "all_nodes",
    "web_ui": "web_node",
}


class _Program:
    """Stands for `import_module`, and for what it gives; or Ctrl-C comes meanwhile."""

    def __init__(self, *, is_interrupted: bool) -> None:
        self.is_interrupted = is_interrupted
        self.asked = ""

    def __call__(self, module: str) -> _Program:
        self.asked = module
        if self.is_interrupted:
            raise KeyboardInterrupt
        return self

    def main(self) -> int:
        return 2


@pytest.mark.parametrize(("is_interrupted", "code", "code_of_nodes"), [(False, 2, 2), (True, 130, 0)])
def test_an_interrupt_at_the_start_is_an_exit_code(monkeypatch, is_interrupted, code, code_of_nodes):
    program = _Program(is_interrupted=is_interrupted)
    monkeypatch.setattr(start, "import_module", program)
    assert (start.thymio_sim(), program.asked) == (code, "thymio_sim_ros.cli")
    for name, module in NODES.items():
        assert (getattr(start, name)(), program.asked) == (code_of_nodes, f"thymio_sim_ros.nodes.{module}")


def test_nothing_that_takes_time_is_imported_first():
    code = "import sys, thymio_sim_ros.start; print(*sorted(name for name in sys.modules if '.' not in name))"
    names = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split()
    assert "thymio_sim_ros" in names
    assert {"rclpy", "numpy", "pymunk", "PIL", "websockets"}.isdisjoint(names)
