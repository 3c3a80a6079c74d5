"""The page in a real browser: python benchmarks/page.py [--seconds S] [--rounds N] [--robots N] [--size WxH]

Prints what a class waits for and pays for: the first picture of the 3D view, what is loaded before the editor is
opened, requests to other hosts, and the frames per second with one robot and with many, each driving in its own circle.
The suite, the browser and (without a GPU) the drawing share the processor, as on a pupil's laptop. Needs Chromium,
Playwright and ROS.
"""

from __future__ import annotations

import argparse
import gzip
import json
import shutil
import statistics
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from playwright.sync_api import Browser, Page, sync_playwright

from tests.processes import Process, free_port, wait_for_port

CHROMIUM = shutil.which("chromium") or shutil.which("chromium-browser") or shutil.which("google-chrome")
FLAGS = ["--no-sandbox", "--enable-unsafe-swiftshader", "--disable-background-networking", "--no-first-run"]
DEADLINE_MS = 120_000
SPACING_M = 0.5
CIRCLE = "motor.left.target = 100\nmotor.right.target = 200\n"
NOTE_FIRST_PICTURE = """
const watch = () => {
  const state = window.thymio?.state();
  const isDrawn = state?.markers > 0 && state.robot?.latest && window.thymio.frames() > 2;
  if (isDrawn) window.firstPictureMs = performance.now();
  else requestAnimationFrame(watch);
};
requestAnimationFrame(watch);
"""
PAINT = "() => performance.getEntriesByName('first-contentful-paint')[0]?.startTime ?? null"


@dataclass(frozen=True)
class Loading:
    """What one visit cost: milliseconds to the page and to the 3D picture, bytes, requests."""

    paint_ms: float
    picture_ms: float
    transferred: int
    compressed: int
    requests: int
    foreign: int


