"""The whole suite: simulator and Aseba runtime in one process, Foxglove bridge and web page in others.

ros2 launch thymio_sim_ros thymio.launch.py playground:=line program:=line_follower
"""

from __future__ import annotations

import json
import secrets
from pathlib import Path

from launch import LaunchContext, LaunchDescription
from launch.actions import DeclareLaunchArgument, OpaqueFunction, SetEnvironmentVariable, Shutdown
from launch.conditions import IfCondition
from launch.events.process import ProcessExited
from launch.substitutions import LaunchConfiguration, PathJoinSubstitution
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue
from launch_ros.substitutions import FindPackageShare

REFUSED = 2
"""Exit code of a node that rejected its arguments; it has logged the reason."""

RESPAWN_DELAY_S = 1.0
"""Time before a node is started again, with `respawn`."""

LOOPBACK = ("localhost", "127.0.0.1", "::1")
TOKENS = ("THYMIO_SIM_TOKEN", "THYMIO_SIM_READ_ONLY_TOKEN")

ARGUMENTS = {
    "playground": ("desk", "playground: the name of a shipped one, or a file"),
    "program": ("welcome", "Aseba program: the name of a built-in one, an .aesl file, or none"),
    "behaviour": ("", "built-in behavior, such as menu, that runs when the robot is switched on; '' for the program"),
    "card": ("", "folder used as the robots' memory card; '' for no card"),
    "settings": ("", "folder in which the robots' settings are stored; '' does not store them"),
    "layout": ("thymio", "variables and native functions: thymio (firmware 14) or playground (Aseba Playground)"),
    "events": ("firmware", "event policy: firmware (events wait) or playground (an event ends the running handler)"),
    "motor_model": ("ideal", "motor model: ideal (no lag) or firmware (the robot's control loop and its lag)"),
    "proximity_model": ("default", "proximity sensor model, see docs/robot.md"),
    "lidar": ("false", "give each robot a laser scanner, topic scan; a real Thymio has none"),
    "seed": ("0", "seed of the random numbers of all noise"),
    "log": ("", "file for a run log, for thymio-sim replay; '' for none"),
    "real_time_factor": ("1.0", "simulated seconds per second; 0 runs as fast as possible"),
    "cmd_vel_timeout": ("0.0", "seconds after which a velocity command ends; 0 for never"),
    "driver_compat": (
        "false",
        "ranges as in the ROS driver of the real Thymio (-1 if out of range), and all its topics",
    ),
    "namespace": ("", "namespace of all nodes and robots, such as lab1"),
    "robot_names": ("['']", "names of the robots, such as [anna, bert]; [''] keeps those of the playground"),
    "namespaced_tf": (
        "false",
        "frames without prefix, on tf and tf_static in the namespace of each robot",
    ),
    "params_file": ("", "YAML file of ROS parameters for all nodes; it overrides these arguments"),
    "address": ("localhost", "address on which page and bridge listen; 0.0.0.0 for all IPv4 interfaces"),
    "require_token": ("true", "whether clients need a token if the address is reachable from the network"),
    "port": ("8080", "TCP port of the page"),
    "foxglove_port": ("8765", "TCP port of the Foxglove bridge"),
    "web": ("true", "serve the page"),
    "rviz": ("false", "start RViz with a configuration for the robots (needs the package rviz2)"),
    "respawn": ("false", "restart nodes that exit"),
}
CHOICES = {
    "layout": ["thymio", "playground"],
    "events": ["firmware", "playground"],
    "motor_model": ["ideal", "firmware"],
    "proximity_model": ["default", "enki", "cone"],
}


WORLD_TOPICS = ("_markers", "_markers/objects", "map")
"""Topics of the world, which are absolute in the RViz configuration; they are remapped into the namespace."""


def generate_launch_description() -> LaunchDescription:
    """The processes and, optionally, RViz; all except the simulator have simulated time."""
    value = {name: LaunchConfiguration(name) for name in ARGUMENTS}
    return LaunchDescription(
        [
            *(
                DeclareLaunchArgument(name, default_value=default, description=text, choices=CHOICES.get(name))
                for name, (default, text) in ARGUMENTS.items()
            ),
            # RViz is first: if rviz2 is missing, launch ends immediately, without stopping nodes that are running.
            Node(
                package="rviz2",
                executable="rviz2",
                namespace=value["namespace"],
                arguments=["-d", PathJoinSubstitution([FindPackageShare("thymio_sim_ros"), "rviz", "thymio.rviz"])],
                parameters=[{"use_sim_time": True}],
                remappings=[(f"/{name}", name) for name in WORLD_TOPICS],
                condition=IfCondition(value["rviz"]),
            ),
            OpaqueFunction(function=_give_tokens),
            OpaqueFunction(function=_nodes),
        ]
    )


