"""Standard natives inside WebAssembly, for arguments known beforehand (VM spec, section 12): unrolled, word by word.

Words are read and stored in the order of :mod:`aseba_vm.natives`, so that overlapping arguments behave the same.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

Argument = tuple[int, int]
"""Address and size."""

_LONGEST = 32


def _load(address: int) -> str:
    return f"(i32.load16_s offset={2 * address} (i32.const 0))"


def _store(address: int, value: str) -> str:
    return f"(i32.store16 offset={2 * address} (i32.const 0) {value})"


def _of(name: str) -> Callable[..., str]:
    return lambda *values: f"(i32.{name} {' '.join(values)})"


def _least(one: str, two: str) -> str:
    return f"(select {one} {two} (i32.lt_s {one} {two}))"


def _greatest(one: str, two: str) -> str:
    return f"(select {one} {two} (i32.gt_s {one} {two}))"


def _clamped(value: str, low: str, high: str) -> str:
    return f"(select {high} (select {low} {value} (i32.lt_s {value} {low})) (i32.gt_s {value} {high}))"


_ELEMENTWISE: dict[str, Callable[..., str]] = {
    "math.copy": lambda value: value,
    "math.add": _of("add"),
    "math.sub": _of("sub"),
    "math.mul": _of("mul"),
    "math.min": _least,
    "math.max": _greatest,
    "math.clamp": _clamped,
}
_PARAMETERS = {"math.copy": 2, "math.clamp": 4}


def inline(name: str, arguments: Sequence[Argument]) -> list[str] | None:
    """Return the code of a call, or None if it has to be made by the host."""
    addresses = [address for address, _ in arguments]
    sizes = [size for _, size in arguments]
    if not sizes or max(sizes) > _LONGEST:
        return None
    if name in _ELEMENTWISE and len(sizes) == _PARAMETERS.get(name, 3) and len(set(sizes)) == 1:
        target, *sources = addresses
        function = _ELEMENTWISE[name]
        values = [function(*(_load(source + place) for source in sources)) for place in range(sizes[0])]
        return [_store(target + place, value) for place, value in enumerate(values)]
    if name == "math.fill" and len(sizes) == 2 and sizes[1] == 1:
        lines = [f"(local.set $h {_load(addresses[1])})"]
        return lines + [_store(addresses[0] + place, "(local.get $h)") for place in range(sizes[0])]
    if name == "math.addscalar" and len(sizes) == 3 and sizes[0] == sizes[1] and sizes[2] == 1:
        lines = [f"(local.set $h {_load(addresses[2])})"]
        sums = [f"(i32.add {_load(addresses[1] + place)} (local.get $h))" for place in range(sizes[0])]
        return lines + [_store(addresses[0] + place, value) for place, value in enumerate(sums)]
    if name == "math.dot" and len(sizes) == 4 and sizes[0] == sizes[3] == 1 and sizes[1] == sizes[2]:
        total = "(i32.const 0)"
        for place in range(sizes[1]):
            product = f"(i32.mul {_load(addresses[1] + place)} {_load(addresses[2] + place)})"
            total = f"(i32.add {total} {product})"
        shift = _load(addresses[3])
        shifted = f"(i32.shr_s {total} {shift})"
        return [_store(addresses[0], f"(select (i32.const 0) {shifted} (i32.gt_s {shift} (i32.const 32)))")]
    return None
