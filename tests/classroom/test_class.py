"""A class of two real pupils, started once."""

from __future__ import annotations

import asyncio
import base64
import io
import json
import signal
import socket
import urllib.error
import urllib.request
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from websockets.asyncio.client import connect
from websockets.exceptions import ConnectionClosed, WebSocketException

from tests.bridge.peers import Client, run
from tests.classroom.class_support import RunningClass
from tests.network.tdm.remote_client import with_robot
from tests.patience import PATIENCE_S, until
from thymio_sim_ros.bridge.protocol import messages as ms
from thymio_sim_ros.bridge.protocol import wire
from thymio_sim_ros.bridge.protocol.constants import SUBPROTOCOLS
from thymio_sim_ros.classroom.cdr import read_string
from thymio_sim_ros.classroom.suite_state import read_state
from thymio_sim_ros.cli import main as commands
from thymio_sim_ros.files import resources
from thymio_sim_ros.network.tdm.protocol import messages as tdm
from thymio_sim_ros.network.tdm.protocol.codec import decode, encode
from thymio_sim_ros.testing.ros.domain import reserved

pytestmark = pytest.mark.process

ADA, BEN = "ada", "ben"
PROGRAM = "onevent button.forward\nmotor.left.target = 100\n"
DRAFT = PROGRAM + "motor.right.target ="
NODE = "import rclpy\n"


@pytest.fixture(scope="module")
def group(tmp_path_factory: pytest.TempPathFactory) -> Iterator[RunningClass]:
    """The class of Ada and Ben, on embedded graphs."""
    running = RunningClass(tmp_path_factory.mktemp("class"), ["Ada", "Ben"])
    try:
        for pupil in ("ada", "ben"):
            running.until(pupil, lambda one: one["phase"] == "running" and one["programs"])
        yield running
    finally:
        running.end()


def asked(url: str, request: ms.ClientMessage, names: tuple[str, ...] = ()) -> dict[str, Any]:
    """The values of parameters of a suite after a request of its pupil."""

    async def talk() -> dict[str, Any]:
        async with connect(url, subprotocols=SUBPROTOCOLS, max_size=None) as connection:
            client = Client(connection)
            await client.send(request, ms.GetParameters(names, "asked"))
            while (values := await client.next(ms.ParameterValues)).id != "asked":
                pass
            return {one.name: one.value for one in values.parameters}

    return run(talk())


def values_of(group: RunningClass, pupil: str, *wanted: str) -> tuple[Any, ...]:
    """Parameters of a pupil's suite."""
    values = asked(group.bridge_of(pupil), ms.GetParameters(wanted), wanted)
    return tuple(values.get(parameter) for parameter in wanted)


def notice(group: RunningClass, pupil: str) -> Any:
    return values_of(group, pupil, "/web_ui.notice", "/web_ui.notice_link")


def test_a_bridge_needs_the_token_of_its_pupil(group: RunningClass) -> None:
    for token in ("", group.token_of(BEN)):
        with pytest.raises((WebSocketException, TimeoutError)):
            asked(group.bridge_of(ADA, token), ms.GetParameters(()))
    with pytest.raises(urllib.error.HTTPError, match="401"):
        group.request("state", token=group.token_of(ADA))


def nodes_of_manager(address: str, password: str) -> Any:
    """The nodes that a device manager shows to a client."""

    async def talk() -> Any:
        async with connect(address) as connection:
            await connection.send(encode(tdm.ConnectionHandshake(password=password)))
            while not isinstance(message := decode(await connection.recv()), tdm.NodesChanged):
                pass
            return message.nodes

    return run(talk())


def test_other_programs_use_the_robot_of_a_pupil_on_the_port_of_the_class(group: RunningClass) -> None:
    """Two devices of Ada: what one loads by the Thymio Device Manager, the other reads by HTTP."""

    def nodes(token: str, name: str = "") -> Any:
        url = f"http://127.0.0.1:{group.port}/p/{ADA}/nodes{name}?token={token}"
        with urllib.request.urlopen(url, timeout=PATIENCE_S) as answer:
            return json.loads(answer.read())

    async def drive(node: Any) -> str:
        assert await node.compile("var found = 78\n") is None
        await node.run()
        return str(node.props["name"])

    token = group.token_of(ADA)
    address = f"ws://127.0.0.1:{group.port}/p/{ADA}/tdm"
    assert [node["name"] for node in nodes(token)] == ["thymio-II"]
    assert with_robot(address, token, drive) == "thymio-II"
    until(lambda: nodes(token, "/thymio-II/found") == [78])
    assert len(nodes_of_manager(address, token)) == 1
    for wrong in ("", group.token_of(BEN)):
        with pytest.raises(urllib.error.HTTPError, match="401"):
            nodes(wrong)
        with pytest.raises(ConnectionClosed):
            nodes_of_manager(address, wrong)


