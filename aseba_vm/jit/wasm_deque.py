"""Deque natives in WebAssembly; they follow :mod:`aseba_vm.machine.deque` step by step.

Source: docs/spec/aseba-bytecode-vm.md section 12.

Parameters are addresses and sizes in bytes; ``$cap`` is the capacity and ``$n`` a number of words. A function returns
0, FAULT, or TWO_FAULTS for a pop of which both halves failed. Changes made before a fault remain, as in the reference.
"""

from __future__ import annotations

FAULT, TWO_FAULTS = 3, 4

_COUNT = "(i32.load16_u (local.get $q))"
_START = "(i32.load16_u offset=2 (local.get $q))"
_FAIL = f"(then (return (i32.const {FAULT})))"
_IS_LEFT = f"(i32.lt_s (local.get $index) (i32.shr_u {_COUNT} (i32.const 1)))"
_CAPACITY = f"""
  (local.set $cap (i32.sub (i32.shr_u (local.get $length) (i32.const 1)) (i32.const 2)))
  (if (i32.lt_s (local.get $cap) (i32.const 1)) {_FAIL})"""
_INDEX = f"""
  (local.set $index (i32.load16_s (local.get $index)))
  (if (i32.ge_u (local.get $index) (local.get $cap)) {_FAIL})"""
_WORDS = "(i32.shr_u (local.get $size) (i32.const 1))"
_TOO_MANY = f"(if (i32.gt_s (local.get $n) (i32.sub {_COUNT} (local.get $index))) {_FAIL})"


def _copy(to: str, source: str) -> str:
    """Return a loop that copies $n words one after the other; $i is the counter."""
    return f"""
  (loop $next
    (if (i32.lt_u (local.get $i) (local.get $n)) (then
      (i32.store16 {to} (i32.load16_s {source}))
      (local.set $i (i32.add (local.get $i) (i32.const 1)))
      (br $next))))"""


_OUTSIDE_AT = "(i32.add (local.get $words) (i32.shl (local.get $i) (i32.const 1)))"
_RING_AT = "(call $deque_place (local.get $q) (local.get $cap) (i32.add (local.get $at) (local.get $i)))"

_PLACE = """
(func $deque_place (param $q i32) (param $cap i32) (param $position i32) (result i32)
  (if (i32.ge_u (local.get $position) (local.get $cap))
    (then (local.set $position (i32.rem_u (local.get $position) (local.get $cap)))))
  (i32.add (i32.add (local.get $q) (i32.const 4)) (i32.shl (local.get $position) (i32.const 1))))"""


def move(memory_words: int) -> str:
    """Return the function that moves words along the ring, for a memory of ``memory_words`` words."""
    return f"""
(func $deque_move (param $q i32) (param $cap i32) (param $to i32) (param $last i32) (param $by i32) (result i32)
  (local $step i32) (local $from i32)
  (if (i32.eqz (local.get $by)) (then (return (i32.const 0))))
  (local.set $last (i32.extend16_s (local.get $last)))
  (local.set $step (select (i32.const 1) (i32.const -1) (i32.gt_s (local.get $by) (i32.const 0))))
  (if (i32.and (i32.le_s (local.get $last) (i32.const 0)) (i32.lt_s (local.get $by) (i32.const 0))) {_FAIL})
  (local.set $to (i32.and (local.get $to) (i32.const 0xFFFF)))
  (loop $next
    (if (select (i32.le_s (local.get $to) (local.get $last)) (i32.ge_s (local.get $to) (local.get $last))
          (i32.gt_s (local.get $by) (i32.const 0))) (then
      (local.set $from (i32.add (i32.add (i32.shr_u (local.get $q) (i32.const 1)) (i32.const 2))
        (i32.rem_s (i32.add (local.get $to) (local.get $by)) (local.get $cap))))
      (if (i32.lt_u (local.get $from) (i32.const {memory_words})) (then
        (i32.store16 (call $deque_place (local.get $q) (local.get $cap) (local.get $to))
          (i32.load16_s (i32.shl (local.get $from) (i32.const 1))))))
      (local.set $to (i32.and (i32.add (local.get $to) (local.get $step)) (i32.const 0xFFFF)))
      (br $next))))
  (i32.const 0))"""


_INSERT_AT = f"""
(func $deque_insert_at (param $q i32) (param $cap i32) (param $words i32) (param $n i32) (param $index i32)
  (result i32) (local $start i32) (local $count i32) (local $at i32) (local $i i32)
  (local.set $start {_START})
  (local.set $count {_COUNT})
  (if (i32.gt_s (local.get $n) (i32.sub (local.get $cap) (local.get $count))) {_FAIL})
  (if {_IS_LEFT}
    (then
      (local.set $start (i32.add (i32.sub (local.get $start) (local.get $n)) (local.get $cap)))
      (if {_START} (then (local.set $start (i32.rem_s (local.get $start) (local.get $cap)))))
      (i32.store16 offset=2 (local.get $q) (local.get $start))
      (if (call $deque_move (local.get $q) (local.get $cap) (local.get $start)
        (i32.sub (i32.add (local.get $index) (local.get $n)) (i32.const 2)) (local.get $n)) {_FAIL}))
    (else
      (if (call $deque_move (local.get $q) (local.get $cap)
        (i32.sub (i32.add (i32.add (local.get $start) (local.get $count)) (local.get $n)) (i32.const 1))
        (i32.add (i32.add (local.get $start) (local.get $index)) (local.get $n))
        (i32.sub (i32.const 0) (local.get $n))) {_FAIL})))
  (local.set $at (i32.add (local.get $start) (local.get $index)))
  {_copy(_RING_AT, _OUTSIDE_AT)}
  (i32.store16 (local.get $q) (i32.add (local.get $count) (local.get $n)))
  (i32.const 0))"""

