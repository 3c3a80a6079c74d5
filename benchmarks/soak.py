"""Hours of class use: does `thymio-sim` keep memory, descriptors, threads or shared memory that it no longer needs?

A real suite in real time with the visitors of a class, who come and go, in lessons of some minutes: pupils with the
page (they load the page, edit, run, stop and debug programs, change the playground, reset, pause, add and remove
robots), viewers of Foxglove, nodes of ROS, Aseba ports, the Thymio Device Manager, the HTTP interface. Four of ten
reset their connection in place of closing it, viewers stop reading, ROS processes are killed. Every minute the
process is measured. After each lesson, all leave, the first playground and program are restored, and the suite is
measured at rest. The change is the median slope after the warm-up (Theil and Sen) times the duration. Objects of
Python are counted at rest after the warm-up and at the end, with what glibc's `malloc` has in use and free. Needs
Linux, ROS and the built page.
"""

from __future__ import annotations

import argparse
import json
import os
import signal
import tempfile
import time
from collections import Counter
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import astuple, dataclass, field, fields
from pathlib import Path

import rclpy  # noqa: F401  # the suite needs it

from benchmarks.lib.report import Cell, Goal, Report, Table
from benchmarks.lib.soak_pupil import FIRST_PROGRAM, WORLD, Pupil, until, visit_page
from benchmarks.lib.soak_samples import Sample, change, sample, shared_files
from benchmarks.lib.soak_visits import Doors, Lesson, visit_aseba, visit_foxglove, visit_http, visit_ros, visit_tdm
from tests.bridge.studio import Studio
from tests.processes import Process, free_port, wait_for_port

QUICK = {"hours": 0.006, "lesson": 0.12, "warm_up": 0.12, "rest": 0.5, "period": 3.0}
MOST_PERCENT = 5.0
"""Growth of objects that counts as none."""
VISITS = (visit_page, visit_page, visit_foxglove, visit_ros, visit_aseba, visit_tdm, visit_http)
SHOWN_TYPES = 8
ASEBA_PORTS = 20
"""More than a visitor adds robots."""
COUNT_S = 60.0
SHARED_MEMORY = Path("/dev/shm")


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add options."""
    parser.add_argument("--hours", type=float, default=2.0, help="hours of wall time")
    parser.add_argument("--lesson", type=float, default=5.0, help="minutes from rest to rest")
    parser.add_argument("--warm-up", type=float, default=20.0, help="minutes that are not judged")
    parser.add_argument("--rest", type=float, default=20.0, help="seconds from the last visitor to a sample at rest")
    parser.add_argument("--period", type=float, default=60.0, help="seconds between samples in use")


@dataclass
class Course:
    """All lessons: samples, counts of Python objects, and what visitors did."""

    in_use: list[Sample] = field(default_factory=list)
    at_rest: list[Sample] = field(default_factory=list)
    objects: list[Counter[str]] = field(default_factory=list)
    malloc_mb: list[dict[str, float]] = field(default_factory=list)
    counts: Counter[str] = field(default_factory=Counter)
    failures: list[str] = field(default_factory=list)


def measure(options: argparse.Namespace) -> Report:
    """Run a suite for some hours and end it."""
    course = Course()
    with tempfile.TemporaryDirectory() as folder:
        before = set(SHARED_MEMORY.iterdir())
        with running(Path(folder)) as (process, doors):
            own = shared_files(process.pid) - before
            begin_s = time.monotonic()
            lessons = max(round(60 * options.hours / options.lesson), 2)
            for number in range(lessons):
                end_s = begin_s + 60 * options.lesson * (number + 1)
                teach(process, Lesson(doors), course, (begin_s, end_s, options.period), number)
                restore(doors)
                time.sleep(options.rest)
                course.at_rest.append(sample(process.pid, (time.monotonic() - begin_s) / 60))
                print(course.at_rest[-1], flush=True)  # a run that is interrupted leaves what it has found
                if (not course.objects and course.at_rest[-1].minute >= options.warm_up) or number == lessons - 1:
                    take_counts(process.pid, Path(folder) / "counts.json", course)
            process.signal(signal.SIGINT)
            code = process.wait()
        left = sorted(path.name for path in own if path.exists())
        faults = [line for line in process.output.splitlines() if "Traceback" in line or "internal error" in line]
    for line, count in Counter([*course.failures, *faults, *left]).most_common():
        print(f"{count} ×", line)
    ended = {"exit code": code, "files of shared memory": len(left), "faults": len(faults)}
    return report(course, options.warm_up, ended)


@contextmanager
def running(folder: Path) -> Iterator[tuple[Process, Doors]]:
    """A suite with all servers; it is ended if it still runs."""
    doors = free_doors()
    counts = folder / "counts.json"
    ports = zip(("--port", "--foxglove-port", "--tdm-port", "--http-port", "--aseba-port"), _ports(doors), strict=True)
    arguments = [text for option, port in ports for text in (option, str(port))]
    websocket = ("--tdm-ws-port", str(free_port()))  # its own, too: a suite without it has no device manager
    world = (*websocket, "--no-announcement", "--playground", WORLD, "--program", FIRST_PROGRAM)
    process = Process(folder, "benchmarks.lib.soak_suite", str(counts), *arguments, *world)
    try:
        for port in _ports(doors):
            wait_for_port(port)
        yield process, doors
    finally:
        process.end()


def free_doors() -> Doors:
    """Free ports; those after Aseba's are left to the Aseba ports of further robots."""
    while True:
        doors = Doors(*(free_port() for _ in range(5)))
        if not any(0 < port - doors.aseba < ASEBA_PORTS for port in _ports(doors)):
            return doors


