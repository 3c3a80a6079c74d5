"""The page in WebKit, the engine of the browsers of iPads and iPhones, driven by WebDriver.

Selenium is the client. WebKitGTK needs a display, and no graphics card: everything is drawn by software.
"""

from __future__ import annotations

import contextlib
import os
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from tests.patience import PATIENCE_S, until
from tests.processes import free_port, wait_for_port, x_display
from tests.web_ui.page_support import KEY_MS, without_welcome

PROGRAMS = ("WebKitWebDriver", "Xvfb")
VARIABLES = {
    "WEBKIT_DISABLE_COMPOSITING_MODE": "1",
    "WEBKIT_DISABLE_DMABUF_RENDERER": "1",
    "LIBGL_ALWAYS_SOFTWARE": "1",
}
SIZE = (1280, 860)
ENTER = "\ue007"
NOTE_ERRORS = """window.errors = [];
    addEventListener("error", ({message}) => message.startsWith("ResizeObserver loop") || window.errors.push(message));
    addEventListener("unhandledrejection", ({reason}) => window.errors.push(String(reason)));"""
"""An observer that is served with the next frame only is no failed script, though WebKit reports it as one."""


@contextlib.contextmanager
def webkit_driver(folder: Path) -> Iterator[str]:
    """The address of a WebDriver of WebKit on a display of its own; `folder` becomes its home."""
    missing = [name for name in PROGRAMS if shutil.which(name) is None]
    if missing:
        pytest.skip(f"no {' and no '.join(missing)} on this machine: apt install webkit2gtk-driver xvfb")
    port = free_port()
    with x_display() as display:
        variables = {**os.environ, **VARIABLES, "DISPLAY": display, "HOME": str(folder)}
        with (folder / "webkit.txt").open("w") as output:
            command = ["WebKitWebDriver", f"--port={port}"]
            driver = subprocess.Popen(command, env=variables, stdout=output, stderr=subprocess.STDOUT)
        try:
            wait_for_port(port)
            yield f"http://127.0.0.1:{port}"
        finally:
            driver.terminate()
            driver.wait(PATIENCE_S)


class WebKitPage:
    """A window of WebKit. A call waits until what it needs is there."""

    def __init__(self, driver: str) -> None:
        """Open it. A load of a page ends with its first byte: the socket of the page keeps WebKit's from ending."""
        from selenium.webdriver import Remote
        from selenium.webdriver.remote.client_config import ClientConfig
        from selenium.webdriver.remote.remote_connection import RemoteConnection
        from selenium.webdriver.webkitgtk.options import Options

        options = Options()
        options.page_load_strategy = "none"
        options.accept_insecure_certs = True  # a proxy of a test has signed its certificate itself
        self._browser = Remote(RemoteConnection(client_config=ClientConfig(driver)), options=options)
        self._browser.set_window_size(*SIZE)

    def open(self, address: str) -> None:
        """Load the page, and wait for the robot and the state of the simulator."""
        self._browser.get(without_welcome(address))
        self.wait("return location.protocol.startsWith('http') && document.body !== null")
        self.run(NOTE_ERRORS)
        self.wait("return window.thymio?.connected && window.thymio.partPosition('robot') != null")
        self.wait("return window.thymio.state().simulator !== null")

    def run(self, script: str, *arguments: Any) -> Any:
        """The result of a script."""
        return self._browser.execute_script(script, *arguments)

    def wait(self, script: str, *arguments: Any) -> Any:
        """Wait until a script returns something that is true."""
        return until(lambda: self.run(script, *arguments), lambda: f"{script} {arguments}; {self._found()}")

    def _found(self) -> str:
        return f"errors: {self.errors}; text: {self.run('return document.body.innerText')[:500]}"

    @property
    def errors(self) -> list[str]:
        """Errors of scripts since the page was opened."""
        return list(self.run("return window.errors ?? []"))

    def find(self, selector: str) -> Any:
        """The first element of a selector that is visible."""
        script = "return [...document.querySelectorAll(arguments[0])].find((each) => each.checkVisibility())"
        return self.wait(script, selector)

    def text(self, selector: str) -> str:
        """The text of an element."""
        return str(self.run("return document.querySelector(arguments[0])?.innerText ?? ''", selector))

    def click(self, selector: str) -> None:
        """Click on an element by mouse."""
        self.find(selector).click()

    def place(self, selector: str, x: float | None = None, y: float | None = None) -> tuple[int, int]:
        """A point of an element in CSS pixels of the window: its middle, or so far from its upper left corner."""
        box = self.run("return arguments[0].getBoundingClientRect().toJSON()", self.find(selector))
        middle = (box["width"] / 2, box["height"] / 2)
        return round(box["x"] + (middle[0] if x is None else x)), round(box["y"] + (middle[1] if y is None else y))

    def drag(self, start: tuple[int, int], end: tuple[int, int]) -> None:
        """Drag by mouse, with a stop on the way."""
        between = (start[0] + 12, start[1] + 12)
        self.mouse(start).pointer_down().move_to_location(*between).move_to_location(*end).pointer_up()
        self._act()

    def click_at(self, x: int, y: int) -> None:
        """Click on a point of the window."""
        self.mouse((x, y)).pointer_down().pointer_up()
        self._act()

    def hold(self, selector: str) -> None:
        """Press the mouse on an element, until `release`."""
        self.mouse(self.place(selector)).pointer_down()
        self._act()

    def release(self) -> None:
        """Release the mouse."""
        self._pointer().pointer_up()
        self._act()

    def mouse(self, place: tuple[int, int]) -> Any:
        """The mouse after it has moved to a place."""
        return self._pointer().move_to_location(*place)

    def _pointer(self) -> Any:
        from selenium.webdriver.common.actions.action_builder import ActionBuilder

        self._actions = ActionBuilder(self._browser)
        return self._actions.pointer_action

    def _act(self) -> None:
        self._actions.perform()

    def type(self, keys: str) -> None:
        """Press keys one after another, in the element with the focus."""
        from selenium.webdriver import ActionChains

        actions = ActionChains(self._browser)
        for key in keys:
            actions.send_keys(ENTER if key == "\n" else key).pause(KEY_MS / 1000)
        actions.perform()

    def quit(self) -> None:
        """Close the window."""
        self._browser.quit()
