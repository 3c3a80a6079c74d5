"""Notices: above an open dialog, removed with their cause; success notices disappear. The teacher's message."""

from __future__ import annotations

import json

import pytest

playwright = pytest.importorskip("playwright.sync_api")

from tests.bridge.studio import set_and_answer
from tests.web_ui.page_support import (
    MARKS,
    build_playground,
    choose_playground,
    drop_file,
    open_page,
    open_tab,
    resize,
    wait_for_none,
)
from tests.web_ui.test_gallery import open_gallery
from tests.web_ui.test_welcome import visit
from thymio_sim_ros.bridge.protocol import messages as ms

pytestmark = MARKS

ON_TOP = """(notice) => {
    const {left, top, width, height} = notice.getBoundingClientRect();
    return notice.contains(document.elementFromPoint(left + width / 2, top + height / 2));
}"""


DIALOG = """() => {
    const dialog = document.createElement("dialog");
    dialog.textContent = "A dialog";
    document.body.append(dialog);
    dialog.showModal();
}"""


FAULTS_OF_A_NOTE = """([selector, text]) => {
    const note = document.querySelector(selector);
    if (!note?.checkVisibility()) return [`no ${selector} to be seen`];
    const {left, right, top, bottom} = note.getBoundingClientRect();
    const words = note.querySelector(text).getBoundingClientRect();
    const nameOf = (one) => one === null ? "nothing"
        : `${one.localName}#${one.id}.${one.className}: ${one.textContent.trim().slice(0, 40)}`;
    const above = [words.top + 5, words.bottom - 5].map((y) => document.elementFromPoint(words.left + 5, y))
        .filter((one) => !note.contains(one)).map((one) => `under ${nameOf(one)}`);
    const needed = [...document.querySelectorAll(
        ".welcome-start, .welcome-watch, .welcome-tour, .views .btn, .placing-hints > *, #trouble, #tray .btn,"
        + " #tray .hand, #time .btn, #work .btn, .build-tool")].filter((one) =>
        !note.contains(one) && one.checkVisibility({visibilityProperty: true}));
    const isScrolledOut = (one, {top, bottom}) => {
        const panel = one.closest(".panel")?.getBoundingClientRect();
        return panel !== undefined && (bottom <= panel.top || top >= panel.bottom);
    };
    const covered = needed.filter((one) => {
        const other = one.getBoundingClientRect();
        if (isScrolledOut(one, other)) return false;
        return other.left < right && other.right > left && other.top < bottom && other.bottom > top;
    }).map((one) => `over ${nameOf(one)}`);
    return [...above, ...covered];
}"""
"""What is wrong with a note: it is not seen, lies under something, or over something that people need."""


TEACHER_NOTE = (".teacher-note", ".teacher-words")
NOTICE = (".notice", "p")
SMALL = [(683, 384), (390, 844), (360, 640)]
"""Windows: a laptop's at 200 % zoom, phones."""


@pytest.mark.slow
@pytest.mark.parametrize("size", SMALL)
def test_a_notice_covers_nothing_where_a_tab_takes_the_place_of_the_view(at_rest, page, tmp_path, size):
    unknown = tmp_path / "song.mp3"
    unknown.write_bytes(b"")
    page.set_viewport_size({"width": size[0], "height": size[1]})
    open_page(page, at_rest)
    for name in ("program", "robot"):
        open_tab(page, name)
        page.set_input_files("#playground-file", str(unknown))
        page.locator(".notice", has_text="song.mp3").wait_for()
        wait_for_none(page, FAULTS_OF_A_NOTE, NOTICE)
        page.locator(".notice").get_by_role("button").click()


@pytest.mark.slow
@pytest.mark.parametrize("size", [*SMALL, (1366, 768)])
def test_a_teachers_message_is_seen_in_every_tab_and_covers_nothing(world, page, size):
    page.set_viewport_size({"width": size[0], "height": size[1]})
    address = world("line", "welcome")
    with world.client() as client:
        set_and_answer(client, ms.Parameter("/web_ui.notice", "Look at the board now: we compare the first results."))
    visit(page, address, "welcome=on")
    page.locator(".welcome-starts").wait_for()
    wait_for_none(page, FAULTS_OF_A_NOTE, TEACHER_NOTE)
    page.locator("[data-start=drive]").click()
    page.locator(".welcome-starts").wait_for(state="detached")
    wait_for_none(page, FAULTS_OF_A_NOTE, TEACHER_NOTE)
    for name in ("robot", "program", "playground"):
        open_tab(page, name)
        wait_for_none(page, FAULTS_OF_A_NOTE, TEACHER_NOTE)
    build_playground(page)
    page.locator(".build-tool").nth(1).click()
    page.locator(".placing-hints").get_by_role("button").first.wait_for()
    wait_for_none(page, FAULTS_OF_A_NOTE, TEACHER_NOTE)


