"""Kernels that only tests use."""

from __future__ import annotations

import math

from aseba_vm.kernel.record import Record
from aseba_vm.kernel.types import Floats, Ints, Words, kernel

SHARE = 0.1
STEP = 3


@kernel
def square(x: float) -> float:
    """Called by others."""
    return x * x


class Points(Record):
    """A record of two arrays."""

    x: Floats
    visits: Ints


@kernel
def arithmetic(given: Floats, found: Floats) -> None:
    """Every operation of floats."""
    a = given[0]
    b = given[1]
    found[0] = a + b * SHARE
    found[1] = a - b / 3
    found[2] = -a
    found[3] = abs(a) + math.sqrt(abs(b))
    found[4] = min(a, b) - max(a, 0.5)
    found[5] = float(math.floor(a)) + int(b)
    found[6] = square(a) - 2
    found[7] += a
    found[7] *= 2
    found[8] = round(a * 4) + round(b * 4 + 0.5)


@kernel
def integers(given: Ints, found: Ints) -> None:
    """Every operation of integers."""
    a = given[0]
    b = given[1]
    found[0] = a + b * STEP - 1
    found[1] = (a << 3) | (b & 5)
    found[2] = a >> 2
    found[3] = -b
    found[STEP + 1] = a


@kernel
def logic(given: Floats, found: Ints) -> None:
    """Conditions and what is not looked at."""
    a = given[0]
    b = given[1]
    found[0] = 1 if a < b and b <= 1.0 else 0
    found[1] = 1 if a > b or not b > a else 0
    found[2] = 1 if -1.0 <= a < b < 2 else 0
    found[3] = 7 if a != b else 8
    if a >= 0.5:
        found[4] = 1
    elif b >= 0.5:
        found[4] = 2
    else:
        found[4] = 3


@kernel
def loops(given: Floats, found: Floats) -> None:
    """Loops of all kinds."""
    total = 0.0
    for index in range(8):
        if given[index] < 0.2:
            continue
        if given[index] > 0.9:
            break
        total += given[index]
    found[0] = total
    count = 0
    while count < 5:
        count += 2
        found[1] += count
    found[2] = index


@kernel
def nested(found: Ints) -> None:
    """A loop in a loop whose limits move."""
    number = 0
    for row in range(1, 4):
        last = row + 2
        for column in range(row, last):
            last = 0
            if column == 3:
                break
            found[number] = 10 * row + column
            number += 1


@kernel
def words(given: Words, found: Words) -> None:
    """Sixteen bits."""
    found[0] = given[1] + 1
    found[1] = given[0]


@kernel
def choose(kind: int, share: float, found: Floats) -> None:
    """Numbers as parameters."""
    found[0] = share * kind


@kernel
def early(found: Floats) -> None:
    """Leaves before its end."""
    found[0] = 1.0
    if found[0] > 0.0:
        return
    found[0] = 2.0


@kernel
def beyond(found: Floats) -> None:
    """Numbers without end."""
    found[0] = math.floor(1.5) * HUGE
    found[1] = -HUGE


@kernel
def visit(points: Points, index: int) -> None:
    """Called with a record."""
    points.x[index] *= 2.0
    points.visits[index] += 1


@kernel
def visit_all(points: Points, found: Floats) -> None:
    """Fields of a record, its length, and a call that passes it on."""
    for index in range(points.count):
        visit(points, index)
        found[index] = points.x[index] + points.visits[index]


HUGE = math.inf
