"""Loads a playground and everything slow that is derived from it, on any thread, before an engine is created."""

from __future__ import annotations

from dataclasses import dataclass

from thymio_sim_ros.engine.engine import Engine
from thymio_sim_ros.files import resources
from thymio_sim_ros.files.loading import load_playground
from thymio_sim_ros.ros.rclpy_ext.node_runner import StartError
from thymio_sim_ros.ros.simulator.parameters import SimulatorParams
from thymio_sim_ros.ros.simulator.world_endpoints import SceneMessages
from thymio_sim_ros.sim.ground.sampling import Ground
from thymio_sim_ros.sim.playground.reader import Playground, PlaygroundError

__all__ = ["LOAD_ERRORS", "PreparedPlayground", "new_engine"]

LOAD_ERRORS = (PlaygroundError, resources.ResourceError, StartError, OSError)
"""Exceptions that `PreparedPlayground.load` raises for a value that the user can correct."""


@dataclass(frozen=True, slots=True)
class PreparedPlayground:
    """A playground with renamed robots, and the slow results derived from it, ready for an engine."""

    name: str
    playground: Playground
    ground: Ground
    scene: SceneMessages

    @classmethod
    def load(cls, value: str, chosen: SimulatorParams) -> PreparedPlayground:
        """Load a playground by name, path or text. Raises one of `LOAD_ERRORS`."""
        name, loaded = load_playground(value)
        return cls.of(name, chosen.renamed(loaded), chosen)

    @classmethod
    def of(cls, name: str, playground: Playground, chosen: SimulatorParams) -> PreparedPlayground:
        """Prepare a playground."""
        scene = SceneMessages.of(playground, chosen.map_frame, with_map=chosen.publish_map)
        return cls(name, playground, Ground(playground.floors, playground.paints), scene)


def new_engine(playground: Playground, chosen: SimulatorParams, ground: Ground | None = None) -> Engine:
    """Return a new engine for a playground; `ground` saves the time to derive it."""
    return Engine(
        playground,
        seed=chosen.seed,
        noise=chosen.noise,
        proximity_model=chosen.proximity_model,
        motor_model=chosen.motor_model,
        periods_ns=chosen.periods_ns,
        lidar=chosen.lidar.lidar,
        solid_robots=chosen.solid_robots,
        ground=ground,
    )
