"""Playgrounds made to stop the simulator, sent by one viewer while another one measures how long its calls take.

Each playground is sent as the parameter /simulator.playground of a `thymio-sim`. The columns are: bytes, seconds until
the answer, the longest call of the other viewer meanwhile, memory of the process at its highest so far, and the answer.
Texts of more than 4 MB do not pass the bridge; tests/sim/playground/test_format_detection.py measures those. Needs ROS.
"""

from __future__ import annotations

import argparse
import base64
import io
import json
import signal
import textwrap
import threading
import time

from PIL import Image

from benchmarks.lib.bridge_client import Peer, said
from benchmarks.lib.processes import status_mb, suite
from benchmarks.lib.report import Goal, Report, Table

QUICK = {"only": "4 MB of nested", "seconds": 0.3}
PARAMETER, SERVICE = "/simulator.playground", "/simulator/get_poses"
NO_NAMES = b"\0\1\0\0" + bytes(4)
ANSWER_S = 120.0
MOST_CALL_S, MOST_CTRL_C_S = 5.0, 5.0
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


def set_playground(viewer: Peer, text: str) -> None:
    """Set the playground."""
    viewer.socket.sendall(said(op="setParameters", parameters=[{"name": PARAMETER, "value": text}], id="set"))


def answer(viewer: Peer) -> str:
    """Return the answer: the reason why the playground was refused, else "accepted". Raises TimeoutError."""
    reasons = ["accepted"]
    deadline = time.monotonic() + ANSWER_S
    while True:
        body = viewer.next(max(0.0, deadline - time.monotonic()))
        if not body.startswith(b"{"):
            continue
        message = json.loads(body)
        if message["op"] == "status" and PARAMETER in message["message"]:
            reasons.append(message["message"].removeprefix(f"{PARAMETER}: uploaded playground: "))
        if message["op"] == "parameterValues" and message.get("id") == "set":
            return reasons[-1]


def longest_call(viewer: Peer, stop: threading.Event, found: list[float]) -> None:
    """Call again and again until `stop` is set; `found[0]` is the longest time."""
    found.append(0.0)
    while not stop.is_set():
        found[0] = max(found[0], viewer.call(SERVICE, NO_NAMES))
        stop.wait(0.02)


def add_options(parser: argparse.ArgumentParser) -> None:
    """Add options."""
    parser.add_argument("--only", default="", metavar="WORDS", help="playgrounds with this in their description")
    parser.add_argument("--seconds", type=float, default=3.0, help="of calls before the first playground")


def measure(options: argparse.Namespace) -> Report:
    """Send all playgrounds, and Ctrl-C while the last one is loading."""
    rows: list[list[str | float]] = []
    with suite("--no-web") as running:
        pid = running.process.pid
        other, hostile = Peer(running.bridge_port), Peer(running.bridge_port)
        other.until(lambda: SERVICE in other.services, "service")
        alone, end = 0.0, time.monotonic() + options.seconds
        while time.monotonic() < end:
            alone = max(alone, other.call(SERVICE, NO_NAMES))
        rows.append(["nothing", 0, 0, 1000 * alone, round(status_mb(pid, "VmHWM")), ""])
        for name, text in attacks().items():
            if options.only in name:
                seconds, longest, became = attack(hostile, other, text)
                rows.append([name, len(text), seconds, 1000 * longest, round(status_mb(pid, "VmHWM")), became])
        set_playground(hostile, attacks()["100 half-transparent groups"])
        time.sleep(0.5)
        begin = time.monotonic()
        running.process.signal(signal.SIGINT)
        code = running.process.wait()
        ctrl_c_s = time.monotonic() - begin
        other.socket.close()
        hostile.socket.close()
    if code:
        raise RuntimeError(f"exit code {code} after Ctrl-C")
    goals = [
        Goal("longest call of the other viewer", MOST_CALL_S, max(float(row[3]) for row in rows) / 1000, "s"),
        Goal("Ctrl-C while a playground is loading", MOST_CTRL_C_S, ctrl_c_s, "s"),
    ]
    return Report([Table(["playground", "bytes", "answer, s", "longest call, ms", "MB", "answer"], rows)], goals)


def attack(hostile: Peer, other: Peer, text: str) -> tuple[float, float, str]:
    """Send a playground; return the seconds until the answer, those of the longest call meanwhile, and the answer."""
    stop, longest = threading.Event(), []  # type: tuple[threading.Event, list[float]]
    thread = threading.Thread(target=longest_call, args=(other, stop, longest))
    thread.start()
    begin = time.monotonic()
    try:
        set_playground(hostile, text)
        became = answer(hostile)
    except TimeoutError:
        became = "no answer"
    seconds = time.monotonic() - begin
    stop.set()
    thread.join()
    return seconds, longest[0], textwrap.shorten(became.replace("|", "\\|"), 100, placeholder=" …")