def playground(folder: Path, robots: int) -> Path:
    """A walled square with robots in rows."""
    columns = next(count for count in range(1, robots + 1) if count * count >= robots)
    places = [(index % columns, index // columns) for index in range(robots)]
    middle = (columns - 1) / 2
    size_m = (columns + 1) * SPACING_M
    shapes = [
        {"kind": "rectangle", "size_x_m": size_m, "size_y_m": size_m, "color": "#eef2f6"}
        | {"walls": {"height_m": 0.1, "thickness_m": 0.02, "color": "#5c6b73"}}
    ]
    placed = [
        {"name": f"thymio_{number}", "x_m": (x - middle) * SPACING_M, "y_m": (y - middle) * SPACING_M}
        for number, (x, y) in enumerate(places)
    ]
    path = folder / f"robots_{robots}.json"
    path.write_text(json.dumps({"format": 1, "title": "Many robots", "shapes": shapes, "robots": placed}))
    return path


@contextmanager
def suite(folder: Path, robots: int) -> Iterator[str]:
    """The running suite; gives the page's address."""
    program = folder / "circle.aesl"
    program.write_text(CIRCLE)
    port, foxglove_port = free_port(), free_port()
    ports = ("--port", str(port), "--foxglove-port", str(foxglove_port))
    world = ("--playground", str(playground(folder, robots)), "--program", str(program))
    process = Process(folder, "thymio_sim_ros.cli.main", *ports, *world)
    try:
        wait_for_port(port)
        wait_for_port(foxglove_port)
        yield f"http://127.0.0.1:{port}/"
    finally:
        process.end()


def visit(browser: Browser, address: str, size: tuple[int, int]) -> tuple[Page, Loading]:
    """Open the page and wait for robot and playground in the picture."""
    page = browser.new_page(viewport={"width": size[0], "height": size[1]}, bypass_csp=True)
    page.set_default_timeout(DEADLINE_MS)
    page.add_init_script(NOTE_FIRST_PICTURE)
    bodies: list[bytes] = []
    urls: list[str] = []
    page.on("request", lambda request: urls.append(request.url))
    page.on("requestfinished", lambda request: bodies.append(request.response().body()))
    sizes: list[float] = []
    developer = page.context.new_cdp_session(page)
    developer.send("Network.enable")
    developer.on("Network.loadingFinished", lambda event: sizes.append(event["encodedDataLength"]))
    page.goto(f"{address}?tour=off")
    page.wait_for_function("() => window.firstPictureMs")
    loading = Loading(
        paint_ms=page.evaluate(PAINT),
        picture_ms=page.evaluate("() => window.firstPictureMs"),
        transferred=int(sum(sizes)),
        compressed=sum(len(gzip.compress(body, 6)) for body in bodies),
        requests=len(urls),
        foreign=sum(not url.startswith((address, "data:", "blob:")) for url in urls),
    )
    return page, loading


def drawing(browser: Browser, page: Page, robots: int, seconds: float, fineness: str) -> tuple[float, float]:
    """Pictures per second, and the browser's CPU time for each in ms, once all robots drive."""
    page.wait_for_function(
        "(count) => Object.values(window.thymio.state().robots).filter(({previous, latest}) =>"
        " previous && latest && previous.pose.yaw !== latest.pose.yaw).length === count",
        arg=robots,
    )
    page.select_option("#quality", fineness)
    page.wait_for_timeout(2000)
    developer = browser.new_browser_cdp_session()
    counts: list[tuple[float, int, float]] = []
    for _ in range(2):
        processes: Any = developer.send("SystemInfo.getProcessInfo")["processInfo"]
        frames, now_ms = page.evaluate("() => [window.thymio.frames(), performance.now()]")
        counts.append((now_ms, frames, sum(process["cpuTime"] for process in processes)))
        if len(counts) == 1:
            page.wait_for_timeout(1000 * seconds)
    (begin_ms, first, before_s), (end_ms, last, after_s) = counts
    return 1000 * (last - first) / (end_ms - begin_ms), 1000 * (after_s - before_s) / (last - first)


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--seconds", type=float, default=10.0)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--robots", type=int, default=20)
    parser.add_argument("--size", default="1280x720")
    parser.add_argument("--fineness", default="simple", help="auto, fine, medium or simple")
    options = parser.parse_args()
    width, height = map(int, options.size.split("x"))
    loadings: list[Loading] = []
    rates: dict[int, list[tuple[float, float]]] = {1: [], options.robots: []}
    with sync_playwright() as playing, tempfile.TemporaryDirectory() as folder:
        for _ in range(options.rounds):
            for robots, found in rates.items():
                browser = playing.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
                with suite(Path(folder), robots) as address:
                    visit(browser, address, (width, height))[0].close()  # the suite is up from now on
                    page, loading = visit(browser, address, (width, height))
                    if robots == 1:
                        loadings.append(loading)
                    found.append(drawing(browser, page, robots, options.seconds, options.fineness))
                    browser.close()
    best = min(loadings, key=lambda loading: loading.picture_ms)
    (one, one_ms), (many, many_ms) = (map(statistics.median, zip(*found, strict=True)) for found in rates.values())
    row("first paint", f"{statistics.median(each.paint_ms for each in loadings):.0f} ms", "")
    row("first picture of the 3D view", f"{statistics.median(each.picture_ms for each in loadings):.0f} ms", "2000 ms")
    row("loaded, as it came", f"{best.transferred / 1000:.0f} kB in {best.requests} requests", "")
    row("loaded, compressed", f"{best.compressed / 1000:.0f} kB", "800 kB")
    row("requests to other hosts", str(best.foreign), "0")
    row("pictures per second, 1 robot", f"{one:.1f}", "")
    row(f"pictures per second, {options.robots} robots", f"{many:.1f} ({many / one:.0%})", "80 %")
    row("CPU time of the browser for a picture, 1 robot", f"{one_ms:.1f} ms", "")
    row(f"CPU time of the browser for a picture, {options.robots} robots", f"{many_ms:.1f} ms", "")


def row(what: str, found: str, goal: str) -> None:
    """One line of the table."""
    print(f"| {what} | {found} | {goal} |")


if __name__ == "__main__":
    main()
