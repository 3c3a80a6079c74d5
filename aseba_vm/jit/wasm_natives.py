"""Standard natives in WebAssembly (docs/spec/aseba-bytecode-vm.md section 12), for constant arguments.

Words are read and stored in the order of :mod:`aseba_vm.machine.natives`, so overlapping arguments behave the same.
Calls on few words are unrolled in place. All others are functions, which a module includes only if it calls them. Their
parameters are the byte addresses of the arguments, then the sizes in bytes; they return 0 or the number of a fault.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence

from aseba_vm.jit import wasm_deque
from aseba_vm.jit.wasm_host import RANDOM, TABLES
from aseba_vm.machine.fixed_point_trigonometry import ARCTANGENT, RIGHT_ANGLE, SINE
from aseba_vm.machine.native_call import DequeFault, DivisionFault, NativeFault, Signature
from aseba_vm.machine.natives import RANDOM_FACTOR, RANDOM_STEP, SQUARE_ROOT_FAULT
from aseba_vm.targets import THYMIO_II

FAULTS: tuple[Callable[[], tuple[NativeFault, ...]], ...] = (
    lambda: (DivisionFault(),),
    lambda: (NativeFault(SQUARE_ROOT_FAULT),),
    lambda: (DequeFault(),),
    lambda: (DequeFault(), DequeFault()),
)
"""Faults by number, from 1."""

_MAX_UNROLLED = 16
_ARCTANGENTS = TABLES + 2 * len(SINE)

Argument = tuple[int, int]
"""Address and size in words."""


def unrolled(name: str, arguments: Sequence[Argument]) -> list[str] | None:
    """Return the code of a call on few words, None if it is not unrolled."""
    addresses = [address for address, _ in arguments]
    size = arguments[0][1] if arguments else 0
    if size > _MAX_UNROLLED:
        return None
    if name in _ELEMENTWISE:
        function, _ = _ELEMENTWISE[name]
        target, *sources = addresses
        return [_store(target + n, function(*(_load(source + n) for source in sources))) for n in range(size)]
    if name == "math.fill":
        head = f"(local.set $h {_load(addresses[1])})"
        return [head, *(_store(addresses[0] + n, "(local.get $h)") for n in range(size))]
    if name == "math.addscalar":
        head = f"(local.set $h {_load(addresses[2])})"
        return [
            head,
            *(_store(addresses[0] + n, f"(i32.add {_load(addresses[1] + n)} (local.get $h))") for n in range(size)),
        ]
    if name == "math.dot" and arguments[1][1] <= _MAX_UNROLLED:
        total = "(i32.const 0)"
        for n in range(arguments[1][1]):
            total = f"(i32.add {total} (i32.mul {_load(addresses[1] + n)} {_load(addresses[2] + n)}))"
        shift = _load(addresses[3])
        shifted = f"(i32.shr_s {total} {shift})"
        return [_store(addresses[0], f"(select (i32.const 0) {shifted} (i32.gt_s {shift} (i32.const 32)))")]
    return None


def call(signature: Signature, arguments: Sequence[Argument]) -> str | None:
    """Return the expression that calls the function of a native (0 on success), None if there is no such function."""
    name = signature.native.name
    if name not in _FUNCTIONS or _shape(signature) != _SHAPES[name]:
        return None
    words = [2 * address for address, _ in arguments]
    words += [2 * arguments[index][1] for index in signature.native.free_sizes]
    return f"(call ${name} {' '.join(f'(i32.const {word})' for word in words)})"


def functions(names: Iterable[str], memory_words: int) -> str:
    """Return the functions of natives and their dependencies, each once, for a memory of ``memory_words`` words."""
    needed: list[str] = []
    waiting = sorted(names)
    while waiting:
        name = waiting.pop(0)
        if name not in needed:
            needed.append(name)
            waiting += _NEEDS.get(name, ())
    own = {"deque_move": wasm_deque.move(memory_words)}
    return "\n".join(own.get(name) or _FUNCTIONS[name] for name in needed)


def has_standard_parameters(signature: Signature) -> bool:
    """Return whether a native is declared with the parameters that the code here expects."""
    return _shape(signature) == _SHAPES.get(signature.native.name)


def _shape(signature: Signature) -> tuple[int, ...]:
    return tuple(parameter.size for parameter in signature.native.parameters)


def _load(address: int) -> str:
    return f"(i32.load16_s offset={2 * address} (i32.const 0))"


def _store(address: int, value: str) -> str:
    return f"(i32.store16 offset={2 * address} (i32.const 0) {value})"


def _binary_operation(name: str) -> Callable[..., str]:
    return lambda *values: f"(i32.{name} {' '.join(values)})"


def _minimum(one: str, two: str) -> str:
    return f"(select {one} {two} (i32.lt_s {one} {two}))"


def _maximum(one: str, two: str) -> str:
    return f"(select {one} {two} (i32.gt_s {one} {two}))"


def _clamped(value: str, low: str, high: str) -> str:
    return f"(select {high} (select {low} {value} (i32.lt_s {value} {low})) (i32.gt_s {value} {high}))"


# -- functions
#
# Addresses are in bytes, so words advance by 2. Unsigned comparisons of addresses (lt_u), signed ones of words (lt_s).
# `load16_s` extends the sign of a word and `store16` cuts a result to 16 bits, which is the wrap-around of the machine.

_ELEMENTWISE: dict[str, tuple[Callable[..., str], int]] = {
    "math.copy": (lambda value: value, 1),
    "math.add": (_binary_operation("add"), 2),
    "math.sub": (_binary_operation("sub"), 2),
    "math.mul": (_binary_operation("mul"), 2),
    "math.min": (_minimum, 2),
    "math.max": (_maximum, 2),
    "math.clamp": (_clamped, 3),
}
"""Value of an element, and its number of source arguments. Operands may be evaluated more than once."""

_ELEMENTWISE_ONCE: dict[str, tuple[str, Callable[..., str], int]] = {
    "math.div": (
        "(if (i32.eqz (local.get $w2)) (then (return (i32.const 1))))",
        lambda one, two: f"(i32.div_s {one} {two})",
        2,
    ),
    "math.muldiv": (
        "(if (i32.eqz (local.get $w3)) (then (return (i32.const 1))))",
        lambda one, two, three: f"(i32.div_s (i32.mul {one} {two}) {three})",
        3,
    ),
    "math.sqrt": (
        "(if (i32.lt_s (local.get $w1) (i32.const 0)) (then (return (i32.const 2))))",
        lambda one: f"(i32.trunc_f64_s (f64.sqrt (f64.convert_i32_s {one})))",
        1,
    ),
    "math.sin": ("", lambda one: f"(call $sine {one})", 1),
    "math.cos": ("", lambda one: f"(call $sine (i32.extend16_s (i32.add {one} (i32.const {RIGHT_ANGLE}))))", 1),
    "math.atan2": ("", lambda one, two: f"(call $arctangent {one} {two})", 2),
}
"""Check of the words $w1, $w2, …, value of an element, and the number of arguments that it is made of."""


def _loop(name: str, check: str, function: Callable[..., str], count: int) -> str:
    """Return a function that computes element after element."""
    arguments = range(1, count + 1)
    loads = " ".join(f"(local.set $w{n} (i32.load16_s (local.get $a{n})))" for n in arguments)
    steps = " ".join(f"(local.set $a{n} (i32.add (local.get $a{n}) (i32.const 2)))" for n in range(count + 1))
    return f"""
