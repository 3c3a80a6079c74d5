"""The Aseba editor in a real Chromium against the running suite: errors, breakpoints, variables, events, files."""

from __future__ import annotations

import pytest

playwright = pytest.importorskip("playwright.sync_api")

from tests.web_ui.page_support import (
    KEY_MS,
    MARKS,
    choose_in_file_menu,
    choose_language,
    choose_robot,
    drop_file,
    open_editor,
    open_page,
    open_tab,
    wait_for_frame,
    wait_for_service,
    watch_it_avoid,
)

pytestmark = MARKS

PROGRAM = """\
var count = 0
timer.period[0] = 50
onevent timer0
count = count + 1
if count > 30000 then
count = 0
end
"""

AVOIDER = """\
onevent prox
motor.left.target = 200
motor.right.target = 200
if prox.horizontal[0] > 0 or prox.horizontal[2] > 1500 then
motor.right.target = -200
end
"""


@pytest.fixture
def editor(at_rest, page):
    """The editor, open and empty, of a robot at rest."""
    open_page(page, at_rest)
    open_editor(page)
    wait_for_service(page, "/aseba_runtime/check", "/aseba/set_variables", "/aseba/step_line")
    return page


RECENT = "[data-recent]"
CARD = ".mistake-card"
EDITED = ".values-list input"


def write(page, text):
    """Replace the program by typing, without the editor's own indentation and brackets."""
    page.focus(".cm-content")
    page.keyboard.press("Control+a")
    page.keyboard.insert_text(text)


def expect(page, selector, **options):
    return playwright.expect(page.locator(selector, **options))


def click_beside(page, line):
    """Click the gutter beside a line, which sets a breakpoint."""
    gutter = page.locator(".code .breakpoints").bounding_box()
    number = page.locator(".cm-lineNumbers .cm-gutterElement:visible", has_text=str(line)).first.bounding_box()
    page.mouse.click(gutter["x"] + gutter["width"] / 2, number["y"] + number["height"] / 2)


def edit_variable(page, name, text):
    """Type a new value; returns the element that shows it."""
    value = page.locator(f"[data-variable='{name}']")
    value.click()
    page.locator(EDITED).fill(text)
    page.keyboard.press("Enter")
    return value


def test_a_broken_program_is_marked_while_it_is_typed_and_one_that_avoids_runs(editor, world):
    write(editor, "onevent prox\nmotor.left.targt = 1\n")
    expect(editor, ".verdict").to_have_text("1 mistake, line 2")
    expect(editor, CARD).to_contain_text("motor.left.target")
    playwright.expect(editor.get_by_role("button", name="Run program")).to_be_disabled()
    editor.keyboard.press("F9")  # runs nothing, as long as there is a mistake
    expect(editor, ".cm-lint-marker-error").to_have_count(1)
    expect(editor, ".cm-lintRange-error").to_have_text("motor.left.targt")
    write(editor, PROGRAM)
    expect(editor, ".verdict").to_contain_text("No mistakes")
    expect(editor, ".cm-lint-marker-error").to_have_count(0)
    editor.keyboard.press("F9")
    editor.wait_for_function("() => window.thymio.state().program?.name === 'My program.aesl'")
    editor.wait_for_function("() => Number(document.querySelector('[data-variable=count]')?.textContent) > 2")

    write(editor, AVOIDER)
    expect(editor, ".verdict").to_contain_text("No mistakes")
    editor.get_by_role("button", name="Run program").click()
    watch_it_avoid(editor, world)


def test_a_breakpoint_stops_the_program_and_it_is_stepped_by_lines(editor):
    write(editor, PROGRAM)
    editor.keyboard.press("Control+Enter")
    editor.wait_for_function("() => window.thymio.state().program?.name === 'My program.aesl'")
    expect(editor, "#program-state").to_have_text("running")  # as shown: from then on nothing moves the lines
    click_beside(editor, 4)
    expect(editor, "#program-state").to_have_text("halted in line 4")
    expect(editor, ".current-line").to_have_text("count = count + 1")
    edit_variable(editor, "count", "41")
    expect(editor, "[data-variable=count]").to_have_text("41")
    editor.focus(".cm-content")
    editor.keyboard.press("F7")
    expect(editor, ".current-line").to_have_text("if count > 30000 then")
    expect(editor, "[data-variable=count]").to_have_text("42")
    editor.locator(".cm-line", has_text="count = count + 1").click()
    editor.keyboard.press("Control+b")
    expect(editor, ".breakpoints .breakpoint:visible").to_have_count(0)
    editor.keyboard.press("F9")
    expect(editor, "#program-state").to_have_text("running")


