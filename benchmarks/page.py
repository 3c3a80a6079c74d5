"""The page in a real browser: loading, requests, frames per second and processor time; its editors.

Measured are the first frame of the 3D view, what is loaded before the editor is opened, requests to other hosts, and
the frames per second with one robot and with many, each driving in its own circle. The suite, the browser and (without
a GPU) the drawing share the processor, as on a pupil's laptop. Needs Chromium, Playwright, ROS and the built page.
"""

from __future__ import annotations

import argparse
import gzip
import shutil
import statistics
import tempfile
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from playwright.sync_api import Browser, Page, sync_playwright

from benchmarks.lib.command import MissingError
from benchmarks.lib.page_editors import EDITORS, ROWS, Opening, dragging, list_of_missions_ms, open_editor
from benchmarks.lib.processes import suite
from benchmarks.lib.report import Goal, Report, Table
from benchmarks.lib.scenes import grid
from thymio_sim_ros.files import resources

QUICK = {"rounds": 1, "seconds": 0.5, "settle": 0.1, "robots": 2, "fineness": ["simple"], "editors": ["VPL"]}
CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
FLAGS = ["--no-sandbox", "--enable-unsafe-swiftshader", "--disable-background-networking", "--no-first-run"]
DEADLINE_MS = 120_000
SPACING_M = 0.5
ENOUGH_FPS = {1: 30, 20: 24}
"""Least frames per second at full resolution, by the number of robots."""
CIRCLE = "motor.left.target = 100\nmotor.right.target = 200\n"
NOTE_FIRST_FRAME = """
const watch = () => {
  const state = window.thymio?.state();
  const isDrawn = state?.markers > 0 && state.robot?.latest && window.thymio.frames() > 2;
  if (isDrawn) window.firstFrameMs = performance.now();
  else requestAnimationFrame(watch);
};
requestAnimationFrame(watch);
"""
PAINT = "() => performance.getEntriesByName('first-contentful-paint')[0]?.startTime ?? null"


PAINT_S = 1.5
"""Longest time to the first paint of an editor."""
LIST_S = 0.5
"""Longest time to the first paint of the list of missions."""
MOST_KB = {"VPL": 60, "Blockly": 400}
"""What an editor may load when it is opened, compressed."""


@dataclass(frozen=True)
class Loading:
    """What one visit cost: milliseconds to the page and to the first frame of the 3D view, bytes, requests."""

    paint_ms: float
    frame_ms: float
    transferred: int
    compressed: int
    requests: int
    foreign: int


def visit(browser: Browser, address: str, size: tuple[int, int]) -> tuple[Page, Loading]:
    """Open the page and wait for robot and playground in the picture."""
    page = browser.new_page(viewport={"width": size[0], "height": size[1]}, bypass_csp=True)
    page.set_default_timeout(DEADLINE_MS)
    page.add_init_script(NOTE_FIRST_FRAME)
    bodies: list[bytes] = []
    urls: list[str] = []
    page.on("request", lambda request: urls.append(request.url))

    def note(request: Any) -> None:
        bodies.append(request.response().body())

    page.on("requestfinished", note)
    sizes: list[float] = []
    developer = page.context.new_cdp_session(page)
    developer.send("Network.enable")
    developer.on("Network.loadingFinished", lambda event: sizes.append(event["encodedDataLength"]))
    page.goto(f"{address}?tour=off&welcome=off")
    page.wait_for_function("() => window.firstFrameMs")
    page.remove_listener("requestfinished", note)
    loading = Loading(
        paint_ms=page.evaluate(PAINT),
        frame_ms=page.evaluate("() => window.firstFrameMs"),
        transferred=int(sum(sizes)),
        compressed=sum(len(gzip.compress(body, 6)) for body in bodies),
        requests=len(urls),
        foreign=sum(not url.startswith((address, "data:", "blob:")) for url in urls),
    )
    return page, loading


