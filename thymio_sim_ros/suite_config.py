"""Configuration of a start of the whole suite, shared by the command line and the nodes."""

from __future__ import annotations

from dataclasses import dataclass

from thymio_sim_ros.access.tokens import Tokens
from thymio_sim_ros.device.options import DEFAULTS, DeviceOptions
from thymio_sim_ros.names.ports import FOXGLOVE_PORT, HTTP_PORT
from thymio_sim_ros.network.settings import NetworkSettings
from thymio_sim_ros.page_nodes.who import Who
from thymio_sim_ros.sim.commands import MOTOR_MODELS
from thymio_sim_ros.sim.model.lidar import Lidar
from thymio_sim_ros.sim.model.robot_constants import PROXIMITY_MODELS

ADDRESS = "localhost"
"""Loopback only, unless the network is requested."""
OUT_OF_RANGE = ("rep117", "driver")
"""Ranges without an obstacle and too close: +inf and -inf as in REP 117, or -1 and the minimum as in the driver."""
REPLAY_FROM_S = -3.0
"""A replay starts shortly before its end, which is the failure of a test."""


NO_SERVERS = NetworkSettings()


@dataclass(frozen=True)
class SuiteConfig:
    """Options of simulator, Aseba runtime, Foxglove bridge and page.

    Attributes:
        playground: shipped name, path or JSON text.
        program: name of a behavior, or path.
        behaviour: built-in behavior after switching on, from whose menu the program can be started; empty for none.
        lidar: that of each robot, None for robots without one.
        like: profile whose names and types there are besides (`ros/profiles/`), empty for none.
        robot: address of a real robot, in place of the simulator; empty for none.
        address: address on which page and bridge listen, `ADDRESS` or an IPv4 address.
        foxglove_port: port of the bridge; `OFF`: none beside that of the page, which serves it as well.
        certificate, key: PEM files with which page and bridge speak https and wss; empty: http and ws.
        log: file of a run log, empty for none.
        replay: run log whose last run is shown in place of a playground, empty for none.
        replay_from_s: time at which it is paused at first; negative: before its end.
        cmd_vel_timeout_s: time after which a velocity ends; short, because teleoperation in the browser sends nothing
            on release (docs/spec/ros-interface.md section 13).
        tokens: tokens that clients of page and bridge need; None lets the bridge choose.
        trusted_proxies: addresses and networks of reverse proxies in front of page and bridge.
        nodes: who may run ROS nodes that are written on the page.
        network: servers by which other programs reach the robots; none by default.
    """

    playground: str = "desk"
    program: str = "welcome"
    behaviour: str = ""
    device: DeviceOptions = DEFAULTS
    motor_model: str = MOTOR_MODELS[0]
    proximity_model: str = PROXIMITY_MODELS[0]
    lidar: Lidar | None = None
    out_of_range: str = OUT_OF_RANGE[0]
    like: str = ""
    robot: str = ""
    address: str = ADDRESS
    port: int = HTTP_PORT
    foxglove_port: int = FOXGLOVE_PORT
    certificate: str = ""
    key: str = ""
    web: bool = True
    foxglove: bool = True
    seed: int = 0
    log: str = ""
    replay: str = ""
    replay_from_s: float = REPLAY_FROM_S
    real_time_factor: float = 1.0
    cmd_vel_timeout_s: float = 0.5
    tokens: Tokens | None = None
    trusted_proxies: tuple[str, ...] = ()
    nodes: Who = Who.LOCAL
    network: NetworkSettings = NO_SERVERS
