"""Owns the engine: steps, pauses, resets and replaces it, and publishes the results.

Ticks that no subscriber could see are deferred and executed together, at the latest when a message arrives; the command
in it takes effect in the next tick, as if no tick had been deferred.
"""

from __future__ import annotations

import gc
import threading
import time
import traceback
from collections.abc import Callable
from concurrent.futures import Future
from concurrent.futures import wait as wait_for
from dataclasses import replace
from typing import TypeVar

from rclpy.executors import Executor
from rclpy.node import Node

from thymio_sim_ros.engine.engine import Engine
from thymio_sim_ros.engine.replay import LoggedRun
from thymio_sim_ros.ros.interface.headers import SECOND_NS
from thymio_sim_ros.ros.rclpy_ext.connections import Connections
from thymio_sim_ros.ros.rclpy_ext.message_reports import MessageReports
from thymio_sim_ros.ros.rclpy_ext.node_runner import SPIN_SLICE_S, deliver
from thymio_sim_ros.ros.simulator.endpoints import SimulatorEndpoints
from thymio_sim_ros.ros.simulator.parameters import CurrentParams
from thymio_sim_ros.ros.simulator.prepared_playground import PreparedPlayground
from thymio_sim_ros.ros.simulator.recording import Recording
from thymio_sim_ros.ros.simulator.tick_scheduler import TickScheduler
from thymio_sim_ros.ros.simulator.world_endpoints import SceneMessages, WorldState
from thymio_sim_ros.sim.commands import Command, MoveObject, MoveRobot
from thymio_sim_ros.sim.model.clock import TICK_NS
from thymio_sim_ros.sim.model.primitives import Color
from thymio_sim_ros.sim.playground.reader import RobotStart
from thymio_sim_ros.sim.world import World

__all__ = ["WorldRunner"]

T = TypeVar("T")

SLICE_NS = 50_000_000
"""Wall time after which messages have their turn, although ticks are owed: those are dropped."""

MAX_NOTES = 20
"""Number of notes, and of faults of other nodes, in the state; the log has all of them."""


