"""Order in which help and completion list the names of the Thymio: what beginners need most comes first.

Completion lists the names of a kind, help those of a topic, such as the lights. The layout has an order of its own
(`layout.py`), which bytecode depends on; this one is for people only. Names that are not listed, such as those of
plug-ins, follow in the order of the layout; names for experts come last.
"""

from __future__ import annotations

from collections.abc import Mapping

__all__ = ["ORDER", "OTHERS", "TOPICS", "rank", "topic_of"]

_VARIABLES = """
    motor.left.target motor.right.target prox.horizontal prox.ground.delta
    button.center button.forward button.backward button.left button.right
    timer.period leds.top leds.bottom.left leds.bottom.right leds.circle
    acc mic.intensity mic.threshold temperature rc5.command rc5.address
    motor.left.speed motor.right.speed prox.ground.reflected prox.ground.ambiant prox.comm.rx prox.comm.tx
    event.args event.source sd.present motor.left.pwm motor.right.pwm
"""
_EVENTS = """
    button.center button.forward button.backward button.left button.right prox timer0 timer1 tap mic acc temperature
    rc5 prox.comm sound.finished motor buttons
"""
_NATIVES = """
    leds.top leds.bottom.left leds.bottom.right leds.circle leds.buttons leds.prox.h leds.prox.v leds.rc leds.sound
    leds.temperature
    sound.freq sound.system sound.play sound.record sound.replay sound.duration sound.wave
    prox.comm.enable
    math.rand math.min math.max math.clamp math.add math.sub math.mul math.div math.muldiv math.addscalar math.copy
    math.fill math.sort math.stat math.argbounds math.dot math.sqrt math.sin math.cos math.atan2 math.rot2
    deque.size deque.get deque.set deque.push_back deque.push_front deque.pop_back deque.pop_front deque.insert
    deque.erase
    sd.open sd.read sd.write sd.seek
"""

ORDER: Mapping[str, tuple[str, ...]] = {
    "variables": tuple(_VARIABLES.split()),
    "events": tuple(_EVENTS.split()),
    "natives": tuple(_NATIVES.split()),
}
"""Kind of name → names, the most useful first."""

OTHERS = "others"
"""The topic of a name that belongs to none of `TOPICS`."""
TOPICS: Mapping[str, tuple[str, ...]] = {
    "motors": ("motor",),
    "lights": ("leds",),
    "sound": ("sound", "mic"),
    "sensors": ("prox", "button", "buttons", "acc", "tap", "temperature", "rc5"),
    "time": ("timer", "timer0", "timer1"),
    "messages": ("event", "prox.comm"),
    "arithmetic": ("math",),
    "lists": ("deque",),
    "card": ("sd",),
}
"""Topic of the help → how its names begin, up to a dot or their end; of two that fit, the longer one counts."""

_TOPIC_OF = {start: topic for topic, starts in TOPICS.items() for start in starts}
_PLACES = {kind: {name: place for place, name in enumerate(names)} for kind, names in ORDER.items()}


def rank(kind: str, name: str, *, hidden: bool) -> int:
    """Key for a stable sort of the names of one `kind` (variables, events, natives) by usefulness."""
    places = _PLACES[kind]
    return len(places) + 1 if hidden else places.get(name, len(places))


def topic_of(name: str) -> str:
    """Topic of the help in which a name is listed: one of `TOPICS`, or `OTHERS`."""
    start = name
    while start not in _TOPIC_OF and start:
        start = start.rpartition(".")[0]
    return _TOPIC_OF.get(start, OTHERS)
