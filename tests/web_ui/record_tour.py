"""Record the animated picture of the README from the page: writes docs/tour.webp.

    python -m tests.web_ui.record_tour

A robot follows the line, another one avoids obstacles, and its program is edited while it runs. The suite runs at a
quarter of real time, so that a slow machine draws all frames; each is shown for the simulated time until the next one.
Needs what browser tests need.
"""

from __future__ import annotations

import io
import itertools
import tempfile
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from PIL import Image
from playwright.sync_api import Browser, Page, sync_playwright

from tests.patience import Deadline
from tests.processes import SUITE, Process, free_port
from tests.web_ui.conftest import CHROMIUM, FLAGS
from tests.web_ui.page_support import open_page
from thymio_sim_ros.testing.ros.domain import reserved

TARGET = Path(__file__).parents[2] / "docs" / "tour.webp"
MOST_BYTES = 1_500_000
SIZE = {"width": 960, "height": 600}
PACE = 0.25
"""Simulated per wall time."""
FRAME_S = 0.15
"""Least simulated time between frames."""
QUALITY = 60
PROGRAM = """var speed = 150

onevent prox
  motor.left.target = speed
  motor.right.target = speed
  if prox.horizontal[2] > 1500 then
    motor.right.target = -speed
  end
"""
EDIT = "call leds.top(0, 32, 0)"

Frames = list[tuple[Image.Image, float]]
"""Pictures, and when they were taken."""


@contextmanager
def opened(browser: Browser, *arguments: str) -> Iterator[Page]:
    """A page with a suite of its own."""
    with reserved(), tempfile.TemporaryDirectory() as folder:
        port = free_port()
        ports = ("--port", str(port), "--foxglove-port", str(free_port()))
        program = Path(folder, "avoid.aesl")
        program.write_text(PROGRAM, encoding="utf-8")
        files = [str(program) if one == program.name else one for one in arguments]
        process = Process(Path(folder), SUITE, *ports, "--real-time-factor", str(PACE), *files)
        page = browser.new_page(viewport=SIZE, bypass_csp=True)
        try:
            open_page(page, f"http://127.0.0.1:{port}/", unfold=False)
            page.add_style_tag(content="label.speed, .real.small { visibility: hidden }")  # of the recording
            page.wait_for_function("window.thymio.frames() > 10")
            yield page
        finally:
            page.close()
            process.end()


def film(page: Page, seconds: float, act: Callable[[], Any] = lambda: None) -> Frames:
    """Take pictures for some seconds of simulated time; `act` is called between them."""
    frames: Frames = []
    end = Deadline(seconds / PACE)
    while not end.is_over:
        now_s = time.monotonic()
        picture = Image.open(io.BytesIO(page.screenshot(type="png"))).convert("RGB")
        frames.append((picture, now_s))
        act()
        page.wait_for_timeout(max(0.0, 1000 * (FRAME_S / PACE + now_s - time.monotonic())))
    return [*frames, (frames[-1][0], time.monotonic())]


def scenes(browser: Browser) -> Iterator[Frames]:
    """Film the scenes."""
    with opened(browser, "--playground", "line", "--program", "line_follower") as page:
        yield film(page, 5.0)
    with opened(browser, "--playground", "obstacle", "--program", "avoid.aesl") as page:
        yield film(page, 4.0)
        page.click("#tab-program")
        page.wait_for_selector(".cm-content")
        page.focus(".cm-content")
        page.keyboard.press("Control+End")
        letters = iter(EDIT)
        yield film(page, 4.0, lambda: page.keyboard.insert_text(next(letters, "")))
        page.keyboard.insert_text("".join(letters))
        page.get_by_role("button", name="Run program").click()
        yield film(page, 3.0)


def main() -> None:
    """Write the file. Raises SystemExit if it is too large."""
    with sync_playwright() as playing:
        browser = playing.chromium.launch(executable_path=CHROMIUM, args=FLAGS)
        taken = list(scenes(browser))
        browser.close()
    pictures, durations = [], []
    for frames in taken:
        for (picture, at), (_, following) in itertools.pairwise(frames):
            pictures.append(picture)
            durations.append(round(1000 * PACE * (following - at)))
    options: dict[str, Any] = {"quality": QUALITY, "method": 6, "minimize_size": True, "loop": 0}
    pictures[0].save(TARGET, save_all=True, append_images=pictures[1:], duration=durations, **options)
    size = TARGET.stat().st_size
    print(f"{TARGET}: {len(pictures)} frames, {sum(durations) / 1000:.0f} s, {size / 1000:.0f} kB")
    if size > MOST_BYTES:
        raise SystemExit(f"{TARGET}: {size} bytes, expected at most {MOST_BYTES}")


if __name__ == "__main__":
    main()