_ERASE_AT = f"""
(func $deque_erase_at (param $q i32) (param $cap i32) (param $n i32) (param $index i32) (result i32)
  (local $start i32) (local $count i32)
  (local.set $start {_START})
  (local.set $count {_COUNT})
  {_TOO_MANY}
  (if {_IS_LEFT}
    (then
      (if (call $deque_move (local.get $q) (local.get $cap)
        (i32.sub (i32.add (i32.add (local.get $start) (local.get $index)) (local.get $n)) (i32.const 1))
        (i32.add (local.get $start) (local.get $n))
        (i32.sub (i32.const 0) (local.get $n))) {_FAIL})
      (i32.store16 offset=2 (local.get $q)
        (i32.rem_u (i32.add (local.get $start) (local.get $n)) (local.get $cap))))
    (else
      (if (call $deque_move (local.get $q) (local.get $cap)
        (i32.add (local.get $start) (local.get $index))
        (i32.sub (i32.sub (i32.add (local.get $start) (local.get $count)) (i32.const 1)) (local.get $n))
        (local.get $n)) {_FAIL})))
  (i32.store16 (local.get $q) (i32.sub (local.get $count) (local.get $n)))
  (i32.const 0))"""


def _transfer(name: str, to: str, source: str) -> str:
    return f"""
(func ${name} (param $q i32) (param $cap i32) (param $words i32) (param $n i32) (param $index i32) (result i32)
  (local $at i32) (local $i i32)
  {_TOO_MANY}
  (local.set $at (i32.add {_START} (local.get $index)))
  {_copy(to, source)}
  (i32.const 0))"""


def _native(name: str, parameters: str, body: str) -> str:
    declared = " ".join(f"(param ${parameter} i32)" for parameter in parameters.split())
    return f"(func $deque.{name} {declared} (result i32) (local $cap i32) (local $at i32) {_CAPACITY} {body})"


_ON_RING = f"(local.get $q) (local.get $cap) (local.get $words) {_WORDS}"


def _pop(index: str) -> str:
    """Return the code of get and erase; erase runs even if get failed."""
    return f"""
  (local.set $at {index})
  (i32.add
    (call $deque_get_at {_ON_RING} (local.get $at))
    (call $deque_erase_at (local.get $q) (local.get $cap) {_WORDS} (local.get $at)))
  (local.set $at)
  (select (i32.const {TWO_FAULTS}) (local.get $at) (i32.gt_u (local.get $at) (i32.const {FAULT})))"""


FUNCTIONS: dict[str, str] = {
    "deque.size": """
(func $deque.size (param $q i32) (param $to i32) (param $length i32) (result i32)
  (i32.store16 (local.get $to) (i32.load16_s (local.get $q)))
  (i32.const 0))""",
    "deque.get": _native(
        "get", "q words index length size", f"{_INDEX} (call $deque_get_at {_ON_RING} (local.get $index))"
    ),
    "deque.set": _native(
        "set", "q words index length size", f"{_INDEX} (call $deque_set_at {_ON_RING} (local.get $index))"
    ),
    "deque.erase": _native(
        "erase",
        "q index count length",
        f"{_INDEX} (call $deque_erase_at (local.get $q) (local.get $cap) (i32.load16_u (local.get $count)) "
        "(local.get $index))",
    ),
    "deque.push_front": _native(
        "push_front", "q words length size", f"(call $deque_insert_at {_ON_RING} (i32.const 0))"
    ),
    "deque.push_back": _native("push_back", "q words length size", f"(call $deque_insert_at {_ON_RING} {_COUNT})"),
    "deque.pop_front": _native("pop_front", "q words length size", _pop("(i32.const 0)")),
    "deque.pop_back": _native(
        "pop_back", "q words length size", _pop(f"(i32.and (i32.sub {_COUNT} {_WORDS}) (i32.const 0xFFFF))")
    ),
    "deque_place": _PLACE,
    "deque_insert_at": _INSERT_AT,
    "deque_erase_at": _ERASE_AT,
    "deque_get_at": _transfer("deque_get_at", _OUTSIDE_AT, _RING_AT),
    "deque_set_at": _transfer("deque_set_at", _RING_AT, _OUTSIDE_AT),
}
"""Functions by name, without ``$``; :func:`move` returns ``deque_move``.

``deque.insert`` is missing: it runs in Python, which charges the words that it moves.
"""

NEEDS: dict[str, tuple[str, ...]] = {
    "deque.get": ("deque_get_at",),
    "deque.set": ("deque_set_at",),
    "deque.erase": ("deque_erase_at",),
    "deque.push_front": ("deque_insert_at",),
    "deque.push_back": ("deque_insert_at",),
    "deque.pop_front": ("deque_get_at", "deque_erase_at"),
    "deque.pop_back": ("deque_get_at", "deque_erase_at"),
    "deque_get_at": ("deque_place",),
    "deque_set_at": ("deque_place",),
    "deque_insert_at": ("deque_place", "deque_move"),
    "deque_erase_at": ("deque_move",),
    "deque_move": ("deque_place",),
}
"""Functions that each function calls."""