@pytest.mark.slow
def test_a_variable_is_edited_within_its_range(editor):
    editor.click(".values-all")
    editor.fill(".values-search input[type=search]", "motor.left.target")
    value = edit_variable(editor, "motor.left.target", "40000")
    expect(editor, ".values > .fault").to_contain_text("40000")
    editor.locator(EDITED).fill("120")
    editor.keyboard.press("Enter")
    playwright.expect(value).to_have_text("120")


@pytest.mark.slow
def test_a_long_array_takes_at_most_three_lines(editor):
    editor.click(".values-all")
    value = editor.locator("[data-variable='event.args']")
    playwright.expect(value).to_contain_text("0 0 0 0")
    height, line = value.evaluate("(cell) => [cell.clientHeight, parseFloat(getComputedStyle(cell).lineHeight)]")
    assert 2 < height / line < 4


@pytest.mark.slow
def test_an_event_is_defined_sent_and_logged(editor):
    editor.click("#tool-tab-events")
    for name, size in (("ping", "1"), ("pong", "1")):
        editor.fill("[data-new=event]", name)
        editor.fill(".events .entry .number", size)
        editor.keyboard.press("Enter")
        editor.locator(f"[data-send={name}]").wait_for()
    write(editor, "onevent ping\nemit pong event.args[0] + 1\n")
    expect(editor, ".verdict").to_contain_text("No mistakes")
    editor.keyboard.press("Control+Enter")
    editor.wait_for_function("() => window.thymio.state().program?.name === 'My program.aesl'")
    editor.get_by_label("Values of ping: 1").fill("41")
    editor.click("[data-send=ping]")
    expect(editor, ".log p").to_contain_text("pong 42")


@pytest.mark.slow
def test_tab_moves_on_from_a_constant_and_event_values_stay_when_events_are_added(editor):
    editor.click(".constants > summary")
    for name in ("FAR", "NEAR"):
        editor.fill("[data-new=constant]", name)
        editor.keyboard.press("Enter")
        editor.locator(f"[data-constant={name}]").wait_for()
    editor.fill("[data-constant=FAR]", "7")
    editor.keyboard.press("Tab")
    editor.wait_for_function("() => document.querySelector('[data-constant=FAR]').getAttribute('value') === '7'")
    playwright.expect(editor.get_by_label("Remove FAR")).to_be_focused()
    editor.click("#tool-tab-events")
    for name in ("ping", "pong"):
        editor.fill("[data-new=event]", name)
        editor.fill(".events .entry .number", "1")
        editor.keyboard.press("Enter")
        editor.locator(f"[data-send={name}]").wait_for()
        editor.get_by_label(f"Values of {name}: 1").fill("41")
    playwright.expect(editor.get_by_label("Values of ping: 1")).to_have_value("41")


@pytest.mark.slow
def test_a_file_is_opened_edited_and_saved_without_loss_and_a_draft_outlives_the_page(editor, tmp_path):
    head = '<!DOCTYPE aesl-source>\n<network>\n<constant value="4" name="SIZE"/>\n<!-- mine -->\n'
    plugins = '<toolsPlugins><X y="1"/></toolsPlugins>'
    text = f'{head}<node nodeId="1" name="thymio-II">var a = SIZE{plugins}</node>\n</network>\n'
    file = tmp_path / "my maze.aesl"
    file.write_text(text)
    editor.set_input_files("#editor-file", str(file))
    expect(editor, ".cm-content").to_have_text("var a = SIZE")
    editor.focus(".cm-content")
    editor.keyboard.press("Control+End")
    editor.keyboard.type("_")
    playwright.expect(editor.get_by_label("Not saved to a file")).to_be_visible()
    editor.reload()
    editor.wait_for_function("window.thymio && window.thymio.connected && window.thymio.partPosition('robot')")
    open_editor(editor)
    editor.click("[data-draft=restore]")
    expect(editor, ".cm-line").to_have_text("var a = SIZE_")
    with editor.expect_download() as saved:
        choose_in_file_menu(editor, "save")
    assert saved.value.suggested_filename == "my maze.aesl"
    assert saved.value.path().read_text() == text.replace("= SIZE", "= SIZE_")
    broken = tmp_path / "broken.aesl"
    broken.write_text("<network>\n<node>a < b</node></network>")
    editor.set_input_files("#editor-file", str(broken))
    expect(editor, ".verdict").to_contain_text("line 2, column 9")
    expect(editor, ".cm-line").to_have_text("var a = SIZE_")


