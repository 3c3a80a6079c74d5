"""A client that sends requests to an Aseba port without pause and reads the answers, as a process of its own."""

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
def flooded(port: int) -> Iterator[None]:
    """Flood a port of this computer."""
    process = subprocess.Popen([sys.executable, "-m", __name__, str(port)], stdout=subprocess.PIPE)
    try:
        assert process.stdout is not None
        process.stdout.readline()  # the first answer has arrived
        yield
    finally:
        process.kill()
        process.communicate()


def main() -> None:
    """Flood a port until the process is ended."""
    with socket.create_connection(("127.0.0.1", int(sys.argv[1]))) as stream:
        stream.setblocking(False)
        waiting, is_answered = memoryview(REQUESTS), False
        while True:
            readable, writable, _ = select.select([stream], [stream], [])
            if readable and not stream.recv(1 << 20):
                return
            if readable and not is_answered:
                is_answered = True
                print("answered", flush=True)
            if writable:
                waiting = waiting[stream.send(waiting) :] or memoryview(REQUESTS)


if __name__ == "__main__":
    main()
