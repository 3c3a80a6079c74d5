"""The whole suite as separate nodes: simulator, Aseba runtime, Foxglove bridge and web page.

ros2 launch thymio_sim_ros thymio.launch.py playground:=line program:=line_follower
"""

from __future__ import annotations

from launch import LaunchDescription
from launch.actions import DeclareLaunchArgument
from launch.conditions import IfCondition
from launch.substitutions import LaunchConfiguration, PythonExpression
from launch_ros.actions import Node
from launch_ros.parameter_descriptions import ParameterValue

ARGUMENTS = {
    "playground": ("line", "playground: a shipped name or a file"),
    "program": ("line_follower", "Aseba program: a built-in behaviour, an .aesl file, or none"),
    "behaviour": ("", "what the robot is switched on with, such as menu; '' is the program"),
    "card": ("", "folder that stands for the robot's memory card; '' is no card"),
    "settings": ("", "folder that keeps the robot's settings; '' forgets them"),
    "layout": ("thymio", "order of variables and natives: thymio or playground"),
    "events": ("firmware", "how events meet: firmware or playground"),
    "motor_model": ("ideal", "how motors follow: ideal or firmware"),
    "seed": ("0", "seed of all noise"),
    "log": ("", "file of a run log for thymio-sim replay; '' is none"),
    "real_time_factor": ("1.0", "simulated seconds per second; 0: as fast as possible"),
    "cmd_vel_timeout": ("0.0", "seconds after which a velocity command ends; 0: never"),
    "driver_compat": ("false", "report ranges as the existing Thymio driver does (-1 for nothing)"),
    "port": ("8080", "TCP port of the page"),
    "foxglove_port": ("8765", "TCP port of the Foxglove bridge"),
    "web": ("true", "serve the page"),
}


def generate_launch_description() -> LaunchDescription:
    """Four nodes on one clock; all but the simulator follow simulated time."""
    value = {name: LaunchConfiguration(name) for name in ARGUMENTS}
    range_convention = PythonExpression(
        ["'driver' if '", value["driver_compat"], "'.lower() in ('true', '1') else 'rep117'"]
    )
    simulator = {
        "playground": ParameterValue(value["playground"], value_type=str),
        "seed": ParameterValue(value["seed"], value_type=int),
        "log": ParameterValue(value["log"], value_type=str),
        "real_time_factor": ParameterValue(value["real_time_factor"], value_type=float),
        "cmd_vel_timeout": ParameterValue(value["cmd_vel_timeout"], value_type=float),
        "motor_model": ParameterValue(value["motor_model"], value_type=str),
        "out_of_range": ParameterValue(range_convention, value_type=str),
    }
    runtime = {
        "script.path": ParameterValue(value["program"], value_type=str),
        "behaviour": ParameterValue(value["behaviour"], value_type=str),
        "card": ParameterValue(value["card"], value_type=str),
        "settings": ParameterValue(value["settings"], value_type=str),
        "layout": ParameterValue(value["layout"], value_type=str),
        "events": ParameterValue(value["events"], value_type=str),
        "use_sim_time": True,
    }
    bridge = {"port": ParameterValue(value["foxglove_port"], value_type=int), "use_sim_time": True}
    page = {
        "port": ParameterValue(value["port"], value_type=int),
        "foxglove_port": ParameterValue(value["foxglove_port"], value_type=int),
        "use_sim_time": True,
    }
    return LaunchDescription(
        [
            *(
                DeclareLaunchArgument(name, default_value=default, description=text)
                for name, (default, text) in ARGUMENTS.items()
            ),
            _node("simulator", simulator),
            _node("aseba_runtime", runtime),
            _node("foxglove_bridge", bridge),
            _node("web_ui", page, condition=IfCondition(value["web"])),
        ]
    )


def _node(name: str, parameters: dict[str, object], **options: object) -> Node:
    """One of our executables; its node has the same name."""
    return Node(
        package="thymio_sim_ros", executable=name, name=name, parameters=[parameters], output="screen", **options
    )