@pytest.mark.slow
def test_a_file_is_decoded_as_declared_and_saved_in_utf_8(editor, tmp_path):
    declared = '<?xml version="1.0" encoding="{}"?>\n'
    text = declared + '<network><node nodeId="1" name="thymio-II">var a # größer</node></network>'
    old, broken = tmp_path / "old.aesl", tmp_path / "broken.aesl"
    old.write_bytes(text.format("iso-8859-1").encode("iso-8859-1"))
    broken.write_bytes("var b # größer".encode("iso-8859-1"))
    editor.set_input_files("#editor-file", str(old))
    expect(editor, ".cm-content").to_have_text("var a # größer")
    with editor.expect_download() as saved:
        choose_in_file_menu(editor, "save")
    assert saved.value.path().read_bytes() == text.format("UTF-8").encode()
    editor.set_input_files("#editor-file", str(broken))
    expect(editor, ".verdict").to_contain_text("broken.aesl cannot be read as text")
    expect(editor, ".cm-content").to_have_text("var a # größer")


FOREIGN = (
    ("lesson.vpl3", b'{"advanced": false, "program": [{"blocks": []}]}', "this is a program of VPL 3"),
    ("homework.docx", b"PK\x03\x04\x14\0 word/document.xml", "this is a document of an office program"),
    ("photo.txt", b"\x89PNG\r\n\x1a\n", "this is a picture"),
    ("old.sb2", b"PK\x03\x04\x14\0 project.json", "this is a Scratch project"),
    ("map.aesl", b"<aseba-playground/>", "this is a playground"),
    ("mine.playground", b"<network></network>", "this is a program, not a playground"),
)
"""Files of other programs: name, content, what the page says."""


@pytest.mark.slow
def test_a_file_dropped_on_the_text_is_opened_and_not_inserted(editor, tmp_path):
    write(editor, "var mine = 1")
    playground = tmp_path / "mine.json"
    playground.write_text('{"format": 1}')
    drop_file(editor, playground, ".cm-content")
    expect(editor, ".message-at .headline").to_contain_text("mine.json")
    for name, content, sentence in FOREIGN:
        foreign = tmp_path / name
        foreign.write_bytes(content)
        drop_file(editor, foreign, ".cm-content")
        expect(editor, "body").to_contain_text(f"{name}: {sentence}")
        expect(editor, ".cm-content").to_have_text("var mine = 1")
    program = tmp_path / "dropped.aesl"
    program.write_text('<network><node nodeId="1" name="thymio-II">var other = 1</node></network>')
    drop_file(editor, program, ".cm-content")
    expect(editor, ".cm-content").to_have_text("var other = 1")
    choose_in_file_menu(editor, "new")
    expect(editor, RECENT).to_have_count(2)
    editor.locator(RECENT).nth(1).click()  # below the file
    expect(editor, ".cm-content").to_have_text("var mine = 1")


@pytest.mark.slow
def test_own_programs_come_first_a_draft_can_be_discarded_and_a_second_tab_warns(editor):
    write(editor, "var first = 1")
    editor.reload()
    editor.wait_for_function("window.thymio && window.thymio.connected")
    open_tab(editor, "program")
    draft = editor.locator(".program-draft:not(#program-foreign)")
    playwright.expect(draft).to_contain_text("My program.aesl")
    draft.locator("[data-draft=discard]").click()
    playwright.expect(draft).to_contain_text("My program.aesl is discarded.")
    draft.locator("[data-draft=undo]").click()
    draft.locator("[data-draft=restore]").click()
    expect(editor, ".cm-content").to_have_text("var first = 1")
    choose_in_file_menu(editor, "new")
    editor.click("[data-new=empty]")
    choose_in_file_menu(editor, "new")
    card = editor.locator(RECENT)
    playwright.expect(card).to_contain_text("My program")
    playwright.expect(card.locator(".program-miniature")).to_have_text("var first = 1")
    assert card.bounding_box()["y"] < editor.locator(".program-card").first.bounding_box()["y"]

    second = editor.context.new_page()
    open_page(second, editor.url)
    open_tab(second, "program")
    for one in (editor, second):
        one.locator(".notice.warning", has_text="open in another tab of this browser").wait_for()


