"""Value ranges: the minimum and maximum result of each operation before it is wrapped to 16 bits.

Sums, products and bit operations are exact modulo 2^16 for any operands that are. So a translator wraps only where the
value itself matters (comparison, division, right shift, index, store), and only if it can be out of range.
"""

from __future__ import annotations

LOW, HIGH = -32768, 32767

Interval = tuple[int, int]
WORD: Interval = (LOW, HIGH)


def is_word(interval: Interval) -> bool:
    """Return whether every value of the range is a signed 16-bit word."""
    return interval[0] >= LOW and interval[1] <= HIGH


def of_sum(left: Interval, right: Interval) -> Interval:
    """Return the range of left + right."""
    return left[0] + right[0], left[1] + right[1]


def of_difference(left: Interval, right: Interval) -> Interval:
    """Return the range of left - right."""
    return left[0] - right[1], left[1] - right[0]


def of_product(left: Interval, right: Interval) -> Interval:
    """Return the range of left * right."""
    corners = [one * two for one in left for two in right]
    return min(corners), max(corners)


def of_quotient(left: Interval, right: Interval) -> Interval:
    """Return the range of left / right, truncated towards 0."""
    if right[0] > 0:
        return min(left[0], 0), max(left[1], 0)
    largest = max(-left[0], left[1], 0)
    return -largest, largest


def of_remainder(left: Interval, right: Interval) -> Interval:
    """Return the range of left % right, which has the sign of left."""
    largest = max(-right[0], right[1]) - 1
    return (max(-largest, left[0]) if left[0] < 0 else 0), (min(largest, left[1]) if left[1] > 0 else 0)


def of_bits(operator: int, left: Interval, right: Interval) -> Interval:
    """Return the range of left | right (operator 7), left ^ right (8) or left & right (9)."""
    if operator == 9 and (left[0] >= 0 or right[0] >= 0):
        return 0, min(interval[1] for interval in (left, right) if interval[0] >= 0)
    bound = 1 << max(value.bit_length() if value >= 0 else (~value).bit_length() for value in (*left, *right))
    return (0 if left[0] >= 0 and right[0] >= 0 else -bound), bound - 1
