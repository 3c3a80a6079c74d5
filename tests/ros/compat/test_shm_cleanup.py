"""New files of LTTng are removed, those of other processes are kept; incomplete ports do not block a start."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

from tests.patience import PATIENCE_S, until
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


SEGMENT = "fastrtps_00d53448c4dfd4b6"
LOCK = "import fcntl, sys; f = open(sys.argv[1]); fcntl.flock(f, fcntl.LOCK_EX); print(1, flush=True); input()"


def segment_of(folder, name=SEGMENT):
    """A segment and the file with its lock, made a minute ago."""
    paths = make(folder, name), make(folder, f"{name}_el")
    for path in paths:
        age(path, 60)
    return paths


@pytest.mark.parametrize("name", [SEGMENT, "fastdds_00d53448c4dfd4b6"])
def test_a_segment_of_a_process_that_has_ended_is_removed(tmp_path, name):
    segment_of(tmp_path, name)
    assert shm_cleanup.remove_abandoned_segments(tmp_path) == [tmp_path / name]
    assert list(tmp_path.iterdir()) == []


def test_the_lock_of_a_segment_that_was_never_made_is_removed(tmp_path):
    segment, _ = segment_of(tmp_path)
    segment.unlink()
    shm_cleanup.remove_abandoned_segments(tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_the_segment_of_a_living_process_is_kept_until_it_is_killed(tmp_path):
    _, lock = segment_of(tmp_path)
    command = [sys.executable, "-c", LOCK, str(lock)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as holder:
        holder.stdout.readline()
        assert shm_cleanup.remove_abandoned_segments(tmp_path) == []
        holder.kill()
    assert shm_cleanup.remove_abandoned_segments(tmp_path) == [tmp_path / SEGMENT]


def test_segments_that_are_new_or_belong_to_others_are_kept(tmp_path, monkeypatch):
    _, lock = segment_of(tmp_path)
    age(lock, 0)
    assert shm_cleanup.remove_abandoned_segments(tmp_path) == []
    age(lock, 60)
    monkeypatch.setattr(os, "getuid", lambda: lock.stat().st_uid + 1)
    assert shm_cleanup.remove_abandoned_segments(tmp_path) == []


def test_other_files_with_a_similar_name_are_kept(tmp_path):
    for name in ("fastrtps_port7413_el", "fastrtps_mine_el", "fastlane_00d53448c4dfd4b6_el"):
        age(make(tmp_path, name), 60)
    assert shm_cleanup.remove_abandoned_segments(tmp_path) == []


@pytest.mark.process
def test_what_a_killed_node_leaves_is_removed():
    """With the files of Fast DDS itself."""
    pytest.importorskip("rclpy")
    domain = pytest.importorskip("thymio_sim_ros.testing.ros.domain")
    with domain.reserved():
        command = [sys.executable, "-c", "from thymio_sim_ros.ros.simulator.node import main; main()"]
        with subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL) as node:
            try:
                made = until(lambda: segments_of(node.pid))
                for segment in made:
                    age(segment.with_name(f"{segment.name}_el"), 60)
                shm_cleanup.remove_abandoned()
                assert all(segment.exists() for segment in made)
            finally:
                node.kill()
        shm_cleanup.remove_abandoned()
        assert not any(segment.exists() or segment.with_name(f"{segment.name}_el").exists() for segment in made)


def segments_of(pid):
    """The segments that a process has mapped."""
    words = Path(f"/proc/{pid}/maps").read_text().split()
    return {Path(word) for word in words if shm_cleanup.LOCK.fullmatch(f"{Path(word).name}_el")}


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
