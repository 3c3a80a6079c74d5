"""Predefined target descriptions: the Thymio II (firmware 14)."""

from __future__ import annotations

from aseba_vm.languages import texts
from aseba_vm.target import LocalEvent, NativeFunction, Parameter, TargetDescription, Variable

# Name and size in words of each variable, in order of address.
_VARIABLES = """
    _id event.source event.args:32 _fwversion:2 _productId buttons._raw:5 button.backward button.left button.center
    button.forward button.right buttons._mean:5 buttons._noise:5 prox.horizontal:7 prox.comm.rx._payloads:7
    prox.comm.rx._intensities:7 prox.comm.rx prox.comm.tx prox.ground.ambiant:2 prox.ground.reflected:2
    prox.ground.delta:2 motor.left.target motor.right.target _vbat:2 _imot:2 motor.left.speed motor.right.speed
    motor.left.pwm motor.right.pwm _integrator:2 acc:3 leds.top:3 leds.bottom.left:3 leds.bottom.right:3 leds.circle:8
    temperature rc5.address rc5.command mic.intensity mic.threshold mic._mean timer.period:2 acc._tap sd.present
"""

_LOCAL_EVENTS = """
    button.backward button.left button.center button.forward button.right buttons prox prox.comm tap acc mic
    sound.finished temperature rc5 motor timer0 timer1
"""

# One function per line; the size of a parameter after a colon, 1 if absent (see Parameter).
_NATIVES = """
    _system.reboot
    _system.settings.read address value
    _system.settings.write address value
    _system.settings.flash
    math.copy dest:-1 src:-1
    math.fill dest:-1 value
    math.addscalar dest:-1 src:-1 scalar
    math.add dest:-1 src1:-1 src2:-1
    math.sub dest:-1 src1:-1 src2:-1
    math.mul dest:-1 src1:-1 src2:-1
    math.div dest:-1 src1:-1 src2:-1
    math.min dest:-1 src1:-1 src2:-1
    math.max dest:-1 src1:-1 src2:-1
    math.clamp dest:-1 src:-1 low:-1 high:-1
    math.dot dest src1:-1 src2:-1 shift
    math.stat src:-1 min max mean
    math.argbounds src:-1 argmin argmax
    math.sort array:-1
    math.muldiv dest:-1 a:-1 b:-1 c:-1
    math.atan2 dest:-1 y:-1 x:-1
    math.sin dest:-1 x:-1
    math.cos dest:-1 x:-1
    math.rot2 dest:2 v:2 a
    math.sqrt dest:-1 x:-1
    math.rand dest:-1
    deque.size deque:-1 size
    deque.get deque:-1 dest:-2 index
    deque.set deque:-1 src:-2 index
    deque.insert deque:-1 src:-2 index
    deque.erase deque:-1 index len
    deque.push_front deque:-1 src:-2
    deque.push_back deque:-1 src:-2
    deque.pop_front deque:-1 dest:-2
    deque.pop_back deque:-1 dest:-2
    _leds.set led brightness
    sound.record N
    sound.play N
    sound.replay N
    sound.system N
    leds.circle l0 l1 l2 l3 l4 l5 l6 l7
    leds.top red green blue
    leds.bottom.left red green blue
    leds.bottom.right red green blue
    sound.freq Hz 1/60s
    leds.buttons l0 l1 l2 l3
    leds.prox.h l0 l1 l2 l3 l4 l5 l6 l7
    leds.prox.v l0 l1
    leds.rc led
    leds.sound led
    leds.temperature red blue
    sound.wave wave:142
    prox.comm.enable state
    sd.open number status
    sd.write data:-1 written
    sd.read data:-1 read
    sd.seek position status
    _rf.nodeid nodeID
    _rf.setup channel networkID
    sound.duration N duration
    _poweroff
"""


def _sized(word: str) -> tuple[str, int]:
    name, _, size = word.partition(":")
    return name, int(size or 1)


def _native(line: str) -> NativeFunction:
    name, *parameters = line.split()
    return NativeFunction(name, tuple(Parameter(*_sized(word)) for word in parameters))


#: The Thymio II as robots with firmware 14 describe themselves.
THYMIO_II = TargetDescription(
    name="thymio-II",
    variables_size=640,
    bytecode_size=1534,
    stack_size=32,
    variables=tuple(Variable(*_sized(word)) for word in _VARIABLES.split()),
    local_events=tuple(LocalEvent(name, texts("help")[f"events.{name}"]) for name in _LOCAL_EVENTS.split()),
    natives=tuple(_native(line) for line in _NATIVES.strip().splitlines()),
)
