"""Helpers for tests of the playground creator."""

from __future__ import annotations

from tests.web_ui.page_support import build_playground, open_menu, open_page, wait_until_still


def open_creator(page, address):
    """Open the page, and a new playground in the creator, with a ground and a robot."""
    open_page(page, address)
    build_playground(page)
    wait_for_camera(page)


def choose_more(page, verb):
    """Choose an entry of the menu "More"."""
    open_menu(page, "#creator-more")
    page.click(f"#creator-menu [data-verb={verb}]")


def open_details(page):
    """Unfold the other values of the item."""
    details = page.locator(".item-details")
    if details.get_attribute("open") is None:
        details.locator("summary").first.click()


def wait_for_camera(page):
    """Wait until the camera is still."""
    wait_until_still(page, "window.thymio.screenPosition(0.1, 0.1, 0)")


def built(page):
    """What is being built, as plain data."""
    return page.evaluate("window.thymio.built()")


def items(page):
    """The items by their names."""
    return {item["name"]: item for item in built(page)["playground"]["items"]}


def spot(page, x, y, z=0.0):
    """A point of the world in CSS pixels of the window."""
    place = page.evaluate("([x, y, z]) => window.thymio.screenPosition(x, y, z)", [x, y, z])
    return place["x"], place["y"]


def click(page, x, y, z=0.0):
    """Click on a point of the world."""
    page.mouse.click(*spot(page, x, y, z))


def wait_for_items(page, count):
    """Wait until there are so many items."""
    page.wait_for_function("(count) => window.thymio.built().playground.items.length === count", arg=count)
