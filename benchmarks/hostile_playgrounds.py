"""Playgrounds made to stop the simulator, sent by one viewer while another one measures how long its calls take.

Run: python benchmarks/hostile_playgrounds.py [--port PORT]. It starts `thymio-sim` with a bridge on that port,
sends each playground as the parameter /simulator.playground, and prints: bytes, seconds until the answer,
the longest call of the other viewer meanwhile, memory of the process at its highest so far, and the answer. The last
line is how long Ctrl-C takes while a playground is loading. Larger texts than 4 MB do not pass the bridge;
tests/sim/playground/test_format_detection.py measures those.
"""

from __future__ import annotations

import argparse
import base64
import io
import json
import os
import re
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path

from PIL import Image
from websockets.sync.client import ClientConnection, connect

from thymio_sim_ros.bridge import SUBPROTOCOLS
from thymio_sim_ros.bridge.protocol import messages as ms
from thymio_sim_ros.bridge.protocol import wire

COMMAND = "import sys; from thymio_sim_ros.cli.main import main; sys.exit(main(sys.argv[1:]))"
SERVICE = "/simulator/get_poses"
NO_NAMES = b"\0\1\0\0" + bytes(4)
START_S, ANSWER_S = 60.0, 120.0
ALONE_S = 3.0
PLAIN = '<rect width="100" height="100" fill="#888"/>'


def svg(body: str) -> str:
    """An SVG as a data URI."""
    text = f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 100 100">{body}</svg>'
    return "data:image/svg+xml;base64," + base64.b64encode(text.encode()).decode()


def png(columns: int, rows: int, mode: str = "L") -> str:
    """A PNG of one color as a data URI."""
    out = io.BytesIO()
    Image.new(mode, (columns, rows), 128 if mode == "L" else (9, 99, 199, 128)).save(out, "PNG", compress_level=1)
    return "data:image/png;base64," + base64.b64encode(out.getvalue()).decode()


def playground(*images: str, side: float = 2.4) -> str:
    """A floor of this side with these pictures on it."""
    ground = {"kind": "rectangle", "size_x_m": side, "size_y_m": side, "color": "#ffffff"}
    sheets = [{"kind": "picture", "size_x_m": side, "size_y_m": side, "image": image} for image in images]
    robots = [{"name": "thymio", "x_m": 0.0, "y_m": 0.0}]
    return json.dumps({"format": 1, "title": "hostile", "shapes": [ground, *sheets], "robots": robots})


def attacks() -> dict[str, str]:
    """Playgrounds by what is in them."""
    rectangles = "".join(f'<rect x="{n % 50}" width="50" height="50" fill="#{n % 4096:03x}"/>' for n in range(19_000))
    points = "".join(f"L{n * 37 % 100} {n * 91 % 100}" for n in range(200_000))
    dashes = '<path d="M0 0' + "L100 100L0 50" * 9_000 + '" stroke="#000" stroke-dasharray=".001" fill="none"/>'
    wide = png(8000, 3000)
    return {
        "one plain SVG": playground(svg(PLAIN)),
        "100 half-transparent groups": playground(svg(f'<g opacity=".5">{PLAIN}</g>' * 100)),
        "35 groups inside one another": playground(svg('<g opacity=".5">' * 35 + PLAIN + "</g>" * 35)),
        "two blurred rectangles by style": playground(svg(f'<g style="filter:blur(50px)">{PLAIN}</g>' * 2)),
        "19 000 plain rectangles": playground(svg(rectangles)),
        "dashes": playground(svg(dashes)),
        "a huge path": playground(svg(f'<path fill-rule="evenodd" d="M0 0{points}z"/>')),
        "three times two thirds of the time": playground(*[svg(f'<g opacity=".5">{PLAIN}</g>' * 14)] * 3),
        "one PNG of 24 million pixels": playground(wide),
        "twenty PNGs of 24 million pixels": playground(*[wide] * 20),
        "a half-transparent one of 25 million": playground(png(5000, 5000, "RGBA"), side=5.0),
        "a thousand large pictures of a pixel": playground(*[png(1, 1)] * 900, side=5.0),
        "4 MB of JSON, one text": '{"format":1,"title":"' + "a" * 4_000_000 + '"}',
        "4 MB of nested lists": '{"shapes":' + "[" * 4_000_000,
        "4 MB of XML, one text": "<aseba-playground>" + "a " * 2_000_000 + "</aseba-playground>",
    }


