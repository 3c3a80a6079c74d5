"""The process of a sandbox: reads a job from standard input, runs it in isolation, prints the report as JSON.

Usage: python -m thymio_sim_ros.grading.sandbox.launcher
"""

from __future__ import annotations

import pickle
import signal
import sys
import tempfile
from pathlib import Path

from thymio_sim_ros.grading.sandbox.job import Job
from thymio_sim_ros.grading.sandbox.portable_place import PortablePlace
from thymio_sim_ros.grading.sandbox.supervisor import supervise

__all__ = ["main"]


def main() -> int:
    """Run the job of standard input; return the exit code."""
    job: Job = pickle.load(sys.stdin.buffer)  # of the grader
    if job.level != "process":
        from thymio_sim_ros.grading.sandbox.linux import launcher as linux_launcher

        return linux_launcher.run(job)
    signal.signal(signal.SIGTERM, lambda number, frame: sys.exit(1))  # ends the processes of the submission, too
    with tempfile.TemporaryDirectory(prefix="thymio-grade-", ignore_cleanup_errors=True) as folder:
        report = supervise(job, PortablePlace(Path(folder).resolve(), job.limits))
        print(report.to_json(), flush=True)
    return 0


if __name__ == "__main__":
    sys.exit(main())
