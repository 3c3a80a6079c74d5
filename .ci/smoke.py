"""The main job from an installed wheel: start the suite, see the robot move, stop it. Argument: the environment."""

from __future__ import annotations

import asyncio
import contextlib
import json
import os
import re
import signal
import socket
import struct
import subprocess
import sys
import time
import urllib.request
from pathlib import Path

import websockets

DEADLINE_S = 60.0
END_S = 60.0


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return int(probe.getsockname()[1])


def main(prefix: Path) -> None:
    check_files(prefix)
    port, foxglove_port = free_port(), free_port()
    before = set(os.listdir("/dev/shm"))
    ports = ["--port", str(port), "--foxglove-port", str(foxglove_port)]
    command = [prefix / "bin" / "thymio-sim", "--program", "line_follower", *ports]
    environment = os.environ | {"ROS_DOMAIN_ID": "97"}
    suite = subprocess.Popen(command, stdout=subprocess.PIPE, text=True, env=environment, start_new_session=True)
    try:
        assert suite.stdout is not None
        graph = next(line for line in suite.stdout if line.startswith("ROS "))
        assert "ROS 2" in graph, graph
        address = next(line for line in suite.stdout if line.startswith("Page "))
        assert str(port) in address, address
        page = urllib.request.urlopen(f"http://127.0.0.1:{port}/", timeout=DEADLINE_S).read().decode()
        assert "<script" in page, page[:300]
        asyncio.run(asyncio.wait_for(see_it_move(foxglove_port), DEADLINE_S))
        shared_memory = set(re.findall(r"/dev/shm/(\S+)", Path(f"/proc/{suite.pid}/maps").read_text()))
        assert shared_memory
        begin = time.monotonic()
        os.killpg(suite.pid, signal.SIGINT)
        code = suite.wait(END_S)
        print(f"ended with {code} after {time.monotonic() - begin:.2f} s")
        assert code == 0
        # The lock of a segment has its name and "_el".
        own = {name for name in set(os.listdir("/dev/shm")) - before if name.removesuffix("_el") in shared_memory}
        left = {name for name in own if not is_mapped(f"/dev/shm/{name}")}
        assert not left, f"left in /dev/shm: {left}"
    finally:
        if suite.poll() is None:
            os.killpg(suite.pid, signal.SIGKILL)


def is_mapped(path: str) -> bool:
    """Whether a process uses a file: another ROS program of this machine may have opened it meanwhile."""
    for process in Path("/proc").glob("[0-9]*"):
        with contextlib.suppress(OSError):
            if path in (process / "maps").read_text():
                return True
    return False


def check_files(prefix: Path) -> None:
    """The ament index entry, the executables and the shared files that ros2 looks for."""
    wanted = [
        prefix / "share/ament_index/resource_index/packages/thymio_sim_ros",
        prefix / "share/thymio_sim_ros/package.xml",
        prefix / "share/thymio_sim_ros/launch/thymio.launch.py",
        prefix / "share/thymio_sim_ros/playgrounds/line.json",
        *(
            prefix / "lib/thymio_sim_ros" / name
            for name in ("simulator", "aseba_runtime", "foxglove_bridge", "web_ui", "thymio")
        ),
    ]
    absent = [str(path) for path in wanted if not path.is_file()]
    assert not absent, f"not installed: {absent}"
    for path in wanted[4:]:
        assert os.access(path, os.X_OK), f"not executable: {path}"


async def see_it_move(port: int) -> None:
    """Two different positions of /odom through the bridge."""
    protocols = [websockets.Subprotocol("foxglove.sdk.v1")]
    async with websockets.connect(f"ws://127.0.0.1:{port}", subprotocols=protocols) as client:
        seen: set[float] = set()
        async for message in client:
            if isinstance(message, str):
                for channel in json.loads(message).get("channels", []):
                    if channel["topic"] == "/odom":
                        subscription = {"id": 1, "channelId": channel["id"]}
                        await client.send(json.dumps({"op": "subscribe", "subscriptions": [subscription]}))
            elif message[0] == 1:
                seen.add(position_x(message[13:]))
                if len(seen) > 5:
                    print(f"odometry moves: {sorted(seen)[-1]:.3f} m")
                    return


def position_x(cdr: bytes) -> float:
    """pose.pose.position.x of a serialized nav_msgs/Odometry."""
    offset = 4 + 8
    for _ in range(2):
        offset += -(offset - 4) % 4
        (size,) = struct.unpack_from("<I", cdr, offset)
        offset += 4 + size
    offset += -(offset - 4) % 8
    return float(struct.unpack_from("<d", cdr, offset)[0])


if __name__ == "__main__":
    main(Path(sys.argv[1]).resolve())