def test_poses_come_while_the_page_of_the_teacher_is_open(group: RunningClass) -> None:
    found = group.until("ben", lambda one: one["overview"])
    assert len(found["overview"]["robots"]["thymio"]) == 6


def test_one_is_paused_and_the_other_runs(group: RunningClass) -> None:
    group.request("pause", {"pupils": ["ada"], "paused": True})
    group.until("ada", lambda one: one["paused"])
    assert not group.pupil("ben")["paused"]
    group.request("pause", {"pupils": None, "paused": False})
    group.until("ada", lambda one: not one["paused"])


def test_a_pause_of_the_teacher_holds_until_the_teacher_ends_it(group: RunningClass) -> None:
    group.request("pause", {"pupils": ["ada"], "paused": True})
    group.until("ada", lambda one: one["paused"])
    page = "/web_ui.paused_by_teacher"
    assert values_of(group, ADA, page, "/web_ui.pupil") == (True, "Ada")
    assert values_of(group, BEN, page, "/web_ui.pupil") == (False, "Ben")
    for _ in range(2):
        assert run(answer_after_resuming(group)) == "running"  # and then the class pauses it
    group.request("pause", {"pupils": None, "paused": False})
    group.until("ada", lambda one: not one["paused"])
    assert values_of(group, ADA, page) == (False,)


async def answer_after_resuming(group: RunningClass) -> str:
    """The answer when the page of a pupil asks to let time run; returns when time is paused again.

    The state in between may be replaced before it is sent; while time runs, the state comes once a second.
    """
    url = group.bridge_of(ADA)
    service: int | None = None
    answer, is_requested = "", False
    async with asyncio.timeout(PATIENCE_S), connect(url, subprotocols=SUBPROTOCOLS, max_size=None) as connection:
        client = Client(connection)
        async for frame in connection:
            match wire.decode_server(frame):
                case ms.AdvertiseServices(services=services):
                    service = next((one.id for one in services if one.name == "/simulator/pause"), service)
                case ms.Advertise(channels=channels):
                    states = [ms.Subscription(1, one.id) for one in channels if one.topic == "/simulator/_state"]
                    await client.send(*(ms.Subscribe((one,)) for one in states))
                case ms.ServiceResponse(payload=payload):
                    answer = json.loads(payload)["message"]
                case ms.MessageData(payload=payload):
                    if service is not None and not is_requested:
                        is_requested = True
                        await client.send(ms.ServiceRequest(service, 1, "json", b'{"data": false}'))
                    elif answer and read_state(read_string(payload)).paused:
                        break
    return answer


def test_a_message_and_a_robot_that_is_shown_arrive_on_the_page(group: RunningClass) -> None:
    group.request("message", {"pupils": ["ada"], "text": "Bitte schön"})
    group.request("show", {"pupil": "ben"})
    watch = group.pupil("ben")["watch"].replace("../p/", "../")  # from the page of a pupil
    group.until("ada", lambda _one: notice(group, ADA) == ("Bitte schön", watch))
    group.request("show", {"pupil": None})
    group.until("ada", lambda _one: notice(group, ADA) == ("Bitte schön", ""))
    assert notice(group, BEN) == ("", "")


