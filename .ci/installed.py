"""Look at an installation as `ros2 pkg`, `ros2 run` and `ros2 launch` do, then run every executable.

    python .ci/installed.py [--prefix FOLDER] [--package NAME]    FOLDER: where the ament index must find the package

NAME: this package, or that of the tutorial on packages. Each executable has to appear in the graph as the node it is
named after, and to end with exit code 0 on SIGINT.
"""

from __future__ import annotations

import argparse
import os
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path

import rclpy
from ament_index_python.packages import get_package_prefix, get_package_share_directory
from rclpy.node import Node

PACKAGE = "thymio_sim_ros"
# Executable → (arguments, nodes that must appear), by package. Port 0 takes a free one.
OURS = {
    "simulator": ([], {"simulator"}),
    "aseba_runtime": ([], {"aseba_runtime"}),
    "foxglove_bridge": (["-p", "port:=0"], {"foxglove_bridge"}),
    "web_ui": (["-p", "port:=0"], {"web_ui"}),
    "thymio": (
        ["-p", "foxglove_bridge:port:=0", "-p", "web_ui:port:=0"],
        {"simulator", "aseba_runtime", "foxglove_bridge"},
    ),
    **{
        name: ([], {name})
        for name in (
            "button_lights",
            "event_answer",
            "go_to_goal_odom",
            "go_to_goal_tf",
            "line_follower",
            "wall_follower",
        )
    },
}
EXECUTABLES = {PACKAGE: OURS, "my_robot": {"circle": ([], {"circle"})}}
SHARED = {
    PACKAGE: ["package.xml", "launch/thymio.launch.py", "playgrounds/line.json", "rviz/thymio.rviz"],
    "my_robot": ["package.xml"],
}
DEADLINE_S = 60.0


def main() -> int:
    """0 when everything is there and runs; else the first thing that is not, on stderr, and 1."""
    parser = argparse.ArgumentParser(description="Check an installation of thymio_sim_ros.")
    parser.add_argument("--prefix", type=Path, default=Path(sys.prefix))
    parser.add_argument("--package", choices=EXECUTABLES, default=PACKAGE)
    options = parser.parse_args()
    package, wanted = options.package, options.prefix.resolve()
    prefix = Path(get_package_prefix(package))
    if prefix.resolve() != wanted:
        return fail(f"the package was found in {prefix}, wanted {wanted}")
    share = Path(get_package_share_directory(package))
    missing = [name for name in SHARED[package] if not (share / name).is_file()]
    if missing:
        return fail(f"missing in {share}: {', '.join(missing)}")
    os.environ["ROS_AUTOMATIC_DISCOVERY_RANGE"] = "LOCALHOST"
    domain, held = reserve_domain()
    os.environ["ROS_DOMAIN_ID"] = str(domain)
    rclpy.init(args=[], domain_id=domain)
    observer = Node("observer")
    try:
        for name, (arguments, nodes) in EXECUTABLES[package].items():
            problem = run(prefix / "lib" / package / name, arguments, nodes, observer)
            if problem:
                return fail(f"{name}: {problem}")
            print(f"{name}: started and ended", flush=True)
    finally:
        observer.destroy_node()
        rclpy.try_shutdown()
        held.close()
    return 0


def run(executable: Path, arguments: list[str], nodes: set[str], observer: Node) -> str | None:
    """Start, wait for the nodes, interrupt; None or what went wrong."""
    if not os.access(executable, os.X_OK):
        return f"{executable} is not executable"
    process = subprocess.Popen(
        [executable, "--ros-args", *arguments],
        start_new_session=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
    )
    try:
        problem = wait_for(nodes, observer, process)
        if problem:
            return problem
        os.killpg(process.pid, signal.SIGINT)
        code = process.wait(timeout=DEADLINE_S)
        return f"exit code {code} after SIGINT" if code else None
    except subprocess.TimeoutExpired:
        return f"still there {DEADLINE_S} s after SIGINT"
    finally:
        if process.poll() is None:
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()


def wait_for(nodes: set[str], observer: Node, process: subprocess.Popen[bytes]) -> str | None:
    """Until the graph shows the nodes; None or what went wrong."""
    deadline = time.monotonic() + DEADLINE_S
    while time.monotonic() < deadline:
        if nodes <= set(observer.get_node_names()):
            return None
        if process.poll() is not None:
            return f"ended with {process.returncode} before its node appeared"
        rclpy.spin_once(observer, timeout_sec=0.1)
    return f"no {', '.join(nodes - set(observer.get_node_names()))} in the graph within {DEADLINE_S} s"


def reserve_domain() -> tuple[int, socket.socket]:
    """An unused domain id, reserved by a loopback port."""
    for domain in range(1, 101):
        held = socket.socket()
        try:
            held.bind(("127.0.0.1", 22000 + domain))
        except OSError:
            held.close()
        else:
            return domain, held
    raise SystemExit("no free domain id")


def fail(problem: str) -> int:
    """Say what is wrong."""
    sys.stderr.write(f"installed.py: {problem}\n")
    return 1


if __name__ == "__main__":
    sys.exit(main())
