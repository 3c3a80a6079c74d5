"""New files of LTTng are removed, those of other processes are kept; incomplete ports do not block a start."""

from __future__ import annotations

import os
import subprocess
import sys
import time

import pytest

from tests.patience import PATIENCE_S
from thymio_sim_ros.ros.compat import shm_cleanup

HOLD = "import mmap, sys; f = open(sys.argv[1], 'r+b'); m = mmap.mmap(f.fileno(), 4096); print(1, flush=True); input()"


def make(folder, name):
    path = folder / name
    path.write_bytes(bytes(4096))
    return path


def test_only_new_files_are_removed(tmp_path):
    old = make(tmp_path, "lttng-ust-wait-6")
    other = make(tmp_path, "other-file")
    before = shm_cleanup.present(tmp_path)
    new = make(tmp_path, "lttng-ust-wait-6-0")
    shm_cleanup.remove_new(before, tmp_path)
    assert old.exists()
    assert other.exists()
    assert not new.exists()


def test_files_that_another_process_uses_are_kept(tmp_path):
    before = shm_cleanup.present(tmp_path)
    new = make(tmp_path, "lttng-ust-wait-6-0")
    command = [sys.executable, "-c", HOLD, str(new)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as holder:
        holder.stdout.readline()
        shm_cleanup.remove_new(before, tmp_path)
        assert new.exists()
        holder.communicate(b"\n")
    shm_cleanup.remove_new(before, tmp_path)
    assert not new.exists()


def age(path, seconds):
    then = time.time() - seconds
    os.utime(path, (then, then))
    return path


@pytest.mark.parametrize("begin", [b"", bytes(52400), b"\x01" + bytes(52399)])
def test_an_old_incomplete_port_is_removed(tmp_path, begin):
    broken = tmp_path / "fastrtps_port7413"
    broken.write_bytes(begin)
    assert shm_cleanup.remove_incomplete_ports(tmp_path) == []  # it may be in the making
    age(broken, 11)
    assert shm_cleanup.remove_incomplete_ports(tmp_path) == [broken]
    assert list(tmp_path.iterdir()) == []


def test_ports_in_use_and_other_files_are_kept(tmp_path):
    port, lock, other = (tmp_path / name for name in ("fastrtps_port7413", "fastrtps_port7413_el", "else"))
    port.write_bytes(b"\x02" + bytes(52399))
    lock.write_bytes(b"")
    other.write_bytes(bytes(8))
    for path in (port, lock, other):
        age(path, 1000)
    assert shm_cleanup.remove_incomplete_ports(tmp_path) == []


@pytest.mark.process
def test_a_node_starts_at_a_port_with_an_incomplete_file():
    """Fast DDS alone waits for ever there: the port at which the first participant of the domain listens."""
    pytest.importorskip("rclpy")
    domain = pytest.importorskip("thymio_sim_ros.testing.ros.domain")
    with domain.reserved() as number:
        port = shm_cleanup.SHARED_MEMORY / f"fastrtps_port{domain.DISCOVERY_PORT + 250 * number + 11}"
        port.write_bytes(bytes(52400))
        age(port, 60)
        arguments = ["--ros-args", "-p", "playground:=nowhere"]
        command = [sys.executable, "-c", "from thymio_sim_ros.ros.simulator.node import main; main()", *arguments]
        ended = subprocess.run(command, timeout=PATIENCE_S, capture_output=True, text=True, check=False)
    assert "nowhere" in ended.stderr
