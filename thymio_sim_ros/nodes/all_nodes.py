"""All nodes in one process, each on an executor and a thread of its own: `ros2 run thymio_sim_ros thymio`.

The nodes are the same as in separate processes and talk by the same topics.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence

from rclpy.context import Context

from thymio_sim_ros.loading import load_playground
from thymio_sim_ros.nodes.aseba_node import AsebaRuntime, RuntimeParams
from thymio_sim_ros.nodes.life import Host, greeted, run_main
from thymio_sim_ros.nodes.names import ros_names
from thymio_sim_ros.nodes.simulator_node import Simulator, SimulatorParams
from thymio_sim_ros.suite import Suite


def lives(context: Context, suite: Suite) -> Iterator[Host]:
    """Simulator, Aseba runtime and, as wanted, bridge and page, in the order of their start."""
    simulator = SimulatorParams(
        playground=suite.playground,
        seed=suite.seed,
        motor_model=suite.motor_model,
        proximity_model=suite.proximity_model,
        log=suite.log,
        real_time_factor=suite.real_time_factor,
        cmd_vel_timeout=suite.cmd_vel_timeout_s,
    )
    _, playground = load_playground(suite.playground)
    robots = [names.name for names in ros_names(tuple(robot.name for robot in playground.robots)).values()]
    yield Simulator(context, simulator)
    device = suite.device
    runtime = RuntimeParams(
        robots=robots,
        path=suite.program,
        behaviour=suite.behaviour,
        layout=device.layout,
        events=device.events,
        card=str(device.card or ""),
        settings=str(device.settings or ""),
    )
    yield AsebaRuntime(context, runtime, use_sim_time=True)
    tokens = suite.tokens
    if suite.foxglove:
        from thymio_sim_ros.nodes.foxglove_node import FoxgloveBridge

        bridge = FoxgloveBridge(
            context=context, address=suite.address, port=suite.foxglove_port, use_sim_time=True, tokens=tokens
        )
        tokens = bridge.tokens
        yield bridge
    if suite.web:
        from thymio_sim_ros.nodes.web_node import WebPage, WebParams

        web = WebParams(address=suite.address, port=suite.port, foxglove_port=suite.foxglove_port)
        yield WebPage(context, web, tokens)


def run(suite: Suite, args: Sequence[str] | None = None, *, on_ready: Callable[[], None] = lambda: None) -> int:
    """Run the suite until SIGINT or SIGTERM; the exit code."""
    return run_main(lambda context: lives(context, suite), args, on_ready=on_ready)


def main(args: Sequence[str] | None = None) -> int:
    """The executable `thymio`: the suite with its defaults, ROS arguments for everything else."""
    return run_main(lambda context: greeted(lives(context, Suite())), args)