@pytest.mark.slow
def test_a_fallen_robot_is_put_back_beside_a_long_message_of_the_teacher(world, page, tmp_path):
    ground = {"kind": "rectangle", "size_x_m": 0.8, "size_y_m": 0.8, "color": "#ffffff"}
    robots = [{"name": "thymio", "x_m": 0.25, "y_m": 0}]
    playground, program = tmp_path / "table.json", tmp_path / "off.aesl"
    playground.write_text(json.dumps({"format": 1, "title": "Table", "shapes": [ground], "robots": robots}))
    program.write_text("motor.left.target = 300\nmotor.right.target = 300\n")
    address = world(playground, program)
    with world.client() as client:
        set_and_answer(client, ms.Parameter("/web_ui.notice", "Look at the board: we compare the first results. " * 4))
    page.emulate_media(reduced_motion="reduce")
    open_page(page, address, unfold=False)
    page.locator("[data-fallen]").wait_for()
    for width, height in (*SMALL, (640, 360), (195, 422), (1366, 768)):
        resize(page, width, height)
        wait_for_none(page, FAULTS_OF_A_NOTE, (".fallen", "button"))
        wait_for_none(page, FAULTS_OF_A_NOTE, TEACHER_NOTE)


@pytest.mark.slow
def test_the_name_of_a_pupil_and_the_stop_button_are_whole_on_a_phone(world, page):
    page.set_viewport_size({"width": 360, "height": 640})
    address = world("base")
    with world.client() as client:
        set_and_answer(client, ms.Parameter("/web_ui.pupil", "Jürgen"))
    open_page(page, address)
    playwright.expect(page.locator("#pupil > .name")).to_have_text("Jürgen")
    page.wait_for_function(
        "() => [...document.querySelectorAll('#pupil > .name, #stop > span')]"
        ".every((one) => one.scrollWidth <= one.clientWidth)"
    )


@pytest.mark.slow
def test_a_message_is_above_an_open_dialog_and_can_be_closed_there(at_rest, page, tmp_path):
    unknown = tmp_path / "song.mp3"
    unknown.write_bytes(b"")
    open_gallery(page, at_rest)
    page.evaluate(DIALOG)
    page.set_input_files("#playground-file", str(unknown))
    notice = page.locator(".notice", has_text="song.mp3")
    notice.wait_for()
    page.wait_for_function(ON_TOP, arg=notice.element_handle())
    notice.get_by_role("button").click()
    playwright.expect(notice).to_have_count(0)
    page.set_input_files("#playground-file", str(unknown))
    notice.wait_for()
    page.keyboard.press("Escape")
    page.locator("#view").hover()  # draws a frame
    page.wait_for_function("() => document.querySelector('#messages > .notices .notice') !== null")
    page.wait_for_function(ON_TOP, arg=notice.element_handle())


@pytest.mark.slow
def test_the_tab_does_not_show_the_error_of_another_attempt(at_rest, page, tmp_path):
    broken, unknown = tmp_path / "broken.json", tmp_path / "song.mp3"
    broken.write_text('{"format": 1, "title": 3}')
    unknown.write_bytes(b"")
    open_gallery(page, at_rest)
    fault = page.locator(".current > .fault")
    page.set_input_files("#playground-file", str(broken))
    playwright.expect(fault).to_contain_text("broken.json")
    page.set_input_files("#playground-file", str(unknown))
    playwright.expect(page.locator(".notice")).to_contain_text("song.mp3")
    playwright.expect(fault).to_be_hidden()
    page.set_input_files("#playground-file", str(broken))
    playwright.expect(fault).to_contain_text("broken.json")
    fault.get_by_role("button").click()
    playwright.expect(fault).to_be_hidden()


@pytest.mark.slow
def test_success_notices_disappear_and_errors_stay_until_closed(world, page, tmp_path):
    program, unknown = tmp_path / "good.aesl", tmp_path / "song.mp3"
    program.write_text("var a = 1\n")
    unknown.write_bytes(b"")
    open_page(page, world("base"))
    page.set_input_files("#playground-file", str(unknown))
    page.locator(".notice.error").wait_for()
    with page.expect_download():
        page.locator("[data-view=picture]").click()
    page.locator(".notice.info").wait_for()
    playwright.expect(page.locator(".notice.info")).to_have_count(0)
    page.locator(".notice.error button").click()
    playwright.expect(page.locator(".notice")).to_have_count(0)
    drop_file(page, program, "#view")
    playwright.expect(page.locator(".notice.info")).to_contain_text("good.aesl is loaded")
    playwright.expect(page.locator(".notice.info")).to_have_count(0)


@pytest.mark.slow
def test_one_message_is_shown_at_a_time_and_the_next_one_follows(at_rest, page, tmp_path):
    files = [tmp_path / name for name in ("song.mp3", "film.mp4")]
    for file in files:
        file.write_bytes(b"")
    open_page(page, at_rest)
    page.locator("[data-view=move]").click()
    hint = page.locator(".messages .hint")
    playwright.expect(hint).to_be_visible()
    for file in files:
        page.set_input_files("#playground-file", str(file))
    playwright.expect(page.locator(".notice:visible")).to_have_count(1)
    playwright.expect(page.locator(".notice:visible")).to_contain_text("film.mp4")
    playwright.expect(hint).to_be_hidden()
    page.locator(".notice:visible button").click()
    playwright.expect(page.locator(".notice:visible")).to_contain_text("song.mp3")
    page.locator(".notice:visible button").click()
    playwright.expect(hint).to_be_visible()


@pytest.mark.slow
def test_a_new_playground_fades_in(world, page):
    open_page(page, world("base"))
    page.evaluate(
        "() => new MutationObserver(() => { window.arrived = true; })"
        ".observe(document.querySelector('#stage'), {attributeFilter: ['data-arriving']})"
    )
    choose_playground(page, "maze")
    page.wait_for_function("() => window.arrived && !document.querySelector('#stage').hasAttribute('data-arriving')")
