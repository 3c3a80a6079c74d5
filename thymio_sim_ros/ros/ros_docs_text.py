"""What docs/ros.md says besides its tables."""

from __future__ import annotations

__all__ = ["AFTER", "ALL_IN_ONE", "BEFORE", "DRIVER", "HIDDEN", "INTERFACES", "QUALITY", "RVIZ"]

BEFORE = """\
# The ROS 2 interface

This page is written from the declarations that the nodes use: `python -m thymio_sim_ros.ros.generate_ros_docs >
docs/ros.md`.

Only standard message types. Units are SI, frames follow REP 103 and 105, ranges REP 117. Names of a robot's topics and
services are relative to its namespace: a robot alone has none (`/odom`, frame `base_link`), of several each has its
name (`/anna/odom`, frame `anna/base_link`). One node, `/simulator`, serves all robots; all names move with it into a
[namespace](#namespaces). Topics cost nothing until
somebody subscribes, but for what is sent on a change. While nobody hears what is regular, a change may be told up to
0.1 s late; its stamp is right, if it has one.

Numbers that are not finite and arrays of a wrong size are refused with a warning, at most one every five seconds for
each topic, and counted in `/diagnostics`. Speeds, colors, intensities and loudness beyond the robot are limited, with a
warning once for each topic, and counted there too.

## Existing code for the Thymio driver

Names, types, frames and constants are those of `thymio_driver`: a node written for it runs unchanged.
With `ros2 launch` a velocity holds until the next one, as with the driver; `thymio-sim` ends it after 0.5 s, since a
teleop in a browser says nothing when its key is let go: `ros2 param set /simulator cmd_vel_timeout 0.0` there.

```sh
ros2 launch thymio_sim_ros thymio.launch.py driver_compat:=true program:=none
```

`driver_compat` sets two parameters of the simulator:

- `out_of_range` to `driver`: a range is -1 where nothing is seen, as the driver has it, instead of +inf. Code that
  adds or averages ranges needs this, code that compares them (`r < 0.08`) needs the default;
- `driver_topics` to true: the rarer topics of the driver, which have [hidden names](#hidden-topics) here, are there
  under the driver's names as well, and so are the topics whose types only its package `thymio_msgs` has ([where it
  is installed](#topics-with-types-of-thymio_msgs)). All other topics of the driver are there without it.

Left out are:

- the parameters that calibrate a real robot's motors (`axis_length`, `motor.…`);
- what `asebaros` does with types of `asebaros_msgs`. Its `aseba/events/<event>` carries both directions, told apart by
  a field that no standard type has; here `aseba/events/<event>` is what robots say, `aseba/emit/<event>` what they
  hear. In place of its services: `script.path` and `script.source`, `aseba/get_variables`, `aseba/set_variables`,
  `aseba/list_variables`, and the latched `_aseba/target` and `_aseba/status`.

## Namespaces

All names of the suite are relative. In the namespace `/lab1` (`-r __ns:=/lab1`, `PushRosNamespace`, or `namespace`
of the launch file) there are `/lab1/cmd_vel`, `/lab1/anna/odom` of several robots, `/lab1/simulator/pause` and
`/lab1/aseba_runtime`. Simulator, runtime, bridge and page find each other within one namespace; the page also finds a
simulator below the namespace of its bridge.

```sh
ros2 run thymio_sim_ros thymio --ros-args -r __ns:=/lab1 -p port:=8081 -p foxglove_port:=8766
ros2 run thymio_sim_ros simulator --ros-args -r __ns:=/robot1
thymio-sim --port 8081 --foxglove-port 8766 --ros-args -r __ns:=/lab1
ros2 topic pub /lab1/cmd_vel geometry_msgs/msg/Twist "{linear: {x: 0.1}}"
thymio-sim foxglove-layout --namespace lab1 -o lab1.json
```

Two suites in two namespaces of one domain share what is global in ROS, and nothing else:

- `/clock`: two simulators must not both publish it. Start all nodes of the second suite, those of students too, with
  `-r /clock:=/lab2/clock`.
- `/tf` and `/tf_static`: frames of the same name would be mixed up, and frames do not follow the namespace. With
  `namespaced_tf:=true` they are on `tf` and `tf_static` in the robot's namespace; or give them other names by
  `tf_prefix:=lab2` and `map_frame:=lab2/map`.
- `/diagnostics`, `/rosout` and `/parameter_events` are meant to be shared: entries name their node
  (`lab1/simulator: pace`).

Aseba programs of two namespaces do not hear each other, unless both runtimes have the remapping
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

A playground is a shipped name, a file or the JSON text itself; one that is wrong is refused with file, key, what was
found and what was expected, and the old world goes on. A new seed or playground begins at time 0, as `reset` does:
`/clock` goes back, and nodes drop what they remember.

Robots come, go and are put somewhere by services that answer each name with a reason:

```sh
ros2 service call /simulator/spawn rcl_interfaces/srv/SetParameters \\
    "{parameters: [{name: anna, value: {type: 8, double_array_value: [0.2, 0.1, 1.57]}}]}"
ros2 service call /simulator/set_poses rcl_interfaces/srv/SetParameters \\
    "{parameters: [{name: anna, value: {type: 8, double_array_value: [0.0, 0.0, 0.0]}}]}"
ros2 service call /simulator/get_poses rcl_interfaces/srv/GetParameters "{names: [anna]}"
ros2 service call /simulator/remove rcl_interfaces/srv/SetParameters "{parameters: [{name: anna}]}"
```

Names are those of the playground (`robot` in `/simulator/_state`), also of movable things. A viewer that drags
publishes `/simulator/_place`, with the name, or a robot's frame, in `child_frame_id`; or a robot's `initialpose`,
as the tools of RViz and Foxglove do. All of it works through the Foxglove bridge too. What is moved while time
stands still is there after the next step.
"""

