"""The prose of docs/ros.md between its generated tables."""

from __future__ import annotations

__all__ = ["AFTER", "ALL_IN_ONE", "BEFORE", "DRIVER", "HIDDEN", "INTERFACES", "QUALITY", "RVIZ"]

BEFORE = """\
# The ROS 2 interface

This page is generated from the declarations that the nodes use: `python -m thymio_sim_ros.ros.generate_ros_docs >
docs/ros.md`.

All message types are standard types. Units are SI; frames follow REP 103 and REP 105, ranges REP 117. Names of a
robot's topics and services are relative to its namespace. A single robot has none (`/odom`, frame `base_link`); with
several robots, each uses its name (`/anna/odom`, frame `anna/base_link`). One node, `/simulator`, serves all robots.
All names can be moved into a common [namespace](#namespaces).

A topic without subscribers costs nothing, except for topics that are published on change. While no periodic topic has a
subscriber, changes may be published up to 0.1 s late; their stamps, if any, are correct.

Messages with non-finite numbers or arrays of the wrong size are rejected with a warning, at most one every five seconds
per topic, and counted in `/diagnostics`. Speeds, colors, intensities and loudness beyond the limits of the robot are
clamped, with one warning per topic, and counted as well.

## Existing code for the Thymio driver

Names, types, frames and constants are those of `thymio_driver`: a node written for it runs unchanged.
With `ros2 launch` a velocity holds until the next one, as with the driver. `thymio-sim` ends it after 0.5 s, because a
teleoperation panel in a browser sends nothing when a key is released; `ros2 param set /simulator cmd_vel_timeout 0.0`
disables the time-out there.

```sh
ros2 launch thymio_sim_ros thymio.launch.py driver_compat:=true program:=none
```

`driver_compat` sets two parameters of the simulator:

- `out_of_range` to `driver` (`thymio-sim --out-of-range driver`): a range without an obstacle is -1, as in the driver,
  instead of +inf. Code that adds or averages ranges needs this setting; code that compares them (`r < 0.08`) needs the
  default;
- `driver_topics` to true: less common driver topics, which have [hidden names](#hidden-topics) here, are also available
  under the names of the driver. So are the topics with types of the driver's package `thymio_msgs`, [if it is
  installed](#topics-with-types-of-thymio_msgs). All other driver topics are always available.

Not supported:

- the parameters that calibrate the motors of a real robot (`axis_length`, `motor.…`);
- the interfaces of `asebaros` with types of `asebaros_msgs`. Its `aseba/events/<event>` carries both directions,
  distinguished by a field that no standard type has. Here, robots publish on `aseba/events/<event>` and receive on
  `aseba/emit/<event>`. The counterparts of its services are `script.path`, `script.source`, `aseba/get_variables`,
  `aseba/set_variables`, `aseba/list_variables`, and the retained topics `_aseba/target` and `_aseba/status`.

## Namespaces

All names of the suite are relative. In the namespace `/lab1` (`-r __ns:=/lab1`, `PushRosNamespace`, or `namespace`
of the launch file) there are `/lab1/cmd_vel`, `/lab1/anna/odom` with several robots, `/lab1/simulator/pause` and
`/lab1/aseba_runtime`. Simulator, runtime, bridge and page find each other within one namespace; the page also finds a
simulator below the namespace of its bridge.

```sh
ros2 run thymio_sim_ros thymio --ros-args -r __ns:=/lab1 -p port:=8081 -p foxglove_port:=8766
ros2 run thymio_sim_ros simulator --ros-args -r __ns:=/robot1
thymio-sim --port 8081 --foxglove-port 8766 --ros-args -r __ns:=/lab1
ros2 topic pub /lab1/cmd_vel geometry_msgs/msg/Twist "{linear: {x: 0.1}}"
thymio-sim foxglove-layout --namespace lab1 -o lab1.json
```

Two suites in two namespaces of one domain share only the global names of ROS:

- `/clock`: only one simulator may publish it. Start all nodes of the second suite, including those of students, with
  `-r /clock:=/lab2/clock`.
- `/tf` and `/tf_static`: frames do not follow the namespace, so frames of the same name would conflict. With
  `namespaced_tf:=true` they are published on `tf` and `tf_static` in the namespace of the robot. Alternatively, rename
  them with `tf_prefix:=lab2` and `map_frame:=lab2/map`.
- `/diagnostics`, `/rosout` and `/parameter_events` are meant to be shared: entries name their node
  (`lab1/simulator: pace`).

Aseba programs in different namespaces do not exchange events unless both runtimes have the remapping
`-r _aseba/network:=/_aseba/network`.

## Control of time and world

```sh
ros2 service call /simulator/pause std_srvs/srv/SetBool "{data: true}"
ros2 param set /simulator step_ticks 100
ros2 service call /simulator/step std_srvs/srv/Trigger
ros2 service call /simulator/reset std_srvs/srv/Trigger
ros2 param set /simulator real_time_factor 5.0
ros2 param set /simulator seed 7
ros2 param set /simulator playground maze
```

A playground is a shipped name, a file or the JSON text itself. An invalid one is rejected with file, key, found and
expected value, and the current world continues. A new seed or playground restarts at time 0, like `reset`: `/clock`
jumps back, and nodes discard their history. The present value has no effect, unless the playground is a file that has
changed, and the answer says so; `reset` restarts the world. The same holds for the programs of `/aseba_runtime`: the
output of `ros2 param dump` can be loaded into running nodes.

Robots are added, removed and moved by services that return a result with a reason for each name:

```sh
ros2 service call /simulator/spawn rcl_interfaces/srv/SetParameters \\
    "{parameters: [{name: anna, value: {type: 8, double_array_value: [0.2, 0.1, 1.57]}}]}"
ros2 service call /simulator/set_poses rcl_interfaces/srv/SetParameters \\
    "{parameters: [{name: anna, value: {type: 8, double_array_value: [0.0, 0.0, 0.0]}}]}"
ros2 service call /simulator/get_poses rcl_interfaces/srv/GetParameters "{names: [anna]}"
ros2 service call /simulator/remove rcl_interfaces/srv/SetParameters "{parameters: [{name: anna}]}"
```

Names are those of the playground (`robot` in `/simulator/_state`), including names of objects. A viewer that
drags publishes on `/simulator/_place`, with the name, or a robot's frame, in `child_frame_id`; or on a robot's
`initialpose`, like the tools of RViz and Foxglove. All of this works through the Foxglove bridge too. While the
simulation is paused, a new pose takes effect with the next step.
"""

