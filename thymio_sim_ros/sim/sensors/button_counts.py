"""The capacitive buttons as measured by the firmware: count, slow mean and noise of each.

A finger lowers the count; the firmware takes a button for touched while count < mean - max(noise, 130) - 20
(docs/spec/thymio-robot.md section 7.4). Here a button at rest counts what its mean says, a touched one TOUCH less, and
the mean waits while it is touched. Rest counts and noise estimates differ a little from button to button; they are
drawn once, for counts jitter by less than the rule notices. Assumptions: rest 2000 ± 100, noise 10…30, touch 400. The
firmware's wait for a fourth scan is left out, as simulated buttons do not bounce. Reported on change and once per
second.
"""

from __future__ import annotations

from thymio_sim_ros.sim.commands import BUTTONS, PressButton
from thymio_sim_ros.sim.model.readings import ButtonCountsReading
from thymio_sim_ros.sim.plugin_api.aseba_binding import AsebaFace
from thymio_sim_ros.sim.plugin_api.view import SensorView
from thymio_sim_ros.sim.sensors import Sensor
from thymio_sim_ros.sim.stimuli.buttons import ButtonState

__all__ = ["SENSOR", "is_touched"]

_REST = (1900.0, 2100.0)
_NOISE = (10.0, 30.0)
_TOUCH = 400
_LEAST_NOISE, _MARGIN = 130, 20


def is_touched(count: int, mean: int, noise: int) -> bool:
    """Whether a button counts as touched, by the rule of the firmware."""
    return count < mean - max(noise, _LEAST_NOISE) - _MARGIN


def _measure(view: SensorView) -> ButtonCountsReading:
    pressed, memory = view.state(ButtonState).pressed.values(), view.memory
    if "mean" not in memory:
        memory["mean"] = tuple(round(view.noise.uniform(*_REST)) for _ in BUTTONS)
        memory["noise"] = tuple(round(view.noise.uniform(*_NOISE)) for _ in BUTTONS)
    mean, noise = memory["mean"], memory["noise"]
    counts = tuple(rest - _TOUCH if held else rest for rest, held in zip(mean, pressed, strict=True))
    return ButtonCountsReading(view.now_ns, (*counts, *mean, *noise))


SENSOR = Sensor(
    name="button_counts",
    period_ns=1_000_000_000,
    phase_ns=10_000_000,
    measure=_measure,
    wakes_on=(PressButton,),
    aseba=AsebaFace(variables=(("buttons._raw", 5), ("buttons._mean", 5), ("buttons._noise", 5))),
    values=(),
)