DRIVER = """\
## Topics with types of `thymio_msgs`

Of a robot, with the parameter `driver_topics` where the driver's package is installed; their twins of standard types,
which are there everywhere, are `_comm/received` with `_raw/comm`, `led/circle` and `_led/…`, `_led/gesture/…`,
`sound/tone` and `_sound/system`.
"""

HIDDEN = """\
## Hidden topics

`ros2 topic list` shows what a first node needs: wheels and odometry, distance, ground, acceleration, buttons, the
lights of the body and the circle, a tone, the pen, the events of the program; and the names that the tools of ROS
expect (`/tf`, `/clock`, `/diagnostics`, `joint_states`, `robot_description`, `initialpose`). With one robot these
are at most 40 topics.

All other topics have hidden names: a word of the name begins with `_`. Hidden are

- what only a simulation has: `_ground_truth/odom`, `_collision`, the operator's hand (`_press/…`), what lights,
  loudspeaker and pen show (`_led/state`, `_sound/state`, `_pen/trail`), the playground (`_markers`);
- other forms of what is shown: Aseba's integers (`_raw/…`, `_motor/target`), `_wheels/command`,
  `_proximity/laser`, `_proximity/rays`, `_buttons`;
- what few programs need: the other lights, gestures, sounds, microphone, remote control, taps, infrared
  communication, temperature, battery;
- what our nodes, the page and editors tell each other: `_aseba/…`, `/simulator/_state` and the like.

They work as any other topic: name them in full (`ros2 topic echo /_raw/ground`), and list them with
`ros2 topic list --include-hidden-topics`. Foxglove, Lichtblick and the page see them; `ros2 bag record --all` needs
`--include-hidden-topics`. The topics are always there, whether somebody listens or not.
"""

INTERFACES = """\
## Services of `simulation_interfaces`

Where that package is installed (`apt install ros-jazzy-simulation-interfaces`; no wheel has it), the simulator has
its services, too, so that tools for other simulators of ROS work here. They answer with a code and a reason; tags,
bounds and named poses, which the package knows besides, are refused as unsupported.
"""

RVIZ = """\
## RViz

`ros2 launch thymio_sim_ros thymio.launch.py rviz:=true` also starts RViz with our configuration: robot, playground,
movable things, proximity, odometry; frames, rays, the true path, pen and map wait to be ticked. The tool «2D Pose
Estimate» puts the robot somewhere. For the robot `anna` of several:

```sh
ros2 run rviz2 rviz2 -d $(ros2 pkg prefix --share thymio_sim_ros)/rviz/thymio.rviz \\
    --ros-args -p use_sim_time:=true -r __ns:=/anna
```

RViz comes with a ROS installation, not with the wheels. What the commands of `ros2` answer on these nodes, and which
lines they need where: [ros2-tools.md](ros2-tools.md).
"""

QUALITY = """\
All are reliable and keep the last messages. With `qos_overrides.<topic>.publisher.reliability:=best_effort` a
sensor's topic is best effort, as wireless class rooms want it; `history`, `depth` and `durability` likewise.
"""

ALL_IN_ONE = """\
## Parameters of the combined process

`ros2 run thymio_sim_ros thymio` runs all nodes in one process. A parameter goes to the nodes that it belongs to; to
choose one node, put its name in front (`-p foxglove_bridge:port:=8766`). A parameter that no node has is named in a
warning, with the nearest that there is.

```sh
ros2 run thymio_sim_ros thymio --ros-args -p playground:=maze -p port:=8081 -p foxglove_port:=8766 -p script.path:=none
```

Besides, `use_sim_time` is that of all but the simulator, `qos_overrides.…` of the simulator, and
`script.constants.<NAME>` and `robots.<name>.…` of the runtime. `thymio-sim --ros-args …` takes the same.
"""

AFTER = """\
## From Aseba to ROS

Where a program's variables, events and functions are on topics; `_raw/…` carries the integers that the program sees.
The topics of events between programs and nodes: [aseba_ros.md](aseba_ros.md).
"""
