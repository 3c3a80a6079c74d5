"""Files of LTTng that our start made are gone after its end; those of others stay."""

from __future__ import annotations

import subprocess
import sys

from thymio_sim_ros.nodes import leftovers

HOLD = "import mmap, sys; f = open(sys.argv[1], 'r+b'); m = mmap.mmap(f.fileno(), 4096); print(1, flush=True); input()"


def make(folder, name):
    path = folder / name
    path.write_bytes(bytes(4096))
    return path


def test_what_was_there_before_stays_and_what_is_new_goes(tmp_path):
    old = make(tmp_path, "lttng-ust-wait-6")
    other = make(tmp_path, "somebody-else")
    before = leftovers.present(tmp_path)
    new = make(tmp_path, "lttng-ust-wait-6-0")
    leftovers.remove_new(before, tmp_path)
    assert old.exists()
    assert other.exists()
    assert not new.exists()


def test_what_another_process_uses_stays(tmp_path):
    before = leftovers.present(tmp_path)
    new = make(tmp_path, "lttng-ust-wait-6-0")
    command = [sys.executable, "-c", HOLD, str(new)]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE) as holder:
        holder.stdout.readline()
        leftovers.remove_new(before, tmp_path)
        assert new.exists()
        holder.communicate(b"\n")
    leftovers.remove_new(before, tmp_path)
    assert not new.exists()