DRIVER = """\
## Topics with types of `thymio_msgs`

These topics of a robot require the parameter `driver_topics` and the driver's package. Their counterparts with standard
types are always available: `_comm/received` with `_raw/comm`, `led/circle` and `_led/…`, `_led/gesture/…`,
`sound/tone` and `_sound/system`.
"""

HIDDEN = """\
## Hidden topics

`ros2 topic list` shows what a first node needs: wheels and odometry, distance, ground, acceleration, buttons, the
lights of the body and the circle, a tone, the pen, the events of the program, and the names that ROS tools
expect (`/tf`, `/clock`, `/diagnostics`, `joint_states`, `robot_description`, `initialpose`). With one robot these
are at most 40 topics.

All other topics have hidden names: a word of the name begins with `_`. Hidden are

- topics that only a simulation has: `_ground_truth/odom`, `_collision`, the operator's stimuli (`_press/…`), the output
  of lights, loudspeaker and pen (`_led/state`, `_sound/state`, `_pen/trail`), the playground (`_markers`);
- other representations of visible topics: Aseba's integers (`_raw/…`, `_motor/target`), `_wheels/command`,
  `_proximity/laser`, `_proximity/rays`, `_buttons`;
- topics that few programs need: the other lights, gestures, sounds, microphone, remote control, taps, infrared
  communication, temperature, battery;
- internal topics between our nodes, the page and editors: `_aseba/…`, `/simulator/_state` and the like.

They work like all other topics. Use their full names (`ros2 topic echo /_raw/ground`), and list them with
`ros2 topic list --include-hidden-topics`. Foxglove, Lichtblick and the page show them; `ros2 bag record --all` needs
`--include-hidden-topics`. The topics exist whether or not they have subscribers.
"""