def _nodes(context: LaunchContext) -> list[Node]:
    """The processes of the suite with their parameters. Raises RuntimeError if there is no such file of parameters."""
    value = {name: LaunchConfiguration(name) for name in ARGUMENTS}
    text = {name: configuration.perform(context) for name, configuration in value.items()}
    file = text["params_file"]
    if file and not Path(file).expanduser().is_file():
        raise RuntimeError(f"params_file: found '{file}', expected a YAML file of ROS parameters")
    shared = [str(Path(file).expanduser())] if file else []
    has_driver = text["driver_compat"].lower() in ("true", "1")
    robots = {
        "simulator": {
            "playground": _quoted(text["playground"]),
            "seed": text["seed"],
            "log": _quoted(text["log"]),
            "real_time_factor": text["real_time_factor"],
            "cmd_vel_timeout": text["cmd_vel_timeout"],
            "robot_names": text["robot_names"],
            "namespaced_tf": text["namespaced_tf"],
            "motor_model": _quoted(text["motor_model"]),
            "proximity_model": _quoted(text["proximity_model"]),
            "lidar.enabled": json.dumps(text["lidar"].lower() in ("true", "1")),
            "out_of_range": _quoted("driver" if has_driver else "rep117"),
            "driver_topics": json.dumps(has_driver),
        },
        "aseba_runtime": {
            "script.path": _quoted(text["program"]),
            "behaviour": _quoted(text["behaviour"]),
            "card": _quoted(text["card"]),
            "settings": _quoted(text["settings"]),
            "layout": _quoted(text["layout"]),
            "events": _quoted(text["events"]),
        },
    }
    rules = [f"{node}:{name}:={given}" for node, values in robots.items() for name, given in values.items()]
    words = [word for rule in rules for word in ("-p", rule)]
    address = ParameterValue(value["address"], value_type=str)
    bridge = {
        "address": address,
        "port": ParameterValue(value["foxglove_port"], value_type=int),
        "require_token": ParameterValue(value["require_token"], value_type=bool),
        "use_sim_time": True,
    }
    page = {
        "address": address,
        "port": ParameterValue(value["port"], value_type=int),
        "foxglove_port": ParameterValue(value["foxglove_port"], value_type=int),
        "use_sim_time": True,
    }
    return [
        _process(
            "thymio",
            value,
            arguments=["--headless"],
            ros_arguments=[*words, *(word for path in shared for word in ("--params-file", path))],
        ),
        _process("foxglove_bridge", value, name="foxglove_bridge", parameters=[bridge, *shared]),
        _process("web_ui", value, name="web_ui", parameters=[page, *shared], condition=IfCondition(value["web"])),
    ]


def _give_tokens(context: LaunchContext) -> list[SetEnvironmentVariable]:
    """Pass the same tokens to bridge and page by the environment: every node of the domain can read parameters."""
    address, is_required = (context.launch_configurations[name] for name in ("address", "require_token"))
    if address in LOOPBACK or is_required.lower() not in ("true", "1"):
        return []
    return [
        SetEnvironmentVariable(name, secrets.token_urlsafe(16)) for name in TOKENS if not context.environment.get(name)
    ]


def _quoted(text: str) -> str:
    """A text that YAML reads as one, whatever it looks like."""
    return json.dumps(text, ensure_ascii=False)


def _process(executable: str, value: dict[str, LaunchConfiguration], **options: object) -> Node:
    """A process of this package. Later parameters override earlier ones."""
    return Node(
        package="thymio_sim_ros",
        executable=executable,
        namespace=value["namespace"],
        output="screen",
        respawn=value["respawn"],
        respawn_delay=RESPAWN_DELAY_S,
        on_exit=_shut_down_if_rejected,
        **options,
    )


def _shut_down_if_rejected(event: ProcessExited, _context: LaunchContext) -> list[Shutdown] | None:
    """Stop the suite if a node rejected its arguments, such as a playground, a program or a port."""
    if event.returncode != REFUSED:
        return None
    return [Shutdown(reason=f"{event.process_name} rejected its arguments")]
