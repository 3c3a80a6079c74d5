"""Bodies, contacts and the obstacles that rays meet; the only package that imports pymunk.

`space` steps all bodies. `robot_body`, `movable_body` and `door_body` wrap one kind of body each; `robot_bodies` moves
all robots by the kernels of `driving`. `door_controller` opens doors, `contact_tracker` records contacts.
"""

from __future__ import annotations

from thymio_sim_ros.sim.physics.contact import Contact
from thymio_sim_ros.sim.physics.door_body import DoorBody
from thymio_sim_ros.sim.physics.movable_body import MovableBody
from thymio_sim_ros.sim.physics.robot_body import RobotBody
from thymio_sim_ros.sim.physics.space import Physics

__all__ = ["Contact", "DoorBody", "MovableBody", "Physics", "RobotBody"]
