"""Clients that send requests to an Aseba port without pause and read the answers, as a process of their own."""

from __future__ import annotations

import contextlib
import select
import socket
import subprocess
import sys
from collections.abc import Iterator

from aseba_vm.protocol import GetVariables, encode

REQUESTS = encode(GetVariables(0, 1, 0, 256)) * 100


@contextlib.contextmanager
def flooded(port: int, clients: int = 1) -> Iterator[None]:
    """Flood a port of this computer."""
    process = subprocess.Popen([sys.executable, "-m", __name__, str(port), str(clients)], stdout=subprocess.PIPE)
    try:
        assert process.stdout is not None
        process.stdout.readline()  # the first answer has arrived
        yield
    finally:
        process.kill()
        process.communicate()


def main() -> None:
    """Flood a port until the process is ended."""
    waiting = {}
    for _ in range(int(sys.argv[2])):
        stream = socket.create_connection(("127.0.0.1", int(sys.argv[1])))
        stream.setblocking(False)
        waiting[stream] = memoryview(REQUESTS)
    is_answered = False
    while True:
        readable, writable, _ = select.select(waiting, waiting, [])
        for stream in readable:
            if not stream.recv(1 << 20):
                return
            if not is_answered:
                is_answered = True
                print("answered", flush=True)
        for stream in writable:
            waiting[stream] = waiting[stream][stream.send(waiting[stream]) :] or memoryview(REQUESTS)


if __name__ == "__main__":
    main()