@pytest.mark.slow
def test_a_draft_is_offered_to_another_tab_only_when_its_own_is_closed(editor):
    write(editor, "var first = 1")
    second = editor.context.new_page()
    open_page(second, editor.url)
    open_tab(second, "program")
    second.locator(".notice.warning", has_text="open in another tab of this browser").wait_for()
    second.wait_for_function("async () => (await navigator.locks.query()).pending.length === 1")  # for the first tab
    draft = second.locator(".program-draft:not(#program-foreign)")
    wait_for_frame(second)
    playwright.expect(draft).to_be_hidden()
    editor.close()
    playwright.expect(draft).to_contain_text("My program.aesl")
    draft.locator("[data-draft=restore]").click()
    expect(second, ".cm-content").to_have_text("var first = 1")
    second.context.close()


@pytest.mark.slow
def test_an_overwritten_draft_is_added_to_the_recent_files(editor):
    write(editor, "var first = 1")
    editor.reload()
    editor.wait_for_function("window.thymio && window.thymio.connected")
    open_editor(editor)
    expect(editor, ".program-draft:not(#program-foreign)").to_contain_text("program.aesl")
    write(editor, "var second = 2")
    expect(editor, ".program-draft:not(#program-foreign)").to_be_hidden()
    choose_in_file_menu(editor, "new")
    expect(editor, RECENT).to_have_count(1)
    editor.click(RECENT)
    expect(editor, ".cm-content").to_have_text("var first = 1")
    playwright.expect(editor.get_by_label("Not saved to a file")).to_be_visible()


@pytest.mark.slow
def test_a_text_keeps_its_state_when_the_editor_is_closed_or_the_language_changes(editor):
    write(editor, PROGRAM)
    editor.locator(".cm-line", has_text="count = count + 1").click()
    editor.keyboard.press("End")
    editor.keyboard.press("Control+b")
    expect(editor, ".breakpoints .breakpoint:visible").to_have_count(1)
    editor.keyboard.insert_text("0")
    open_tab(editor, "robot")
    expect(editor, ".cm-content").to_be_hidden()
    open_editor(editor)
    choose_language(editor, "de")
    expect(editor, ".program").to_have_attribute("aria-label", "Programm")
    expect(editor, ".breakpoints .breakpoint:visible").to_have_count(1)
    expect(editor, ".cm-content").to_be_focused()
    expect(editor, ".cm-activeLine").to_have_text("count = count + 10")
    editor.keyboard.press("Control+z")
    expect(editor, ".cm-activeLine").to_have_text("count = count + 1")


@pytest.mark.slow
def test_common_names_come_first_in_completion_and_help(editor):
    write(editor, "")
    for typed, first in (("motor.", "motor.left.target"), ("call l", "leds.top"), ("onevent b", "button.center")):
        write(editor, "")
        editor.keyboard.type(typed, delay=KEY_MS)
        offered = editor.locator(".cm-tooltip-autocomplete li .cm-completionLabel")
        playwright.expect(offered.first).to_have_text(first)
        editor.keyboard.press("Escape")
    editor.get_by_role("tab", name="Help").click()
    topics = editor.locator(".reference h3")
    playwright.expect(topics.nth(3)).to_be_visible()
    assert topics.all_inner_texts()[:4] == ["Motors", "Lights", "Sound", "Sensors"]
    playwright.expect(editor.locator(".reference .entry-help button").first).to_have_text("motor.left.target")


@pytest.mark.slow
def test_each_of_two_robots_has_its_program(world, page):
    open_page(page, world("two_robots"))
    open_editor(page)
    page.wait_for_function("Object.keys(window.thymio.state().robots).length === 2")
    wait_for_service(page, "/aseba_runtime/check")
    expect(page, "#program-state").to_have_text("not started")
    names = page.evaluate("Object.keys(window.thymio.state().robots)")
    for name, text in zip(names, ("var mine = 11\n", "var mine = 22\n"), strict=True):
        choose_robot(page, name)
        expect(page, "#robot-chooser").to_contain_text(name)
        open_editor(page)
        write(page, text)
        page.keyboard.press("Control+Enter")
    for name, value in zip(names, ("11", "22"), strict=True):
        choose_robot(page, name)
        expect(page, "[data-variable=mine]").to_have_text(value)
    choose_robot(page, "*")
    expect(page, ".cm-content").to_have_text("var mine = 22")  # that of the robot, which takes its time
    write(page, "var ours = 33\n")
    page.keyboard.press("Control+Enter")
    for name in names:
        choose_robot(page, name)
        expect(page, "[data-variable=ours]").to_have_text("33")
        expect(page, ".cm-content").to_have_text("var ours = 33")