class Viewer:
    """A Foxglove client; reads until the message that is wanted."""

    def __init__(self, connection: ClientConnection) -> None:
        self._connection = connection
        self._calls = 0

    def until(self, wanted: Callable[[ms.ServerMessage], bool], within_s: float) -> ms.ServerMessage:
        """The first message that is wanted; TimeoutError."""
        deadline = time.monotonic() + within_s
        while True:
            message = wire.decode_server(self._connection.recv(timeout=max(0.0, deadline - time.monotonic())))
            if wanted(message):
                return message

    def service(self, name: str) -> int:
        """The number of a service, once it is advertised."""
        found: list[int] = []

        def is_there(message: ms.ServerMessage) -> bool:
            if isinstance(message, ms.AdvertiseServices):
                found.extend(service.id for service in message.services if service.name == name)
            return bool(found)

        self.until(is_there, START_S)
        return found[0]

    def call(self, service: int) -> float:
        """Seconds until the answer."""
        self._calls += 1
        begin = time.monotonic()
        self._connection.send(wire.encode_client(ms.ServiceRequest(service, self._calls, "cdr", NO_NAMES)))
        self.until(lambda one: isinstance(one, ms.ServiceResponse) and one.call_id == self._calls, ANSWER_S)
        return time.monotonic() - begin

    def set(self, text: str) -> None:
        """Set the playground."""
        parameters = (ms.Parameter("/simulator.playground", text),)
        self._connection.send(wire.encode_client(ms.SetParameters(parameters, "set")))

    def answer(self) -> str:
        """What became of it."""
        reported: list[str] = []

        def is_last(message: ms.ServerMessage) -> bool:
            if isinstance(message, ms.Status) and "playground" in message.message:
                reported.append(message.message)
            return isinstance(message, ms.ParameterValues) and message.id == "set"

        self.until(is_last, ANSWER_S)
        return reported[-1] if reported else "accepted"


def longest_call(viewer: Viewer, service: int, stop: threading.Event, found: list[float]) -> None:
    """Call again and again; keeps the longest time."""
    found.append(0.0)
    while not stop.is_set():
        found[0] = max(found[0], viewer.call(service))
        stop.wait(0.02)


def highest_mb(pid: int) -> int:
    """Memory of a process at its highest so far."""
    found = re.search(r"VmHWM:\s+(\d+)", Path(f"/proc/{pid}/status").read_text())
    return int(found[1]) // 1024 if found else 0


def connected(port: int, stack: ExitStack) -> Viewer:
    """A viewer, once the bridge listens; the stack disconnects it."""
    deadline = time.monotonic() + START_S
    while True:
        try:
            connecting = connect(
                f"ws://127.0.0.1:{port}", subprotocols=SUBPROTOCOLS, max_queue=None, max_size=None, ping_interval=None
            )
            return Viewer(stack.enter_context(connecting))
        except OSError:
            if time.monotonic() > deadline:
                raise
            time.sleep(0.1)


def main() -> int:
    """Start the nodes, attack them, end them."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--port", type=int, default=9765)
    port = parser.parse_args().port
    suite = subprocess.Popen(
        [sys.executable, "-c", COMMAND, "--no-web", "--foxglove-port", str(port)],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        start_new_session=True,
    )
    stack = ExitStack()
    try:
        other, hostile = connected(port, stack), connected(port, stack)
        service = other.service(SERVICE)
        end = time.monotonic() + ALONE_S
        alone = 0.0
        while time.monotonic() < end:
            alone = max(alone, other.call(service))
        print(f"the longest call alone: {alone * 1000:.0f} ms; {highest_mb(suite.pid)} MB", flush=True)
        print(f"{'playground':38} {'bytes':>10} {'answer':>8} {'calls':>8} {'memory':>8}  became", flush=True)
        for name, text in attacks().items():
            stop, longest = threading.Event(), []  # type: tuple[threading.Event, list[float]]
            thread = threading.Thread(target=longest_call, args=(other, service, stop, longest))
            thread.start()
            begin = time.monotonic()
            try:
                hostile.set(text)
                became = hostile.answer()
            except TimeoutError:
                became = "no answer"
            seconds = time.monotonic() - begin
            stop.set()
            thread.join()
            sizes = f"{len(text):10} {seconds:6.2f} s {longest[0] * 1000:5.0f} ms {highest_mb(suite.pid):5} MB"
            print(f"{name:38} {sizes}  {became[:150]}", flush=True)
        hostile.set(attacks()["100 half-transparent groups"])
        time.sleep(0.5)
        begin = time.monotonic()
        os.killpg(suite.pid, signal.SIGINT)
        suite.wait(60.0)
        print(f"Ctrl-C while a playground is loading: {time.monotonic() - begin:.2f} s, exit code {suite.returncode}")
    finally:
        if suite.poll() is None:
            os.killpg(suite.pid, signal.SIGKILL)
            suite.wait()
        stack.close()
    return 0


if __name__ == "__main__":
    sys.exit(main())
