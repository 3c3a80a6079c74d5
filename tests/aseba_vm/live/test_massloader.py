"""The reference's compiler for a node of this package: Debian's asebamassloader sends the same bytecode."""

from __future__ import annotations

import os
import shutil
import socket
import subprocess
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from aseba_vm import aesl, compile
from aseba_vm.targets import THYMIO_II
from tests.aseba_vm.live.wire import (
    GET_NODE_DESCRIPTION,
    LIST_NODES,
    PRESENT,
    RUN,
    SET_BYTECODE,
    Wire,
    describe,
)
from tests.aseba_vm.vectors import load
from tests.patience import PATIENCE_S

LOCALE = Path("/usr/lib/locale/C.utf8")

pytestmark = [
    pytest.mark.process,
    pytest.mark.slow,
    pytest.mark.skipif(not LOCALE.is_dir(), reason="the loader needs a locale with UTF-8"),
    pytest.mark.skipif(shutil.which("asebamassloader") is None, reason="Debian's package aseba is not installed"),
]
NODE = 1


def _programs():
    """Return one program of each of the first families: each takes one second, which the loader waits."""
    chosen = {}
    for vector in load("aseba-compile"):
        if vector["target"] == "thymio2" and "\x00" not in vector["source"] and "\r" not in vector["source"]:
            chosen.setdefault(vector["family"], vector)
    return [chosen[family] for family in sorted(chosen)][:48]


@pytest.fixture(scope="module")
def loaded(tmp_path_factory):
    """Return what the loader sends for each program; many run at once, since it waits a second before it asks."""
    folder = tmp_path_factory.mktemp("programs")
    locales = folder / "locales"  # the loader requires the locale en_US, which has the same characters as C.UTF-8
    locales.mkdir()
    (locales / "en_US.UTF-8").symlink_to(LOCALE)
    jobs = [(vector, folder / f"{number}.aesl", locales) for number, vector in enumerate(_programs())]
    with ThreadPoolExecutor(8) as pool:
        return dict(pool.map(_load, jobs))


@pytest.mark.parametrize("vector", _programs(), ids=lambda vector: vector["id"])
def test_the_reference_sends_our_words(vector, loaded):
    program = compile(vector["source"], THYMIO_II, vector["events"], vector["constants"])
    assert loaded[vector["id"]] == program.words


def _load(job):
    """Serve one node to a mass loader; return the program's name and the bytecode that came."""
    vector, path, locales = job
    events = tuple((name, size) for name, size in vector["events"])
    constants = tuple((name, value) for name, value in vector["constants"])
    node = aesl.Node(THYMIO_II.name, NODE, vector["source"])
    path.write_text(aesl.dumps(aesl.Network(events, constants, nodes=(node,))), "utf-8")
    with socket.create_server(("127.0.0.1", 0)) as server:
        server.settimeout(PATIENCE_S)
        command = ["asebamassloader", "--once", str(path), f"tcp:host=127.0.0.1;port={server.getsockname()[1]}"]
        environment = os.environ | {"LOCPATH": str(locales)}
        quiet = subprocess.DEVNULL
        with subprocess.Popen(command, env=environment, stdout=quiet, stderr=quiet) as process:
            try:
                stream, _ = server.accept()
                with stream:
                    return vector["id"], _serve(Wire(stream))
            finally:
                process.kill()


def _serve(wire):
    """Answer a client until it starts the program."""
    memory: list[int] = []
    is_described = False
    while True:
        frame = wire.receive()
        if frame.kind == LIST_NODES:
            wire.send_words(NODE, PRESENT, 5)
        elif frame.kind == GET_NODE_DESCRIPTION and not is_described:
            describe(wire, NODE, THYMIO_II)
            is_described = True
        elif frame.kind == SET_BYTECODE:
            _, start, *words = frame.words
            memory[start:] = words
        elif frame.kind == RUN:
            return tuple(memory)
