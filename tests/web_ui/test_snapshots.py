"""Twelve states of the page look as they are kept in tests/data/web/snapshots; `--update-snapshots` keeps new ones."""

from __future__ import annotations

import io
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from PIL import Image, ImageDraw

playwright = pytest.importorskip("playwright.sync_api")

from tests.web_ui.page_support import MARKS, choose_language, choose_playground, open_menu, open_tab, wait_for_frame
from tests.web_ui.snapshots import MOST, SHRINK, Snapshots, font_script, letters, share, shrunk, shrunk_already
from tests.web_ui.tabs import checked_page

FOLDER = Path(__file__).parents[1] / "data" / "web" / "snapshots"
MISTAKE = "var near = 2000\nonevent prox\nif prox.horizontal[2] = near then\nmotor.left.target = 0\nend\n"
READY = "window.thymio && window.thymio.connected && window.thymio.partPosition('robot')"
FEW_ROBOTS = "() => Object.keys(window.thymio.state().robots).length === 1"
QUIET = """
    .sample img, .current img, .clock, .real { visibility: hidden; }
    .time-parts:not([data-names="all"]) > .real { display: none !important; }
"""
"""Thumbnails are drawn one after another, time runs, and a busy machine shows how slowly, where there is room."""

State = Callable[[Any], None]


def first_visit(page: Any) -> None:
    page.locator(".welcome-starts").wait_for()


def robot(page: Any) -> None:
    open_tab(page, "robot")
    page.locator(".picture svg").wait_for()
    page.wait_for_function("() => window.thymio.state().robot.raw.proximity !== undefined")


def program(page: Any) -> None:
    open_tab(page, "program")
    page.locator(".program[data-shown=start]").wait_for()


def mistake(page: Any) -> None:
    program(page)
    page.click("[data-new=empty]")
    page.focus(".cm-content")
    page.keyboard.insert_text(MISTAKE)
    page.locator(".mistake-card").wait_for()
    page.locator(".values [data-variable]").first.wait_for()


def playground(page: Any) -> None:
    open_tab(page, "playground")
    page.locator(".gallery .sample").first.wait_for()


def creator(page: Any) -> None:
    open_tab(page, "playground")
    page.click(".current [data-new]")
    page.click("[data-tool=box]")
    page.locator(".placing-hint").wait_for()


def many(page: Any) -> None:
    open_tab(page, "playground")
    choose_playground(page, "classroom")
    page.locator("#tab-class").wait_for()
    open_tab(page, "class")
    page.locator(".class-tile").nth(19).wait_for()
    page.wait_for_function("() => document.querySelectorAll('#labels .dot:not([hidden])').length === 20")


def help_menu(page: Any) -> None:
    robot(page)
    open_menu(page, "#help-open")


def german(page: Any) -> None:
    choose_language(page, "de")
    robot(page)


def nothing(_: Any) -> None:
    pass


WIDE = (1280, 800)
STATES: dict[str, tuple[State, tuple[int, int], str]] = {
    "first-visit": (first_visit, WIDE, "welcome=on"),
    "creator": (creator, WIDE, "welcome=off"),
    "robot": (robot, WIDE, "welcome=off&scene=off"),
    "robot-dark": (robot, WIDE, "welcome=off&scene=off"),
    "program": (program, WIDE, "welcome=off&scene=off"),
    "mistake": (mistake, WIDE, "welcome=off&scene=off"),
    "playground": (playground, WIDE, "welcome=off&scene=off"),
    "help": (help_menu, WIDE, "welcome=off&scene=off"),
    "german-low": (german, (1280, 650), "welcome=off&scene=off"),
    "tablet": (robot, (1024, 768), "welcome=off&scene=off"),
    "phone": (nothing, (390, 844), "welcome=off&scene=off"),
    "class": (many, WIDE, "welcome=off"),
}
"""What to do, the size of the window, options in the address."""


@pytest.fixture
def address(world) -> str:
    """The page of a desk with a robot at rest."""
    return world("desk")


@pytest.fixture(scope="module")
def shared_page(browser) -> Iterator[Any]:
    """One page for all states: it is loaded again for each, and stored nothing."""
    for page in checked_page(browser, compares_pictures=True, reduced_motion="reduce"):
        page.add_init_script(font_script())
        page.add_init_script("localStorage.clear()")
        yield page


@pytest.fixture
def snapshots(request, tmp_path) -> Snapshots:
    return Snapshots(FOLDER, tmp_path / "snapshots", update=request.config.getoption("--update-snapshots"))