def test_a_suite_that_is_killed_starts_again_with_its_work_and_message(group: RunningClass) -> None:
    room = resources.playgrounds()["line"].read_bytes()
    playground = f"data:application/octet-stream;name=Zimmer%201.json;base64,{base64.b64encode(room).decode()}"
    changes = (
        ms.Parameter("/aseba_runtime.script.name", "Kreis für Zoë.aesl"),
        ms.Parameter("/aseba_runtime.script.source", PROGRAM),
        ms.Parameter("/simulator.playground", playground),
        ms.Parameter("/web_ui.draft", DRAFT),
        ms.Parameter("/web_ui.node_draft", NODE),
    )
    asked(group.bridge_of(ADA), ms.SetParameters(changes, "set"))
    group.request("message", {"pupils": ["ada"], "text": "still there"})
    works = {"Ada/": "", "Ada/program.aesl": PROGRAM, "Ada/draft.aesl": DRAFT, "Ada/draft.py": NODE, "Ben/": ""}
    group.until("ada", lambda _one: zipped(group) == works)
    plan = group.until("ada", lambda one: one["plan"] != group.pupil("ben")["plan"])["plan"]
    before = group.pupil("ada")
    group.suite(ADA).kill()
    after = group.until("ada", lambda one: one["restarts"] == 1 and one["phase"] == "running" and one["programs"])
    assert after["reason"] == "ended by SIGKILL"
    assert after["link"] == before["link"]
    assert after["programs"][0]["program"] == "Kreis für Zoë.aesl"
    assert after["plan"] == plan
    ben = group.pupil("ben")
    assert ben["restarts"] == 0, ben["reason"]
    names = ("/aseba_runtime.script.source", "/simulator.playground")
    assert values_of(group, ADA, *names) == (PROGRAM, playground)
    group.until("ada", lambda _one: notice(group, ADA)[0] == "still there")


def test_suites_end_when_the_class_is_killed(tmp_path: Path) -> None:
    running = RunningClass(tmp_path, ["Ada"])
    running.until("ada", lambda one: one["phase"] == "running")
    suites = running.suites()
    assert suites
    running.process.signal(signal.SIGKILL)
    running.process.wait()
    until(lambda: not any(one.is_running() for one in suites), lambda: str(suites))


def test_with_ros_each_pupil_has_a_domain(tmp_path: Path) -> None:
    pytest.importorskip("rclpy")
    with reserved() as domain:
        running = RunningClass(tmp_path, ["Ada"], arguments=("--ros", "--first-domain", str(domain)))
        try:
            running.until("ada", lambda one: one["phase"] == "running" and one["programs"])
            assert running.process.output.startswith(f"ROS       ROS_DOMAIN_ID {domain} to {domain}")
            log = running.folder / "pupils" / "ada" / "suite.log"
            assert log.read_text().startswith(f"ROS       ROS 2, ROS_DOMAIN_ID {domain}, this computer only")
        finally:
            running.end()


@pytest.mark.slow
def test_the_teacher_restarts_a_suite(group: RunningClass) -> None:
    before = group.suite(BEN)
    group.request("restart", {"pupils": ["ben"]})
    ben = group.until("ben", lambda one: one["phase"] == "running" and one["programs"] and group.suite(BEN) != before)
    assert ben["restarts"] == 0, ben["reason"]


def zipped(group: RunningClass) -> dict[str, str]:
    with zipfile.ZipFile(io.BytesIO(group.request("programs.zip"))) as archive:
        return {name: archive.read(name).decode() for name in archive.namelist()}


@pytest.mark.parametrize(
    ("arguments", "reason"),
    [
        (["--pupils", "missing.csv"], "missing.csv: No such file"),
        (["--pupils", "{names}", "--playground", "nowhere"], "nowhere"),
        (["--pupils", "{names}", "--ros", "--first-domain", "232"], "the last domain would be 233"),
        (["--pupils", "{names}", "--first-domain", "7"], "expected --ros"),
        (["--pupils", "{names}", "--key", "key.pem"], "--key: expected --certificate"),
        (["--pupils", "{names}", "--certificate", "{names}"], "--certificate: "),
    ],
)
def test_wrong_options_are_refused_before_anything_starts(
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    arguments: list[str],
    reason: str,
) -> None:
    monkeypatch.setattr("thymio_sim_ros.cli.classroom.check_ros", lambda: None)  # whether ROS 2 is installed or not
    names = tmp_path / "names.csv"
    names.write_text("Ada\nBen\n")
    assert commands.main(["class", *(one.format(names=names) for one in arguments)]) == 2
    assert reason in capsys.readouterr().err


def test_a_port_that_is_used_is_refused_before_anything_starts(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    names = tmp_path / "names.csv"
    names.write_text("Ada\n")
    with socket.create_server(("127.0.0.1", 0)) as used:
        port = used.getsockname()[1]
        assert commands.main(["class", "--pupils", str(names), "--port", str(port)]) == 2
    assert f"port {port} of the class" in capsys.readouterr().err
