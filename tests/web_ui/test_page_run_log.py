"""The log of the run, saved from the page."""

from __future__ import annotations

from tests.web_ui.page_support import MARKS, open_menu, open_page
from thymio_sim_ros.engine.replay import replay

pytestmark = MARKS


def test_the_run_is_saved_as_a_file_that_repeats_it(world, page, tmp_path):
    open_page(page, world("two_robots", program="explorer"))
    page.wait_for_function("() => window.thymio.state().services.includes('/simulator/get_run_log')")
    page.wait_for_function("() => window.thymio.state().timeNs > 2e9")
    open_menu(page, "#help-open")
    with page.expect_download() as saving:
        page.click("[data-help=run]")
    path = tmp_path / saving.value.suggested_filename
    saving.value.save_as(path)
    found = replay(path)
    assert (path.name, found.differs) == ("run.jsonl.gz", None)
    assert found.ticks >= 100
