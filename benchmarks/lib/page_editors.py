"""The editors of the page in a real browser: their first paint, what they load, and frames while rows are dragged."""

from __future__ import annotations

import gzip
import time
from dataclasses import dataclass
from typing import Any

BLOCK = ".blocklyBlockCanvas .blocklyBlock"
EDITORS = {
    "text": ("#tab-program", ".cm-line"),
    "VPL": ("[data-new=vpl-avoid]", ".vpl-row"),
    "Blockly": ("[data-new=blocks-avoid]", BLOCK),
    "Scratch look": ("[data-new=blocks-scratch_avoid]", BLOCK),
}
"""What opens the editor where the robot runs a text, and what is painted then."""
ROWS = 30
PAINTED = """([opener, shown]) => new Promise((done) => {
  const start = performance.now();
  const watch = () => {
    if (document.querySelector(shown)?.getBoundingClientRect().height > 0)
      requestAnimationFrame(() => done(performance.now() - start));
    else requestAnimationFrame(watch);
  };
  document.querySelector(opener).click();
  requestAnimationFrame(watch);
})"""
COUNT_FRAMES = """() => {
  window.countedFrames = 0;
  const count = () => { window.countedFrames += 1; requestAnimationFrame(count); };
  requestAnimationFrame(count);
}"""


@dataclass(frozen=True)
class Opening:
    """From a click to blocks or lines, in ms; and what was loaded for that, compressed, in bytes."""

    paint_ms: float
    compressed: int


def open_editor(page: Any, name: str) -> Opening:
    """Open an editor, on a page that has not opened any yet."""
    opener, shown = EDITORS[name]
    if name != "text":
        page.click("#tab-program")
        page.locator(".program[data-shown=program]").wait_for()
        page.click("#file-menu")
        page.click("#file-sheet [data-verb=new]")
        page.locator(opener).wait_for()
    requests: list[Any] = []
    page.on("request", lambda request: requests.append(request))
    paint_ms = page.evaluate(PAINTED, [opener, shown])
    loaded = [request for request in requests if not request.url.startswith(("data:", "blob:"))]
    return Opening(paint_ms, sum(len(gzip.compress(request.response().body(), 6)) for request in loaded))


def list_of_missions_ms(page: Any) -> float:
    """From a click to the list of missions, in ms, on a page that has not opened it yet."""
    return float(page.evaluate(PAINTED, ["#missions-open", ".mission-choice"]))


def dragging(page: Any, seconds: float) -> float:
    """Frames per second while a row of a VPL program of `ROWS` rows is dragged; time of the playground is paused."""
    page.click("#pause")
    page.locator("[data-place='0 row 0']").focus()
    while page.locator(".vpl-row").count() <= ROWS:
        page.keyboard.press("Control+d")
        page.evaluate("() => new Promise(requestAnimationFrame)")
    first = page.locator("[data-place='0 row 0']")
    first.scroll_into_view_if_needed()
    box = first.bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x, y + 20)
    page.locator(".vpl-ghost").wait_for()
    page.evaluate(COUNT_FRAMES)
    begin_ms = page.evaluate("() => performance.now()")
    end = time.monotonic() + seconds
    at = 0
    while time.monotonic() < end:
        at = (at + 7) % 200
        page.mouse.move(x + at / 4, y + 20 + at)
    frames, end_ms = page.evaluate("() => [window.countedFrames, performance.now()]")
    page.mouse.up()
    return 1000 * float(frames) / float(end_ms - begin_ms)
