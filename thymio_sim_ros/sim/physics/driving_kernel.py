"""Kernels: many robots drive.

They compute what `BatchDriver` and `ActiveBodies` do, operation by operation, so that the bits agree; sines and cosines
are numpy's.

Layout: arrays of the batch have shape (values, robots), so value v of robot r is at `v * robots + r`. Arrays of the
active robots have shape (active, values), so value v of row i is at `values * i + v`.
"""

from __future__ import annotations

from thymio_sim_ros.sim.kernel.compiler import Floats, Ints
from thymio_sim_ros.sim.model import robot_constants
from thymio_sim_ros.sim.physics.contact import SUB_STEP_S, SUB_STEPS
from thymio_sim_ros.sim.physics.robot_body import MOMENT_KG_M2, PUSH_N_S_M

__all__ = ["COUNTS", "KERNELS", "compute_headings", "finish_sub_step", "missing_speeds", "push", "start_tick"]

KERNELS = (
    "compute_headings",
    "move_freely",
    "begin_tick",
    "update_aims",
    "start_tick",
    "missing_speeds",
    "push",
    "read_back",
    "write_held",
    "finish_sub_step",
)

COUNTS = ("robots", "engaged", "earlier", "is_any_touching", "is_any_held")
"""Meaning of each element of `counts`: `earlier` sub-steps of this tick are done; the last two are results, too."""
_ROBOTS, _ACTIVE, _EARLIER, _TOUCHING, _HELD = range(len(COUNTS))

_SUB_STEPS = SUB_STEPS
_SUB_STEP_S = SUB_STEP_S
_HALF_SUB_STEP_S = SUB_STEP_S / 2
_TRACK_M = robot_constants.WHEEL_TRACK_M
_HALF_TRACK_M = robot_constants.WHEEL_TRACK_M / 2
_PUSH_N_S_M = PUSH_N_S_M
_DRIVE_N = robot_constants.DRIVE_FORCE_N
_TURN_N_M_S = MOMENT_KG_M2 / SUB_STEP_S


def compute_headings(
    counts: Ints, driven: Floats, now: Floats, stands: Ints, rolling: Floats, headings: Floats
) -> None:
    """Compute the motion that the wheels give, and the heading in the middle of each sub-step; last row: yaw now."""
    count = counts[_ROBOTS]
    for robot in range(count):
        left = driven[robot]
        right = driven[count + robot]
        speed = (left + right) / 2.0
        spin = (right - left) / _TRACK_M
        if stands[robot] == 0:
            speed = 0.0
            spin = 0.0
        rolling[robot] = speed
        rolling[count + robot] = spin
        half_turn = spin * _HALF_SUB_STEP_S
        turn = spin * _SUB_STEP_S
        rolling[2 * count + robot] = half_turn
        rolling[3 * count + robot] = turn
        yaw = now[2 * count + robot]
        headings[_SUB_STEPS * count + robot] = yaw
        for sub_step in range(_SUB_STEPS):
            headings[sub_step * count + robot] = yaw + half_turn
            yaw = yaw + turn


def move_freely(counts: Ints, driven: Floats, rolling: Floats, cosines: Floats, sines: Floats, now: Floats) -> None:
    """Integrate all robots as if nothing were in their way."""
    count = counts[_ROBOTS]
    for robot in range(count):
        speed = rolling[robot]
        turn = rolling[3 * count + robot]
        x = now[robot]
        y = now[count + robot]
        yaw = now[2 * count + robot]
        for sub_step in range(_SUB_STEPS):
            x = x + cosines[sub_step * count + robot] * speed * _SUB_STEP_S
            y = y + sines[sub_step * count + robot] * speed * _SUB_STEP_S
            yaw = yaw + turn
        now[robot] = x
        now[count + robot] = y
        now[2 * count + robot] = yaw
        now[3 * count + robot] = speed
        now[4 * count + robot] = rolling[count + robot]
        now[5 * count + robot] = driven[robot]
        now[6 * count + robot] = driven[count + robot]


def begin_tick(
    counts: Ints, headings: Floats, is_touching: Ints, numbers: Ints, touching: Ints, held: Ints, yaws: Floats,
    covered: Floats,
) -> None:  # fmt: skip
    """Start a tick of the active robots; those in contact are held (`ActiveBodies`)."""
    count = counts[_ROBOTS]
    counts[_TOUCHING] = 0
    for index in range(counts[_ACTIVE]):
        robot = numbers[index]
        touching[index] = is_touching[robot]
        held[index] = is_touching[robot]
        if is_touching[robot] != 0:
            counts[_TOUCHING] = 1
        yaws[index] = headings[_SUB_STEPS * count + robot]
        covered[2 * index] = 0.0
        covered[2 * index + 1] = 0.0
    counts[_HELD] = counts[_TOUCHING]


def update_aims(
    counts: Ints, rolling: Floats, numbers: Ints, touching: Ints, yaws: Floats, state: Floats, aims: Floats
) -> None:
    """Compute the headings of the active robots in the middle of a sub-step; in contact see `RobotBody.push`."""
    count = counts[_ROBOTS]
    for index in range(counts[_ACTIVE]):
        heading = yaws[index] + rolling[2 * count + numbers[index]]
        if touching[index] != 0:
            heading = heading + state[6 * index + 5] * _SUB_STEP_S
        aims[index] = heading


def start_tick(
    counts: Ints, driven: Floats, rolling: Floats, cosines: Floats, sines: Floats, now: Floats, headings: Floats,
    is_touching: Ints, numbers: Ints, touching: Ints, held: Ints, yaws: Floats, covered: Floats, state: Floats,
    aims: Floats,
) -> None:  # fmt: skip
    """Integrate all robots; start the tick of the active ones."""
    move_freely(counts, driven, rolling, cosines, sines, now)
    begin_tick(counts, headings, is_touching, numbers, touching, held, yaws, covered)
    update_aims(counts, rolling, numbers, touching, yaws, state, aims)