def _ports(doors: Doors) -> list[int]:
    return [getattr(doors, one.name) for one in fields(doors)]


def teach(process: Process, lesson: Lesson, course: Course, times_s: tuple[float, float, float], number: int) -> None:
    """Let visitors come and go until the end of the lesson; times are the begin of the course, the end, the period."""
    begin_s, end_s, period_s = times_s
    threads = [lesson.repeat(visit, 100 * number + at) for at, visit in enumerate(VISITS)]
    try:
        while (left_s := end_s - time.monotonic()) > 0:
            time.sleep(min(period_s, left_s))
            course.in_use.append(sample(process.pid, (time.monotonic() - begin_s) / 60))
    finally:
        lesson.is_over.set()
        for thread in threads:
            thread.join()
    course.counts += lesson.counts
    course.failures += lesson.failures


def restore(doors: Doors) -> None:
    """Bring the suite to the playground and the program with which it started."""
    studio = Studio(doors.bridge, until)
    with studio:
        pupil = Pupil(studio)
        until(lambda: "/simulator/pause" in studio.read().services, "services")
        pupil.set("/aseba_runtime.breakpoints", [])
        pupil.set("/aseba_runtime.script.path", FIRST_PROGRAM)
        pupil.set("/simulator.playground", WORLD)
        pupil.call("/simulator/reset")
        pupil.call("/simulator/pause", data=False)


def take_counts(pid: int, path: Path, course: Course) -> None:
    """Ask the suite for its Python objects by type, and for its memory of `malloc`."""
    path.unlink(missing_ok=True)
    os.kill(pid, signal.SIGUSR1)
    deadline = time.monotonic() + COUNT_S
    while not path.exists():
        if time.monotonic() > deadline:
            raise TimeoutError(f"the suite has not counted its objects within {COUNT_S} s")
        time.sleep(0.05)
    found = json.loads(path.read_text(encoding="utf-8"))
    course.objects.append(Counter(found["objects"]))
    course.malloc_mb.append(found["malloc_mb"])
    print(found["malloc_mb"], flush=True)


def report(course: Course, warm_up: float, end: dict[str, int]) -> Report:
    """Make tables and goals; `end` has what should be 0 after the end of the suite."""
    sizes = [one.name for one in fields(Sample) if one.name != "minute"]
    heads = ["minute", "RSS, MB", "PSS, MB", "descriptors", "threads", "shared files", "shared, MB"]
    rows: list[list[Cell]] = [[*map(float, astuple(one))] for one in course.at_rest]
    judged = {"at rest": after(course.at_rest, warm_up), "in use": after(course.in_use, warm_up)}
    changes = {(where, name): grown(samples, name) for where, samples in judged.items() for name in sizes}
    rows += [[f"change {where}", *(changes[where, name] for name in sizes)] for where in judged]
    first, last = course.objects[0], course.objects[-1]
    types = [[f"`{name}`", first[name], last[name]] for name, _ in (last - first).most_common(SHOWN_TYPES)]
    minutes = course.at_rest[-1].minute
    tables = [
        Table(heads, rows, f"At rest after each lesson; the first {warm_up:g} minutes are not judged"),
        Table(
            ["objects of Python at rest", "after the warm-up", "at the end"],
            [["all", first.total(), last.total()], *types],
            "The types that grew most",
        ),
        Table(
            ["memory of `malloc` at rest, MB", "after the warm-up", "at the end"],
            [
                [what, *(one[what] for one in (course.malloc_mb[0], course.malloc_mb[-1]))]
                for what in ("in use", "free")
            ],
            "The C library keeps what is free",
        ),
        Table(["action", "number"], sorted(course.counts.items()), f"Visitors in {minutes:.0f} minutes"),
    ]
    goals = [
        Goal(f"more {what} at rest", 0, round(changes["at rest", name]))
        for name, what in (("descriptors", "descriptors"), ("threads", "threads"), ("shared_files", "shared files"))
    ]
    objects = 100 * (last.total() - first.total()) / first.total()
    goals += [
        Goal("growth of objects of Python at rest", MOST_PERCENT, objects, "%"),
        Goal("visits that failed", 0, len(course.failures)),
        *(Goal(f"after the end: {what}", 0, count) for what, count in end.items()),
    ]
    return Report(tables, goals)


def after(samples: Sequence[Sample], minute: float) -> Sequence[Sample]:
    """Samples from a minute on, at least two."""
    return [one for one in samples if one.minute >= minute] if samples[-2].minute >= minute else samples[-2:]


def grown(samples: Sequence[Sample], name: str) -> float:
    """By how much a size has changed."""
    return change([one.minute for one in samples], [getattr(one, name) for one in samples])