MISTAKES = [
    ("var a\nif a = 1 then\na = 2\nend\n", "Change it to ==", "var a\nif a == 1 then\na = 2\nend\n"),
    ("sound.freq(440, 1)\n", "Insert call", "call sound.freq(440, 1)\n"),
    ("var a\nwhile a < 3 do\na++\n", "Insert end", "var a\nwhile a < 3 do\na++\nend\n"),
    ("var a\na = 1; a = 2;\n", "Correct it", "var a\na = 1 a = 2\n"),
    ("onevent tap\nend\n", "Remove end", "onevent tap\n"),
    ("motor.left.traget = 1\n", "Correct it", "motor.left.target = 1\n"),
    ("onevnt tap\n", "Change it to onevent", "onevent tap\n"),
]


def text_of(page):
    """The text in the editor."""
    return page.locator(".cm-content .cm-line").all_inner_texts()


@pytest.mark.slow
def test_a_mistake_is_explained_and_corrected_by_its_button(editor):
    for source, words, repaired in MISTAKES:
        write(editor, source)
        button = editor.locator(".mistake-card .correct")
        playwright.expect(button).to_have_text(words)
        expect(editor, ".verdict").to_have_attribute("data-kind", "error")
        button.click()
        expect(editor, ".verdict").to_contain_text("No mistakes")
        expect(editor, CARD).to_have_count(0)
        assert [line.strip("\n") for line in text_of(editor)] == repaired.split("\n")


@pytest.mark.slow
def test_a_mistake_is_corrected_by_keyboard_and_the_correction_can_be_undone(editor):
    write(editor, "var a\na == 3\n")
    expect(editor, CARD).to_contain_text("Two “=” compare. One stores.")
    editor.focus(".mistake-card .correct")
    editor.keyboard.press("Enter")
    expect(editor, ".verdict").to_contain_text("No mistakes")
    editor.keyboard.press("Control+z")
    expect(editor, ".mistake-card .correct").to_have_text("Change it to =")
    editor.focus(".cm-content")
    editor.keyboard.press("Control+.")
    expect(editor, ".verdict").to_contain_text("No mistakes")


@pytest.mark.slow
def test_a_hint_without_a_correction_has_no_button_and_is_in_the_language_of_the_page(editor):
    write(editor, "var a = 1.5\n")
    expect(editor, CARD).to_contain_text("Aseba has whole numbers only")
    expect(editor, ".mistake-card .correct").to_have_count(0)
    choose_language(editor, "fr")
    expect(editor, CARD).to_contain_text("Aseba n’a que des nombres entiers")


@pytest.mark.slow
def test_the_mark_in_the_text_offers_the_correction_too(editor):
    write(editor, "var a\nif a = 1 then\nend\n")
    editor.locator(".cm-lintRange-error").hover()
    expect(editor, ".cm-tooltip-lint .cm-diagnosticText").to_contain_text("to compare two values write '=='")
    editor.locator(".cm-tooltip-lint .cm-diagnosticAction").click()
    expect(editor, ".verdict").to_contain_text("No mistakes")


@pytest.mark.slow
def test_a_file_of_thymio_suite_is_opened_loaded_and_saved_under_its_own_name(editor, tmp_path):
    text = (
        "<!DOCTYPE aesl-source>\n<network>\n<mystery/>\n"
        '<node nodeId="{01234567-89ab-cdef-0123-456789abcdef}" name="Thymio_4 on LAPTOP - 8636">var a = 0\n'
        "<toolsPlugins><AnotherEditor><kept/></AnotherEditor></toolsPlugins></node>\n</network>\n"
    )
    path = tmp_path / "suite.aesl"
    path.write_text(text)
    editor.set_input_files("#editor-file", str(path))
    expect(editor, ".verdict").to_contain_text("No mistakes")
    editor.focus(".cm-content")
    editor.keyboard.press("Control+Enter")
    expect(editor, ".verdict").to_contain_text("node 'Thymio_4 on LAPTOP - 8636' runs here")
    editor.focus(".cm-content")
    editor.keyboard.press("Control+Home")
    editor.keyboard.insert_text("call leds.top(0, 0, 0)\n")
    with editor.expect_download() as download:
        choose_in_file_menu(editor, "save")
    assert download.value.path().read_text() == text.replace("var a = 0", "call leds.top(0, 0, 0)\nvar a = 0")
