"""Sine, cosine and arc tangent in 16-bit integers, by linear interpolation in tables.

Source: docs/spec/aseba-bytecode-vm.md section 12.

A full circle is 65536; the value 1 is represented by 32767.
"""

from __future__ import annotations

from aseba_vm.kernel.integers import floor_log2, quotient, wrap, wrap32
from aseba_vm.kernel.types import kernel

RIGHT_ANGLE = 16384
"""A quarter of a circle."""


def _table(text: str) -> tuple[int, ...]:
    return tuple(map(int, text.split()))


SINE = _table("""
    0 403 804 1207 1608 2010 2411 2812 3212 3612 4011 4411 4808 5206 5603 5998 6393 6787 7180 7572 7962 8352
    8740 9127 9513 9896 10279 10660 11040 11417 11794 12167 12540 12911 13279 13646 14010 14373 14733 15091
    15447 15801 16151 16500 16846 17190 17531 17869 18205 18538 18868 19196 19520 19842 20160 20476 20788 21097
    21403 21706 22006 22302 22595 22884 23171 23453 23732 24008 24279 24548 24812 25073 25330 25583 25833 26078
    26320 26557 26791 27020 27246 27467 27684 27897 28106 28311 28511 28707 28899 29086 29269 29448 29622 29792
    29957 30117 30274 30425 30572 30715 30852 30985 31114 31238 31357 31471 31581 31686 31786 31881 31972 32057
    32138 32215 32285 32352 32413 32470 32521 32569 32610 32647 32679 32706 32728 32746 32758 32766 32767
""")
"""The sine of each multiple of 128."""

ARCTANGENT = _table("""
    652 735 816 896 977 1058 1139 1218 1300 1459 1620 1777 1935 2093 2250 2403 2556 2868 3164 3458 3748 4029
    4307 4578 4839 5359 5836 6290 6720 7126 7507 7861 8203 8825 9357 9839 10260 10640 10976 11281 11557 12037
    12425 12755 13036 13277 13486 13671 13837 14112 14331 14514 14666 14796 14907 15003 15091 15235 15348 15441
    15519 15585 15642 15691 15736 15808 15865 15912 15951 15984 16013 16037 16060 16096 16125 16148 16168 16184
    16199 16211 16222 16240 16255 16266 16276 16284 16292 16298 16303 16312 16320 16325 16331 16334 16338 16341
    16344 16348 16352 16355 16357 16360 16361 16363 16364 16366 16369 16369 16371 16372 16373 16373 16375 16375
    16377 16376 16378 16378 16378 16379 16379 16380 16380 16380 16382 16381 16381 16381 16382 16382 16382 16382
    16382 16382 16384 16383 16383 16383 16383 16383 16383 16383 16383 16383 16383 16383 16384 16384 16384 16384
    16384 16384 16384
""")
"""The arc tangent of 2^(i-4) * (1 + j/8) at 8i + j."""

_ANGLES = (*ARCTANGENT, *[RIGHT_ANGLE] * 9)
"""The arc tangents up to the largest ratio."""


@kernel
def sine(angle: int) -> int:
    """The sine of an angle."""
    if angle == RIGHT_ANGLE:
        return 32767
    if angle == -RIGHT_ANGLE:
        return -32767
    position = abs(angle)
    if position > RIGHT_ANGLE:
        position = 32768 - position
    index = position >> 7
    fraction = position & 127
    value = (SINE[index] * (128 - fraction) + SINE[index + 1] * fraction) >> 7
    return value if angle >= 0 else -value


@kernel
def cosine(angle: int) -> int:
    """The cosine of an angle, as sin(angle + 90°)."""
    return sine(wrap(angle + RIGHT_ANGLE))


@kernel
def arctangent(y: int, x: int) -> int:
    """The angle of the direction (x, y), not yet wrapped to 16 bits."""
    if y == 0:
        return 0 if x >= 0 else -32768
    result = RIGHT_ANGLE if x == 0 else steepness_angle(wrap(abs(y)), wrap(abs(x)))
    if x < 0:
        result = 32768 - result
    return result if y > 0 else -result


@kernel
def steepness_angle(height: int, width: int) -> int:
    """The angle whose tangent is height / width; either may be -32768, which stands for 32768.

    The ratio has 16 fractional bits. Its exponent selects a group of eight table entries, its mantissa an entry and
    the fraction between it and the next. Ratios below 2^12 are interpolated linearly from 0.
    """
    ratio = quotient(wrap32(height << 16), width)
    exponent = floor_log2(ratio)
    if exponent < 12:
        return (_ANGLES[0] * ratio) >> 12
    rest = wrap32(ratio - (1 << exponent)) >> (exponent - 8)
    index = 8 * (exponent - 12) + (rest >> 5)
    fraction = rest & 31
    return (_ANGLES[index] * (32 - fraction) + _ANGLES[index + 1] * fraction) >> 5