class WorldRunner:
    """Runs one engine at a time. Invariant: only the thread of the node's executor calls it and touches the engine."""

    def __init__(
        self,
        node: Node,
        params: CurrentParams,
        endpoints: SimulatorEndpoints,
        connections: Connections,
        messages: MessageReports,
        recording: Recording,
        prepared: PreparedPlayground,
        engine: Engine,
        logged: LoggedRun | None = None,
    ) -> None:
        """`start` publishes the world; endpoints may use this object only then. `logged`: the run that is shown."""
        self._node, self._params, self._endpoints, self._recording = node, params, endpoints, recording
        self._connections, self._messages = connections, messages
        self.prepared = prepared
        """The playground of the world."""
        self.engine = engine
        self._logged = logged
        self.paused = params.values.start_paused or logged is not None
        self.scheduler = TickScheduler(
            params.values.real_time_factor,
            endpoints.demand,
            endpoints.clock,
            batch_ticks=params.values.batch_ticks,
        )
        self._is_spinning = False
        """Whether a callback was called by `spin`: not within a tick, and there is a thread that runs the node."""
        self._is_waiting = False
        """Whether it was called before the next tick is due, and may execute deferred ticks."""
        self.is_ending = False
        """Whether the node is about to stop: `run_beside` waits no longer."""
        self._published_fallen: frozenset[str] = frozenset()
        self._shown_paint: Color | None = None
        self.before_tick: list[Callable[[], None]] = []
        """Called before each tick, when a reset is possible."""
        self.on_tick: list[Callable[[], None]] = []
        """Called after each tick, when its readings are published."""
        self.on_engine: list[Callable[[], None]] = []
        """Called when there is another engine, which has started."""
        self.on_start: list[Callable[[], None]] = []
        """Called when another world starts, or this one anew."""
        self.on_robots: Callable[[bool], None] = lambda is_new: None
        """Called when robots have come or gone, or for another engine (True)."""
        self.on_reset: Callable[[], None] = lambda: None
        """Called after a reset."""

    @property
    def is_replaying(self) -> bool:
        """Whether the inputs come from a log."""
        return self._logged is not None

    @property
    def world(self) -> World:
        """The world of the engine, to read."""
        return self.engine.world

    def start(self) -> None:
        """Log the notes about the playground, begin its recording and publish its start."""
        for note in self.world.playground.notes:
            self._node.get_logger().warning(f"playground {self.prepared.name}: {note}")
        self._recording.begin(self.prepared.name, self.engine)
        self._publish_start()

    def replace(self, prepared: PreparedPlayground, engine: Engine) -> None:
        """Run another engine from its start; a replay ends."""
        self._logged = None
        self.prepared, self.engine = prepared, engine
        self.start()
        self.on_robots(True)
        for act in self.on_engine:
            act()
        # Parts of the world before refer to each other; the collector, which does not count their megabytes, is late.
        gc.collect()

    def run_due_ticks(self, wall_ns: int) -> None:
        """Execute the ticks that are due at `wall_ns`, unless paused."""
        if not self.paused and not self.scheduler.wait_ns(wall_ns, self.world.now_ns):
            self._run_guarded(self._run_owed)

    def spin(self, executor: Executor) -> None:
        """Handle messages until the next tick is due, or those that have arrived if it is due already."""
        wait_s = self._wait_s()
        self._is_spinning, self._is_waiting = True, wait_s > 0.0
        try:
            if self._is_waiting:
                executor.spin_once(timeout_sec=wait_s)
            else:
                deliver(executor)
        finally:
            self._is_spinning = self._is_waiting = False

    def run_beside(self, slow: Callable[[], T]) -> T:
        """Call a slow function and return its result or raise its exception. The world continues meanwhile; messages
        wait.

        The function runs on another thread, and must not change what the node uses. Raises InterruptedError if the node
        stops meanwhile.
        """
        if not self._is_spinning:
            return slow()
        result: Future[T] = Future()
        # A daemon thread: Ctrl-C does not wait until a playground is loaded.
        threading.Thread(target=_fulfil, args=(result, slow), name="load", daemon=True).start()
        while not wait_for([result], self._wait_s()).done:
            if self.is_ending:
                raise InterruptedError("the simulator ends")
            self.run_due_ticks(time.monotonic_ns())
        return result.result()

    def advance(self, ticks: int) -> None:
        """Step the world by ticks of 10 ms, also while paused, and publish their results."""
        self._endpoints.poll()
        self._advance(ticks)

    def catch_up(self) -> None:
        """Execute the deferred ticks: a request or a command has arrived, which must see the present world."""
        if self._is_waiting and not self.paused:
            self._run_guarded(self._run_owed)
        self.scheduler.require_next_tick(self.world.now_ns)

    def pause(self, paused: bool) -> None:
        """Pause or resume the simulation."""
        self.paused = paused
        self.scheduler.resume()
        self._endpoints.clock.publish(self.world.now_ns, last=True)
        self.publish_state()

    def step(self, ticks: int | None = None) -> bool:
        """Execute `ticks`, by default those of one `~/step`; False if the world stopped with an internal error."""
        is_done = self._run_guarded(lambda: self.advance(self._params.values.step_ticks if ticks is None else ticks))
        self._endpoints.clock.publish(self.world.now_ns, last=True)
        self.publish_state()
        return is_done

    def reset(self) -> None:
        """Reset world, time and noise to the start."""
        self.engine.reset()
        self._recording.keep(self.prepared.name, self.engine)
        self._publish_start()
        self.on_robots(False)
        self.on_reset()

    def run_log(self) -> bytes | None:
        """Return the log of the run since its start or last reset, compressed; None if it became too large."""
        return self._recording.run()

    def spawn(self, start: RobotStart) -> None:
        """Add a robot on a ground.

        Raises ValueError as `World.spawn` does, and for a name that topics of another robot use; PlacementError also
        for a position outside of every ground.
        """
        self._endpoints.robots.check_name(start.name)
        self.world.check_ground(start.name, start.x_m, start.y_m)
        self.engine.spawn(start)

    def post(self, robot: str, command: Command) -> None:
        """Post a command to a robot; one that moves it, only to a position on a ground. Raises as `move` does."""
        if isinstance(command, MoveRobot):
            self.move(robot, command.x_m, command.y_m, command.yaw_rad)
        else:
            self.engine.post(robot, command)

    def move(self, name: str, x_m: float, y_m: float, yaw_rad: float) -> None:
        """Move a robot or object to a position on a ground; a lifted robot to any position.

        Raises KeyError for an unknown name, and ValueError as `World.post` does; PlacementError also for a position
        outside of every ground.
        """
        robot = self.world.robots.get(name)
        if robot is None or not robot.is_lifted:
            self.world.check_ground(name, x_m, y_m)
        command = MoveObject if robot is None else MoveRobot
        self.engine.post(name, command(x_m, y_m, yaw_rad))

    def paint_ground(self, color: Color) -> None:
        """Give the first floor another color until the next reset, and show it. Raises ValueError without a floor."""
        self.engine.paint_ground(color)
        self._show_paint()

    def update_robots(self) -> None:
        """Create or destroy topics and frames if robots were added or removed."""
        if self._endpoints.update_robots(self.world.robots):
            self.publish_state()
            self.on_robots(False)

    def state(self) -> WorldState:
        """Return the state for `~/_state` and the diagnostics."""
        return WorldState(
            playground=self.prepared.name,
            title=self.world.playground.title,
            notes=self.world.playground.notes[:MAX_NOTES],
            paused=self.paused,
            real_time_factor=self._params.values.real_time_factor,
            achieved=0.0 if self.paused else self.scheduler.achieved,
            seed=self._params.values.seed,
            now_ns=self.world.now_ns,
            movables=self.world.movables,
            robots=self._endpoints.robots.names,
            fallen=self._fallen(),
            faults=(*self._messages.faults, *map(str, self._connections.unconnected))[:MAX_NOTES],
        )

    def publish_state(self) -> None:
        """Publish `~/_state`."""
        state = self.state()
        self._published_fallen = state.fallen
        self._endpoints.world.publish_state(state)

    def _advance(self, ticks: int, until_ns: int | None = None) -> None:
        """Execute ticks; those that do not begin before `until_ns` of wall time are dropped."""
        endpoints = self._endpoints
        self.update_robots()
        for done in range(ticks):
            if until_ns is not None and done and time.monotonic_ns() >= until_ns:
                self.scheduler.drop(ticks - done)
                break
            if self._logged is not None:
                self._logged.repeat_inputs(self.engine)
                self.update_robots()  # those of the log come and go between these ticks
                self._show_paint()
            for act in self.before_tick:
                act()
            result = self.engine.step(endpoints.demand.sensors)
            endpoints.publish_readings(self.world, result)
            for act in self.on_tick:
                act()
            if self.paused:
                endpoints.clock.publish(result.now_ns, last=True)
        if not self.paused:
            endpoints.clock.publish(self.world.now_ns, last=False)
        endpoints.world.publish_objects(self.world, last=self.paused)
        if self._fallen() != self._published_fallen:
            self.publish_state()
        if self._logged is not None and not self.paused and self.world.now_ns >= self._logged.ticks * TICK_NS:
            self.pause(True)

    def _show_paint(self) -> None:
        """Publish the scene again if its first floor has another color than it had."""
        if self.world.painted is self._shown_paint:
            return
        self._shown_paint = color = self.world.painted
        playground = self.world.playground
        if color is not None:
            first, *others = playground.floors
            playground = replace(playground, floors=(replace(first, color=color), *others))
        values = self._params.values
        scene = SceneMessages.of(playground, values.map_frame, with_map=values.publish_map)
        self._endpoints.world.publish_scene(scene)

    def _fallen(self) -> frozenset[str]:
        """Return the names (in the world) of the robots that fell off an edge."""
        return frozenset(name for name, robot in self.world.robots.items() if robot.is_fallen)

    def _wait_s(self) -> float:
        """Time until the next tick is due, in s, at most `SPIN_SLICE_S`."""
        if self.paused:
            return SPIN_SLICE_S
        return min(self.scheduler.wait_ns(time.monotonic_ns(), self.world.now_ns) / SECOND_NS, SPIN_SLICE_S)

    def _run_owed(self) -> None:
        wall_ns = time.monotonic_ns()
        ticks = self.scheduler.pop_owed(wall_ns, self.world.now_ns)
        if ticks:
            self._advance(ticks, wall_ns + SLICE_NS)

    def _run_guarded(self, act: Callable[[], None]) -> bool:
        """Call `act`; on an internal error log it, pause and return False (docs/architecture.md, "Errors")."""
        try:
            act()
        except Exception:
            where = f"the world stopped at {self.world.now_ns} ns"
            self._node.get_logger().error(f"internal error (please report): {where}:\n{traceback.format_exc()}")
            self.paused = True
            self.publish_state()
            return False
        return True

    def _publish_start(self) -> None:
        """Publish the start of a run in order: retained topics, then the clock at zero; the first readings follow."""
        self.scheduler.reset()
        self._endpoints.reset_robots(self.world.robots)
        self._shown_paint = None
        self._endpoints.world.publish_scene(self.prepared.scene)
        self._endpoints.world.publish_objects(self.world, last=True)
        self.publish_state()
        self._endpoints.clock.publish(0, last=True)
        for act in self.on_start:
            act()


def _fulfil(result: Future[T], function: Callable[[], T]) -> None:
    try:
        result.set_result(function())
    except BaseException as error:
        result.set_exception(error)
