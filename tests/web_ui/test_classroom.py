"""The teacher's page of a class, and what it does on the page of a pupil."""

from __future__ import annotations

import zipfile
from collections.abc import Iterator
from urllib.parse import urljoin

import pytest

from tests.classroom.class_support import RunningClass
from tests.web_ui.page_support import MARKS, choose_language, open_page

pytestmark = MARKS


@pytest.fixture(scope="module")
def group(browser, tmp_path_factory: pytest.TempPathFactory) -> Iterator[RunningClass]:
    """The class of Ada and Jürg."""
    running = RunningClass(tmp_path_factory.mktemp("class"), ["Ada", "Jürg"])
    yield running
    running.end()


def page_of(group: RunningClass, pupil: str) -> str:
    """The address of a pupil's page with the token."""
    link = urljoin(group.address, group.pupil(pupil)["link"])
    return link.replace("/#", "/?tour=off#")


def test_a_teacher_sees_all_robots_and_a_pupil_sees_the_message(
    group: RunningClass, page, other_page, tmp_path
) -> None:
    page.goto(group.address)
    ada = page.locator("[data-pupil=ada]")
    ada.locator(".chip", has_text="not started").wait_for()
    page.locator("#count", has_text="2 / 2").wait_for()
    page.wait_for_function("""() => {
        const canvas = document.querySelector("[data-pupil=jurg] canvas");
        const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
        return data.some((value) => value > 0);
    }""")
    assert "token" not in page.url

    page.click("[data-verb=pauseAll]")
    ada.locator(".chip", has_text="paused by you").wait_for()
    ada.locator("[data-verb=run]").click()
    ada.locator("[data-verb=pause]").wait_for()

    ada.locator("[data-verb=message]").click()
    page.get_by_role("textbox", name="Message to Ada").fill("Look at the <b>board</b>")
    page.click("[data-verb=send]")
    open_page(other_page, page_of(group, "ada"))
    note = other_page.locator(".teacher-note")
    note.get_by_text("Look at the <b>board</b>").wait_for()
    assert not note.locator("a").is_visible()

    page.click("[data-pupil=jurg] [data-verb=present]")
    page.click("[data-verb=offer]")
    note.locator("a").wait_for()
    watched = note.locator("a").evaluate("(link) => link.href")
    assert watched == urljoin(group.address, group.pupil("jurg")["watch"])
    page.click("[data-verb=close]")
    note.locator("a").wait_for(state="hidden")
    note.get_by_role("button", name="Hide").click()
    note.wait_for(state="hidden")

    with page.expect_download() as download:
        page.click("[data-verb=collect]")
    download.value.save_as(tmp_path / "programs.zip")
    with zipfile.ZipFile(tmp_path / "programs.zip") as archive:
        assert archive.namelist() == ["Ada/", "Jürg/"]
    page.locator(".class-missing", has_text="No program yet: Ada, Jürg.").wait_for()

    page.click("[data-verb=sheet]")
    page.locator(".class-link img").nth(1).wait_for()
    assert page.locator(".class-link img").count() == 2
    page.click("[data-verb=back]")
    ada.wait_for()


def test_a_pupil_sees_whose_page_it_is_and_who_has_paused_it(group: RunningClass, page, tmp_path) -> None:
    open_page(page, page_of(group, "jurg"))
    page.locator("#pupil", has_text="Jürg").wait_for()
    page.wait_for_function("() => document.title === 'Jürg – Thymio Sim'")
    group.request("message", {"pupils": ["jurg"], "text": "Look up"})
    group.request("pause", {"pupils": ["jurg"], "paused": True})
    note = page.locator(".teacher-note", has_text="Your teacher has paused time.")
    note.get_by_text("Look up").wait_for()
    page.locator("#pause:disabled[title='Your teacher has paused time.']").wait_for()
    page.locator("#view").press("Space")
    assert page.locator("#pause").is_disabled()
    (tmp_path / "song.mp3").write_bytes(b"")
    page.set_input_files("#playground-file", str(tmp_path / "song.mp3"))
    page.locator(".notice:visible", has_text="song.mp3").wait_for()
    assert note.is_visible()
    group.request("pause", {"pupils": ["jurg"], "paused": False})
    note.get_by_text("Your teacher has paused time.").wait_for(state="hidden")
    page.locator("#pause:enabled").wait_for()


def test_what_a_pupil_has_written_is_collected_before_it_runs(group: RunningClass, page) -> None:
    open_page(page, page_of(group, "jurg"))
    page.click("#tab-program")
    page.click("[data-new=empty]")
    page.locator(".cm-content").fill("var written = 1")
    zipped = group.folder / "pupils" / "jurg" / "draft.aesl"
    group.until("jurg", lambda _one: zipped.exists() and "var written = 1" in zipped.read_text())


def test_a_pupil_enters_the_code_of_the_room_and_chooses_a_name(group: RunningClass, page) -> None:
    page.goto(f"http://127.0.0.1:{group.port}/")
    for typed in ("wrong1", group.known["room_code"].upper()):
        page.get_by_role("textbox", name="Code of your class").fill(typed)
        page.click("[data-verb=enter]")
        if typed == "wrong1":
            page.get_by_text("This code is wrong.").wait_for()
    page.get_by_role("link", name="Jürg").click()
    page.locator("#pupil", has_text="Jürg").wait_for()
    assert page.url == f"http://127.0.0.1:{group.port}/p/jurg/"
    page.goto(f"http://127.0.0.1:{group.port}/")  # the browser keeps the code
    page.get_by_role("link", name="Ada").wait_for()


def test_the_room_has_an_address_a_code_and_a_qr_code_for_the_projector(group: RunningClass, page) -> None:
    page.goto(group.address)
    page.click("[data-verb=room]")
    page.get_by_text(f"Code: {group.known['room_code']}").wait_for()
    page.locator(".class-room img").wait_for()
    assert page.locator("#room-address").inner_text() == f"http://localhost:{group.port}/"
    page.click("[data-verb=close]")
    page.locator(".class-room").wait_for(state="hidden")


def test_pupils_with_one_browser_do_not_see_what_the_other_has_stored(group: RunningClass, page) -> None:
    open_page(page, page_of(group, "ada"))
    choose_language(page, "de")
    page.goto(f"http://127.0.0.1:{group.port}/p/jurg/?tour=off&welcome=off")
    page.locator("#connection[data-state=noToken]").wait_for()
    assert page.evaluate("() => document.documentElement.lang") == "en"
    open_page(page, f"http://127.0.0.1:{group.port}/p/ada/")  # in this tab the token of Ada is kept
    page.locator("#pupil", has_text="Ada").wait_for()
    assert page.evaluate("() => document.documentElement.lang") == "de"


def test_a_page_connects_again_when_its_suite_has_been_restarted(group: RunningClass, page) -> None:
    open_page(page, page_of(group, "jurg"))
    group.suite("jurg").kill()
    page.locator("#connection[data-state=lost]").wait_for()
    page.locator("#connection[data-state=connected]").wait_for()
    page.locator("#pupil", has_text="Jürg").wait_for()


@pytest.mark.slow
def test_without_the_token_the_page_says_what_is_missing(group: RunningClass, page) -> None:
    page.goto(f"http://127.0.0.1:{group.port}/teacher/")
    page.get_by_text("This page needs the link of the teacher").wait_for()
    assert page.locator(".pupil").count() == 0
