"""Bodies, contacts and what rays meet: the only package that knows pymunk.

`space` steps all bodies; `robots`, `movables` and `doors` hold one kind of body each, `fleet` many robots at once;
`gates` opens doors, `touches` knows who touches what, `quiet` for how long nothing can happen.
"""

from __future__ import annotations

from thymio_sim_ros.sim.physics.batch_driver import Fleet
from thymio_sim_ros.sim.physics.contact import Contact
from thymio_sim_ros.sim.physics.door_body import DoorBody
from thymio_sim_ros.sim.physics.movable_body import MovableBody
from thymio_sim_ros.sim.physics.robot_body import RobotBody
from thymio_sim_ros.sim.physics.space import Physics

__all__ = ["Contact", "DoorBody", "Fleet", "MovableBody", "Physics", "RobotBody"]