def drawing(
    browser: Browser, page: Page, robots: int, fineness: str, options: argparse.Namespace
) -> tuple[float, float]:
    """Frames per second, and the browser's CPU time for each in ms, once all robots drive."""
    page.wait_for_function(
        "(count) => Object.values(window.thymio.state().robots).filter(({previous, latest}) =>"
        " previous && latest && previous.pose.yaw !== latest.pose.yaw).length === count",
        arg=robots,
    )
    page.click("[data-view=look]")
    page.select_option("#quality", fineness)
    page.keyboard.press("Escape")
    page.wait_for_timeout(1000 * options.settle)
    developer = browser.new_browser_cdp_session()
    counts: list[tuple[float, int, float]] = []
    for _ in range(2):
        processes: Any = developer.send("SystemInfo.getProcessInfo")["processInfo"]
        frames, now_ms = page.evaluate("() => [window.thymio.frames(), performance.now()]")
        counts.append((now_ms, frames, sum(process["cpuTime"] for process in processes)))
        if len(counts) == 1:
            page.wait_for_timeout(1000 * options.seconds)
    (begin_ms, first, before_s), (end_ms, last, after_s) = counts
    return 1000 * (last - first) / (end_ms - begin_ms), 1000 * (after_s - before_s) / (last - first)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add options."""
    parser.add_argument("--rounds", type=int, default=3, help="rounds; the figures are their medians")
    parser.add_argument("--seconds", type=float, default=8.0, help="for which frames are counted")
    parser.add_argument("--settle", type=float, default=2.0, help="seconds before frames are counted")
    parser.add_argument("--robots", type=int, default=20, help="of the scene with many")
    parser.add_argument("--size", default="1280x800", help="of the window, in pixels")
    names = ("auto", "fine", "medium", "simple")
    fineness = "resolutions; medium is full, with nothing left out"
    parser.add_argument("--editors", nargs="+", choices=list(EDITORS), default=list(EDITORS), help="editors to open")
    parser.add_argument("--fineness", nargs="+", choices=names, default=["medium", "auto"], help=fineness)


def measure(options: argparse.Namespace) -> Report:
    """Visit suites with one robot and with many, in turn."""
    if CHROMIUM is None:
        raise MissingError("program", "chromium")
    if resources.page() is None:
        raise MissingError("file", "web_ui/dist/index.html")
    width, height = map(int, options.size.split("x"))
    loadings: list[Loading] = []
    counts = (1, options.robots)
    rates: dict[tuple[int, str], list[tuple[float, float]]] = {
        (robots, fineness): [] for robots in counts for fineness in options.fineness
    }
    openings: dict[str, list[Opening]] = {name: [] for name in options.editors}
    drags: list[float] = []
    lists_ms: list[float] = []
    with sync_playwright() as playing, tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        program = folder / "circle.aesl"
        program.write_text(CIRCLE)
        for _ in range(options.rounds):
            for robots in counts:
                world = folder / f"robots_{robots}.json"
                world.write_text(grid(robots, SPACING_M, prefix="thymio_", walls=True))
                browser = playing.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
                with suite("--playground", str(world), "--program", str(program)) as running:
                    address = f"http://127.0.0.1:{running.page_port}/"
                    visit(browser, address, (width, height))[0].close()  # the suite is up from now on
                    page, loading = visit(browser, address, (width, height))
                    if robots == 1:
                        loadings.append(loading)
                    for fineness in options.fineness:
                        rates[robots, fineness].append(drawing(browser, page, robots, fineness, options))
                    page.close()
                    for editor in options.editors if robots == 1 else ():
                        page, _ = visit(browser, address, (width, height))
                        openings[editor].append(open_editor(page, editor))
                        if editor == "VPL":
                            drags.append(dragging(page, options.seconds))
                        page.close()
                    if robots == 1:
                        page, _ = visit(browser, address, (width, height))
                        lists_ms.append(list_of_missions_ms(page))
                    browser.close()
    report = _report(loadings, rates)
    table, goals = _editors(openings, drags)
    missions = Goal("first paint of the list of missions", LIST_S, statistics.median(lists_ms) / 1000, "s")
    return Report([*report.tables, table], [*report.goals, *goals, missions])


def _editors(openings: dict[str, list[Opening]], drags: list[float]) -> tuple[Table, list[Goal]]:
    rows: list[list[str | float]] = []
    goals: list[Goal] = []
    for editor, found in openings.items():
        paint_s = statistics.median(each.paint_ms for each in found) / 1000
        loaded_kb = min(each.compressed for each in found) / 1000
        rows.append([editor, paint_s, loaded_kb])
        goals.append(Goal(f"first paint of an editor, {editor}", PAINT_S, paint_s, "s"))
        if editor in MOST_KB:
            goals.append(Goal(f"loaded for an editor, compressed, {editor}", MOST_KB[editor], loaded_kb, "kB"))
    if drags:
        what = f"frames per second while a row of {ROWS} is dragged, time paused"
        goals.append(Goal(what, 60, round(statistics.median(drags)), is_least=True))
    return Table(["editor", "first paint, s", "loaded when opened, compressed, kB"], rows), goals


def _report(loadings: list[Loading], rates: dict[tuple[int, str], list[tuple[float, float]]]) -> Report:
    best = min(loadings, key=lambda loading: loading.frame_ms)
    frame_s = statistics.median(each.frame_ms for each in loadings) / 1000
    loaded_kb = best.compressed / 1000
    rows = [
        ["first paint, s", statistics.median(each.paint_ms for each in loadings) / 1000],
        ["first frame of the 3D view, with robot and playground, s", frame_s],
        ["loaded before the editor is opened, compressed, kB", loaded_kb],
        ["loaded before the editor is opened, as transferred, kB", best.transferred / 1000],
        ["requests", best.requests],
        ["requests to other hosts", best.foreign],
    ]
    goals = [
        Goal("first frame of the 3D view", 1.2, frame_s, "s"),
        Goal("loaded before the editor is opened, compressed", 300, loaded_kb, "kB"),
        Goal("requests to other hosts", 0, best.foreign),
    ]
    medians = {key: tuple(map(statistics.median, zip(*found, strict=True))) for key, found in rates.items()}
    frames = [[f"{fineness} resolution, {_counted(robots)}", *found] for (robots, fineness), found in medians.items()]
    goals += [
        Goal(f"frames per second, {_counted(robots)}, full resolution", ENOUGH_FPS[robots], found[0], is_least=True)
        for (robots, fineness), found in medians.items()
        if fineness == "medium" and robots in ENOUGH_FPS
    ]
    head = ["", "frames per second", "CPU of the browser, ms per frame"]
    return Report([Table(["", "measured"], rows), Table(head, frames)], goals)


def _counted(robots: int) -> str:
    return "1 robot" if robots == 1 else f"{robots} robots"