(func ${name} {" ".join(f"(param $a{n} i32)" for n in range(count + 1))} (param $end i32) (result i32)
  {" ".join(f"(local $w{n} i32)" for n in arguments)}
  (local.set $end (i32.add (local.get $a0) (local.get $end)))
  (loop $next
    (if (i32.lt_u (local.get $a0) (local.get $end)) (then
      {loads}
      {check}
      (i32.store16 (local.get $a0) {function(*(f"(local.get $w{n})" for n in arguments))})
      {steps}
      (br $next))))
  (i32.const 0))"""


_FILL = """
(func $math.fill (param $to i32) (param $from i32) (param $end i32) (result i32) (local $word i32)
  (local.set $word (i32.load16_s (local.get $from)))
  (local.set $end (i32.add (local.get $to) (local.get $end)))
  (loop $next
    (if (i32.lt_u (local.get $to) (local.get $end)) (then
      (i32.store16 (local.get $to) (local.get $word))
      (local.set $to (i32.add (local.get $to) (i32.const 2)))
      (br $next))))
  (i32.const 0))"""

_ADDSCALAR = """
(func $math.addscalar (param $to i32) (param $from i32) (param $scalar i32) (param $end i32) (result i32)
  (local.set $scalar (i32.load16_s (local.get $scalar)))
  (local.set $end (i32.add (local.get $to) (local.get $end)))
  (loop $next
    (if (i32.lt_u (local.get $to) (local.get $end)) (then
      (i32.store16 (local.get $to) (i32.add (i32.load16_s (local.get $from)) (local.get $scalar)))
      (local.set $to (i32.add (local.get $to) (i32.const 2)))
      (local.set $from (i32.add (local.get $from) (i32.const 2)))
      (br $next))))
  (i32.const 0))"""

_DOT = """
(func $math.dot (param $to i32) (param $a i32) (param $b i32) (param $shift i32) (param $end i32) (result i32)
  (local $total i32)
  (local.set $end (i32.add (local.get $a) (local.get $end)))
  (loop $next
    (if (i32.lt_u (local.get $a) (local.get $end)) (then
      (local.set $total (i32.add (local.get $total)
        (i32.mul (i32.load16_s (local.get $a)) (i32.load16_s (local.get $b)))))
      (local.set $a (i32.add (local.get $a) (i32.const 2)))
      (local.set $b (i32.add (local.get $b) (i32.const 2)))
      (br $next))))
  (local.set $shift (i32.load16_s (local.get $shift)))
  (i32.store16 (local.get $to) (select (i32.const 0) (i32.shr_s (local.get $total) (local.get $shift))
    (i32.gt_s (local.get $shift) (i32.const 32))))
  (i32.const 0))"""

_STAT = """
(func $math.stat (param $from i32) (param $low i32) (param $high i32) (param $mean i32) (param $size i32) (result i32)
  (local $end i32) (local $word i32) (local $total i32)
  (if (i32.eqz (local.get $size)) (then (return (i32.const 0))))
  (local.set $end (i32.add (local.get $from) (local.get $size)))
  (local.set $word (i32.load16_s (local.get $from)))
  (i32.store16 (local.get $low) (local.get $word))
  (i32.store16 (local.get $high) (local.get $word))
  (loop $next
    (local.set $word (i32.load16_s (local.get $from)))
    (if (i32.lt_s (local.get $word) (i32.load16_s (local.get $low)))
      (then (i32.store16 (local.get $low) (local.get $word))))
    (if (i32.gt_s (local.get $word) (i32.load16_s (local.get $high)))
      (then (i32.store16 (local.get $high) (local.get $word))))
    (local.set $total (i32.add (local.get $total) (local.get $word)))
    (local.set $from (i32.add (local.get $from) (i32.const 2)))
    (br_if $next (i32.lt_u (local.get $from) (local.get $end))))
  (i32.store16 (local.get $mean) (i32.div_s (local.get $total) (i32.shr_u (local.get $size) (i32.const 1))))
  (i32.const 0))"""

_ARGBOUNDS = """
(func $math.argbounds (param $from i32) (param $low i32) (param $high i32) (param $size i32) (result i32)
  (local $at i32) (local $word i32) (local $least i32) (local $most i32)
  (local.set $least (i32.const 32767))
  (local.set $most (i32.const -32768))
  (loop $next
    (if (i32.lt_u (local.get $at) (local.get $size)) (then
      (local.set $word (i32.load16_s (i32.add (local.get $from) (local.get $at))))
      (if (i32.lt_s (local.get $word) (local.get $least)) (then
        (local.set $least (local.get $word))
        (i32.store16 (local.get $low) (i32.shr_u (local.get $at) (i32.const 1)))))
      (if (i32.gt_s (local.get $word) (local.get $most)) (then
        (local.set $most (local.get $word))
        (i32.store16 (local.get $high) (i32.shr_u (local.get $at) (i32.const 1)))))
      (local.set $at (i32.add (local.get $at) (i32.const 2)))
      (br $next))))
  (i32.const 0))"""

# Shell sort: insertion sort with gaps of 1, 4, 13, … words, from the largest down.
_SORT = """
(func $math.sort (param $from i32) (param $size i32) (result i32)
  (local $gap i32) (local $at i32) (local $hole i32) (local $word i32) (local $other i32)
  (local.set $gap (i32.const 2))
  (loop $wider
    (if (i32.lt_u (local.get $gap) (local.get $size)) (then
      (local.set $gap (i32.add (i32.mul (local.get $gap) (i32.const 3)) (i32.const 2)))
      (br $wider))))
  (loop $narrower
    (local.set $at (local.get $gap))
    (loop $next
      (if (i32.lt_u (local.get $at) (local.get $size)) (then
        (local.set $word (i32.load16_s (i32.add (local.get $from) (local.get $at))))
        (local.set $hole (local.get $at))
        (block $placed (loop $down
          (br_if $placed (i32.lt_u (local.get $hole) (local.get $gap)))
          (local.set $other (i32.load16_s (i32.add (local.get $from) (i32.sub (local.get $hole) (local.get $gap)))))
          (br_if $placed (i32.le_s (local.get $other) (local.get $word)))
          (i32.store16 (i32.add (local.get $from) (local.get $hole)) (local.get $other))
          (local.set $hole (i32.sub (local.get $hole) (local.get $gap)))
          (br $down)))
        (i32.store16 (i32.add (local.get $from) (local.get $hole)) (local.get $word))
        (local.set $at (i32.add (local.get $at) (i32.const 2)))
        (br $next))))
    (if (i32.gt_u (local.get $gap) (i32.const 2)) (then
      (local.set $gap (i32.div_u (i32.sub (local.get $gap) (i32.const 2)) (i32.const 3)))
      (br $narrower))))
  (i32.const 0))"""

_ROT2 = f"""
(func $math.rot2 (param $to i32) (param $from i32) (param $angle i32) (result i32)
  (local $x i32) (local $y i32) (local $c i32) (local $s i32)
  (local.set $x (i32.load16_s (local.get $from)))
  (local.set $y (i32.load16_s offset=2 (local.get $from)))
  (local.set $angle (i32.load16_s (local.get $angle)))
  (local.set $c (call $sine (i32.extend16_s (i32.add (local.get $angle) (i32.const {RIGHT_ANGLE})))))
  (local.set $s (call $sine (local.get $angle)))
  (i32.store16 (local.get $to) (i32.shr_s (i32.sub (i32.mul (local.get $c) (local.get $x))
    (i32.mul (local.get $s) (local.get $y))) (i32.const 15)))
  (i32.store16 offset=2 (local.get $to) (i32.shr_s (i32.add (i32.mul (local.get $c) (local.get $y))
    (i32.mul (local.get $s) (local.get $x))) (i32.const 15)))
  (i32.const 0))"""


def _between(table: int, bits: int) -> str:
    """Return the linear interpolation between table words $at and $at + 1, at $rest / 2^bits."""
    at = "(i32.shl (local.get $at) (i32.const 1))"
    return f"""(i32.shr_s (i32.add
    (i32.mul (i32.load16_s offset={table} {at}) (i32.sub (i32.const {1 << bits}) (local.get $rest)))
    (i32.mul (i32.load16_s offset={table + 2} {at}) (local.get $rest))) (i32.const {bits}))"""


_RAND = f"""
(func $math.rand (param $to i32) (param $end i32) (result i32)
  (local.set $end (i32.add (local.get $to) (local.get $end)))
  (loop $next
    (if (i32.lt_u (local.get $to) (local.get $end)) (then
      (i32.store (i32.const {RANDOM}) (i32.and (i32.const 0xFFFF) (i32.add (i32.const {RANDOM_STEP})
        (i32.mul (i32.const {RANDOM_FACTOR}) (i32.load (i32.const {RANDOM}))))))
      (i32.store16 (local.get $to) (i32.load (i32.const {RANDOM})))
      (local.set $to (i32.add (local.get $to) (i32.const 2)))
      (br $next))))
  (i32.const 0))"""

_SINE_FUNCTION = f"""
(func $sine (param $angle i32) (result i32) (local $at i32) (local $rest i32)
  (if (i32.eq (local.get $angle) (i32.const {RIGHT_ANGLE})) (then (return (i32.const 32767))))
  (if (i32.eq (local.get $angle) (i32.const {-RIGHT_ANGLE})) (then (return (i32.const -32767))))
  (local.set $at (select (local.get $angle) (i32.sub (i32.const 0) (local.get $angle))
    (i32.ge_s (local.get $angle) (i32.const 0))))
  (if (i32.gt_s (local.get $at) (i32.const {RIGHT_ANGLE}))
    (then (local.set $at (i32.sub (i32.const 32768) (local.get $at)))))
  (local.set $rest (i32.and (local.get $at) (i32.const 127)))
  (local.set $at (i32.shr_u (local.get $at) (i32.const 7)))
  (local.set $at {_between(TABLES, 7)})
  (select (local.get $at) (i32.sub (i32.const 0) (local.get $at)) (i32.ge_s (local.get $angle) (i32.const 0))))"""

_STEEPNESS_FUNCTION = f"""
(func $steepness (param $height i32) (param $width i32) (result i32)
  (local $quotient i32) (local $exponent i32) (local $at i32) (local $rest i32)
  (local.set $quotient (i32.div_s (i32.shl (local.get $height) (i32.const 16)) (local.get $width)))
  (local.set $exponent (i32.sub (i32.const 31) (i32.clz (i32.or (local.get $quotient) (i32.const 1)))))
  (if (i32.lt_u (local.get $exponent) (i32.const 12)) (then
    (return (i32.shr_s (i32.mul (i32.const {ARCTANGENT[0]}) (local.get $quotient)) (i32.const 12)))))
  (local.set $rest (i32.extend16_s (i32.shr_s
    (i32.sub (local.get $quotient) (i32.shl (i32.const 1) (local.get $exponent)))
    (i32.sub (local.get $exponent) (i32.const 8)))))
  (local.set $at (i32.add (i32.shl (i32.sub (local.get $exponent) (i32.const 12)) (i32.const 3))
    (i32.shr_s (local.get $rest) (i32.const 5))))
  (local.set $rest (i32.and (local.get $rest) (i32.const 31)))
  {_between(_ARCTANGENTS, 5)})"""

_ARCTANGENT_FUNCTION = f"""
(func $arctangent (param $y i32) (param $x i32) (result i32) (local $angle i32)
  (if (i32.eqz (local.get $y)) (then
    (return (select (i32.const 0) (i32.const -32768) (i32.ge_s (local.get $x) (i32.const 0))))))
  (local.set $angle (i32.const {RIGHT_ANGLE}))
  (if (local.get $x) (then (local.set $angle (call $steepness
    (i32.extend16_s (select (local.get $y) (i32.sub (i32.const 0) (local.get $y))
      (i32.ge_s (local.get $y) (i32.const 0))))
    (i32.extend16_s (select (local.get $x) (i32.sub (i32.const 0) (local.get $x))
      (i32.ge_s (local.get $x) (i32.const 0))))))))
  (if (i32.lt_s (local.get $x) (i32.const 0))
    (then (local.set $angle (i32.sub (i32.const 32768) (local.get $angle)))))
  (select (local.get $angle) (i32.sub (i32.const 0) (local.get $angle)) (i32.gt_s (local.get $y) (i32.const 0))))"""


def _data(place: int, words: Sequence[int]) -> str:
    text = "".join(f"\\{byte:02x}" for word in words for byte in (word & 0xFFFF).to_bytes(2, "little"))
    return f'(data (i32.const {place}) "{text}")'


_FUNCTIONS: dict[str, str] = {
    **{name: _loop(name, "", function, count) for name, (function, count) in _ELEMENTWISE.items()},
    **{name: _loop(name, *row) for name, row in _ELEMENTWISE_ONCE.items()},
    "math.fill": _FILL,
    "math.addscalar": _ADDSCALAR,
    "math.dot": _DOT,
    "math.stat": _STAT,
    "math.argbounds": _ARGBOUNDS,
    "math.sort": _SORT,
    "math.rot2": _ROT2,
    "math.rand": _RAND,
    **wasm_deque.FUNCTIONS,
    "sine": _SINE_FUNCTION,
    "arctangent": _ARCTANGENT_FUNCTION,
    "steepness": _STEEPNESS_FUNCTION,
    "sines": _data(TABLES, SINE),
    "arctangents": _data(_ARCTANGENTS, [*ARCTANGENT, *[RIGHT_ANGLE] * 8]),
}
_NEEDS: dict[str, tuple[str, ...]] = {
    "math.sin": ("sine",),
    "math.cos": ("sine",),
    "math.rot2": ("sine",),
    "math.atan2": ("arctangent",),
    "sine": ("sines",),
    "arctangent": ("steepness",),
    "steepness": ("arctangents",),
    **wasm_deque.NEEDS,
}
_SHAPES = {native.name: tuple(parameter.size for parameter in native.parameters) for native in THYMIO_II.natives}
