"""Bodies, contacts and the obstacles that rays meet; the only package that imports pymunk.

`space` steps all bodies. `robot_body`, `movable_body` and `door_body` wrap one kind of body each. Robots are moved one
by one (`scalar_driver`) or as a batch (`batch_driver`). `door_controller` opens doors, `contact_tracker` records
contacts, `time_to_contact` and `broadphase_batch` find robots that can reach nothing for some ticks: these are
integrated outside pymunk.
"""

from __future__ import annotations

from thymio_sim_ros.sim.physics.batch_driver import BatchDriver
from thymio_sim_ros.sim.physics.contact import Contact
from thymio_sim_ros.sim.physics.door_body import DoorBody
from thymio_sim_ros.sim.physics.movable_body import MovableBody
from thymio_sim_ros.sim.physics.robot_body import RobotBody
from thymio_sim_ros.sim.physics.space import Physics

__all__ = ["BatchDriver", "Contact", "DoorBody", "MovableBody", "Physics", "RobotBody"]