def show(page: Any, address: str, name: str) -> None:
    """Bring the page into a state."""
    act, (width, height), options = STATES[name]
    page.set_viewport_size({"width": width, "height": height})
    page.emulate_media(color_scheme="dark" if name.endswith("dark") else "light", reduced_motion="reduce")
    page.goto(f"{address}?tour=off&{options}")
    page.add_style_tag(content=QUIET)
    page.wait_for_function(READY)
    act(page)
    if "scene=off" not in options:
        page.wait_for_function("() => window.thymio.isPainted()")  # the wood is, when there is time
        wait_for_frame(page)
    page.mouse.move(0, 0)


def picture(page: Any) -> bytes:
    png: bytes = page.screenshot(animations="disabled")
    return png


class TestPage:
    pytestmark = MARKS

    @pytest.mark.slow
    @pytest.mark.parametrize("name", STATES)
    def test_it_looks_as_it_did(self, shared_page, address, snapshots, name):
        show(shared_page, address, name)
        snapshots.check(name, picture(shared_page))

    @pytest.mark.slow
    def test_a_panel_that_moves_is_noticed_and_another_rendering_of_text_is_not(self, shared_page, address):
        show(shared_page, address, "robot")
        before = shrunk(picture(shared_page))
        other = "* { -webkit-text-stroke: 0.2px; text-rendering: geometricPrecision; }"
        thick = shared_page.add_style_tag(content=other)
        assert share(before, shrunk(picture(shared_page))) <= MOST
        thick.evaluate("(style) => style.remove()")
        for panel in ("#work", "#tray", ".view-row"):
            moved = shared_page.add_style_tag(content=f"{panel} {{ transform: translate(24px); }}")
            assert share(before, shrunk(picture(shared_page))) > MOST, panel
            moved.evaluate("(style) => style.remove()")


def drawn(*, at: int = 700, shift: int = 0, ink: str = "#25221f") -> Image.Image:
    """A page with two panels, one of them at a place; its text a pixel beside, or thinner, or thicker."""
    image = Image.new("RGB", (1280, 800), "#f7f5f0")
    pen = ImageDraw.Draw(image)
    for left, width in ((20, 600), (at, 480)):
        pen.rounded_rectangle((left, 60, left + width, 780), 12, "white", "#d9d4c8")
        for row in range(24):
            words = "what the robot notices, and what it does"
            pen.text((left + 24 + shift, 80 + 28 * row), words, ink, font=letters())
    return shrunk(png_of(image))


def png_of(image: Image.Image) -> bytes:
    file = io.BytesIO()
    image.save(file, "png")
    return file.getvalue()


def test_the_comparison_notices_a_panel_that_moved_by_24_pixels_but_no_other_rendering_of_text():
    before = drawn()
    assert share(before, before) == 0
    for rendering in (drawn(shift=1), drawn(shift=-1), drawn(ink="#4a4641"), drawn(ink="black")):
        assert rendering != before
        assert share(before, rendering) <= MOST
    assert share(before, drawn(at=724)) > 5 * MOST
    assert share(before, drawn(at=676)) > 5 * MOST


@pytest.mark.parametrize("name", STATES)
def test_in_every_kept_picture_a_part_that_moved_by_24_pixels_is_noticed(name):
    kept = shrunk_already(FOLDER / f"{name}.png")
    width, height = kept.size
    for box in ((0, 2 * height // 3, width, height), (width // 2, 0, width, height)):
        for place in ((box[0] + 24 // SHRINK, box[1]), (box[0], box[1] + 24 // SHRINK)):
            moved = kept.copy()
            moved.paste(kept.crop(box), place)
            assert share(kept, moved) > MOST, (box, place)


def test_a_difference_is_shown_in_two_pictures_that_the_message_names(tmp_path):
    snapshots = Snapshots(tmp_path / "kept", tmp_path / "found")
    before, after = (Image.new("RGB", (1280, 800), color) for color in ("white", "white"))
    ImageDraw.Draw(after).rectangle((100, 100, 500, 500), "black")
    with pytest.raises(AssertionError, match="--update-snapshots"):
        snapshots.check("page", png_of(before))
    Snapshots(snapshots.folder, snapshots.found, update=True).check("page", png_of(before))
    snapshots.check("page", png_of(before))
    with pytest.raises(AssertionError, match=str(snapshots.found)):
        snapshots.check("page", png_of(after))
    shown = Image.open(snapshots.found / "page-differences.png").convert("RGB")
    assert shown.size == (1280, 800)
    assert shown.getpixel((300, 300)) != shown.getpixel((900, 600))
    with pytest.raises(AssertionError, match=r"100\.0 %"):
        snapshots.check("page", png_of(before.resize((640, 400))))