ACTIONS = """\
## Actions

Each robot turns, drives and goes to a pose by actions, with the types of Create 3 (`irobot_create_msgs`). The embedded
graph has these types; an installed ROS 2 needs the package, without which the actions do not exist.

- A robot pursues one goal at a time; a new goal of any of its actions replaces the old one, which is aborted.
- A goal is aborted when an obstacle holds the robot for a second, when it falls or is lifted, when the world is reset,
  and when another command drives its wheels, such as `cmd_vel`. The log of the simulator has the reason, with the name
  of the obstacle.
- A goal with NaN, with a speed that is not above 0, farther than 100 m or 100 turns, in an unknown frame, or for a
  robot that has fallen or is lifted, is rejected; the log has the reason.
- Angles and distances are those of the wheel odometry. The motion is computed in simulated time, tick by tick: the same
  goal at the same time is the same run, and the run log has its velocities. After a goal the targets of a program apply
  again.

```sh
thymio-sim action send_goal --feedback /rotate_angle irobot_create_msgs/action/RotateAngle "{angle: 1.57}"
```
"""

INTERFACES = """\
## Services of `simulation_interfaces`

If that package is installed (`apt install ros-jazzy-simulation-interfaces`; there is no wheel), the simulator also
offers its services, so that tools for other ROS simulators work here. Responses contain a result code and a reason.
Tags, bounds and named poses, which the package also defines, are rejected as unsupported.
"""

RVIZ = """\
## RViz

`ros2 launch thymio_sim_ros thymio.launch.py rviz:=true` also starts RViz with our configuration: robot, playground,
objects, proximity and odometry; displays for frames, rays, the true path, pen and map are there but disabled. The tool
«2D Pose Estimate» moves the robot. For the robot `anna` of several:

```sh
ros2 run rviz2 rviz2 -d $(ros2 pkg prefix --share thymio_sim_ros)/rviz/thymio.rviz \\
    --ros-args -p use_sim_time:=true -r __ns:=/anna
```

RViz comes with a ROS installation, not with the wheels. For the `ros2` commands on these nodes and the environment
setup that they need, see [ros2-tools.md](ros2-tools.md).
"""

QUALITY = """\
All profiles are reliable with history "keep last". `qos_overrides.<topic>.publisher.reliability:=best_effort` makes a
sensor topic best effort, which suits wireless classrooms; `history`, `depth` and `durability` work the same way.
"""

ALL_IN_ONE = """\
## Parameters of the combined process

`ros2 run thymio_sim_ros thymio` runs all nodes in one process. A parameter goes to the nodes that it belongs to; to
select one node, prefix its name (`-p foxglove_bridge:port:=8766`). A parameter that no node has causes a warning, which
suggests the most similar name.

```sh
ros2 run thymio_sim_ros thymio --ros-args -p playground:=maze -p port:=8081 -p foxglove_port:=8766 -p script.path:=none
```

In addition, `use_sim_time` goes to all nodes but the simulator, `qos_overrides.…` to the simulator, and
`script.constants.<NAME>` and `robots.<name>.…` to the runtime. `thymio-sim --ros-args …` accepts the same parameters.
Of a parameter and a `--params-file` that gives it as well, the later one has priority.
`ros2 run thymio_sim_ros thymio --headless` has neither bridge nor page.
"""

AFTER = """\
## From Aseba to ROS

The topics of a program's variables, events and native functions; `_raw/…` carries the integers that the program sees.
For the topics of events between programs and nodes see [aseba_ros.md](aseba_ros.md).
"""