def missing_speeds(
    counts: Ints, rolling: Floats, numbers: Ints, touching: Ints, state: Floats, ways_x: Floats, ways_y: Floats,
    speeds: Floats, pushes_x: Floats, pushes_y: Floats,
) -> None:  # fmt: skip
    """Compute target velocities of the active robots, and the forces of those in contact, not yet limited.

    The binding computes the magnitude of the forces with numpy's hypot, for the bits of the numpy path.
    """
    count = counts[_ROBOTS]
    for index in range(counts[_ACTIVE]):
        speed = rolling[numbers[index]]
        x = speed * ways_x[index]
        y = speed * ways_y[index]
        speeds[3 * index] = x
        speeds[3 * index + 1] = y
        speeds[3 * index + 2] = rolling[count + numbers[index]]
        pushes_x[index] = 0.0
        pushes_y[index] = 0.0
        if touching[index] != 0:
            pushes_x[index] = (x - state[6 * index + 3]) * _PUSH_N_S_M
            pushes_y[index] = (y - state[6 * index + 4]) * _PUSH_N_S_M


def push(
    counts: Ints, touching: Ints, state: Floats, speeds: Floats, pushes_x: Floats, pushes_y: Floats, forces: Floats,
    wanted: Floats,
) -> None:  # fmt: skip
    """Compute velocity, turn rate, force and torque of each active robot, as `BodyWriter` expects them."""
    for index in range(counts[_ACTIVE]):
        share = _DRIVE_N / max(forces[index], _DRIVE_N)
        wanted[6 * index + 3] = pushes_x[index] * share
        wanted[6 * index + 4] = pushes_y[index] * share
        wanted[6 * index + 5] = 0.0
        for part in range(3):
            wanted[6 * index + part] = speeds[3 * index + part]
            if touching[index] != 0:
                wanted[6 * index + part] = state[6 * index + 3 + part]
        if touching[index] != 0:
            wanted[6 * index + 5] = (speeds[3 * index + 2] - state[6 * index + 5]) * _TURN_N_M_S


def read_back(
    counts: Ints, driven: Floats, rolling: Floats, is_touching: Ints, numbers: Ints, rows: Ints, bodies: Floats,
    ways_x: Floats, ways_y: Floats, touching: Ints, held: Ints, yaws: Floats, covered: Floats, state: Floats,
    along: Floats,
) -> None:  # fmt: skip
    """Read back the motion that contacts allowed.

    `bodies` is the state of all bodies in pymunk's space, and `rows` the row in it of each active robot. They are
    read only if a robot is held; otherwise they may be stale.
    """
    count = counts[_ROBOTS]
    counts[_TOUCHING] = 0
    for index in range(counts[_ACTIVE]):
        touching[index] = is_touching[numbers[index]]
        if touching[index] != 0:
            counts[_TOUCHING] = 1
    if counts[_TOUCHING] == 0 and counts[_HELD] == 0:
        for index in range(counts[_ACTIVE]):
            yaws[index] = yaws[index] + rolling[3 * count + numbers[index]]
        return
    counts[_HELD] = 1
    # From here on as in `RobotBody.finish_sub_step`, for all active robots; `write_held` uses only the held ones.
    part = float(counts[_EARLIER]) / _SUB_STEPS
    for index in range(counts[_ACTIVE]):
        if touching[index] != 0 and held[index] == 0:
            held[index] = 1
            covered[2 * index] = driven[numbers[index]] * part
            covered[2 * index + 1] = driven[count + numbers[index]] * part
        for value in range(6):
            state[6 * index + value] = bodies[6 * rows[index] + value]
        yaws[index] = state[6 * index + 2]
        speed = state[6 * index + 3] * ways_x[index] + state[6 * index + 4] * ways_y[index]
        half = state[6 * index + 5] * _HALF_TRACK_M
        along[index] = speed
        covered[2 * index] = covered[2 * index] + (speed - half) / _SUB_STEPS
        covered[2 * index + 1] = covered[2 * index + 1] + (speed + half) / _SUB_STEPS


def write_held(
    counts: Ints, numbers: Ints, held: Ints, state: Floats, along: Floats, covered: Floats, now: Floats
) -> None:
    """Write the state of the held robots to `now`."""
    count = counts[_ROBOTS]
    for index in range(counts[_ACTIVE]):
        if held[index] != 0:
            robot = numbers[index]
            for value in range(3):
                now[value * count + robot] = state[6 * index + value]
            now[3 * count + robot] = along[index]
            now[4 * count + robot] = state[6 * index + 5]
            now[5 * count + robot] = covered[2 * index]
            now[6 * count + robot] = covered[2 * index + 1]


def finish_sub_step(
    counts: Ints, driven: Floats, rolling: Floats, is_touching: Ints, numbers: Ints, rows: Ints, bodies: Floats,
    ways_x: Floats, ways_y: Floats, touching: Ints, held: Ints, yaws: Floats, covered: Floats, state: Floats,
    along: Floats, now: Floats, aims: Floats,
) -> None:  # fmt: skip
    """After a sub-step: read back the motion, and compute the headings for the next one."""
    read_back(
        counts, driven, rolling, is_touching, numbers, rows, bodies, ways_x, ways_y, touching, held, yaws, covered,
        state, along,
    )  # fmt: skip
    if counts[_HELD] != 0:
        write_held(counts, numbers, held, state, along, covered, now)
    update_aims(counts, rolling, numbers, touching, yaws, state, aims)
