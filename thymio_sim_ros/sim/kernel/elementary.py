"""Elementary functions as kernels, so that they have the same bits on every machine, compiled or not.

Sine and cosine: the argument x is reduced to r = x - n π/2 with |r| <= π/4; the polynomials are the Taylor series of
sin r and cos r, whose first omitted term is below 1e-19. π/2 is split into three parts, of which the first two have 33
bits, so that n times each of them is exact up to |x| = 1e6 (the argument reduction of Cody and Waite). The error is at
most two units in the last place there, one for |x| up to 4.

Exponential: exp x = 2^n exp r with |r| <= ln(2) / 2, and a Taylor series whose first omitted term is below 1e-17.

Logarithm: x = 2^n m with m in [sqrt(1/2), sqrt(2)], and ln m = 2 artanh s with s = (m - 1) / (m + 1), |s| <= 0.172, as
a series whose first omitted term is below 1e-18. The errors of both are at most two units in the last place.
"""

from __future__ import annotations

import math
from fractions import Fraction

from aseba_vm.kernel.types import kernel

__all__ = ["cos", "exp", "log", "sin"]


def _high_bits(number: Fraction, bits: int) -> float:
    """The leading bits of a positive number."""
    _, exponent = math.frexp(float(number))
    unit = Fraction(2) ** (exponent - bits)
    return float(number // unit * unit)


_PI = Fraction(31415926535897932384626433832795028841971693993751058209749445923, 10**64)
_PER_QUARTER = float(2 / _PI)
_QUARTER_1 = _high_bits(_PI / 2, 33)
_QUARTER_2 = _high_bits(_PI / 2 - Fraction(_QUARTER_1), 33)
_QUARTER_3 = float(_PI / 2 - Fraction(_QUARTER_1) - Fraction(_QUARTER_2))

_S3, _S5, _S7, _S9, _S11, _S13, _S15, _S17 = (
    (-1.0) ** (power // 2) / math.factorial(power) for power in (3, 5, 7, 9, 11, 13, 15, 17)
)
_C4, _C6, _C8, _C10, _C12, _C14, _C16, _C18 = (
    (-1.0) ** (power // 2) / math.factorial(power) for power in (4, 6, 8, 10, 12, 14, 16, 18)
)

_EXACT_LN_2 = Fraction(6931471805599453094172321214581765680755001343602552541206800094933936, 10**70)
_LN_2 = float(_EXACT_LN_2)
_LN_2_HIGH = _high_bits(_EXACT_LN_2, 33)
_LN_2_LOW = float(_EXACT_LN_2 - Fraction(_LN_2_HIGH))
_SQRT_2 = math.sqrt(2.0)
_EXP_LIMIT = 700.0


@kernel
def _sin_near_0(r: float) -> float:
    """Sine for |r| <= π/4."""
    q = r * r
    tail = _S3 + q * (_S5 + q * (_S7 + q * (_S9 + q * (_S11 + q * (_S13 + q * (_S15 + q * _S17))))))
    return r + r * q * tail


@kernel
def _cos_near_0(r: float) -> float:
    """Cosine for |r| <= π/4."""
    q = r * r
    tail = _C4 + q * (_C6 + q * (_C8 + q * (_C10 + q * (_C12 + q * (_C14 + q * (_C16 + q * _C18))))))
    return 1.0 - (0.5 * q - q * q * tail)


@kernel
def _reduced(x: float, quarters: int) -> float:
    """The remainder of x without this many quarters of a turn."""
    return ((x - quarters * _QUARTER_1) - quarters * _QUARTER_2) - quarters * _QUARTER_3


@kernel
def _sin_in_quarter(r: float, quarters: int) -> float:
    """Sine of r and so many quarters of a turn."""
    value = _cos_near_0(r) if quarters & 1 == 1 else _sin_near_0(r)
    return -value if quarters & 2 == 2 else value


@kernel
def sin(x: float) -> float:
    """Sine of x rad, for |x| up to 1e6."""
    quarters = math.floor(x * _PER_QUARTER + 0.5)
    return _sin_in_quarter(_reduced(x, quarters), quarters)


@kernel
def cos(x: float) -> float:
    """Cosine of x rad, for |x| up to 1e6."""
    quarters = math.floor(x * _PER_QUARTER + 0.5)
    return _sin_in_quarter(_reduced(x, quarters), quarters + 1)


@kernel
def _power_of_2(exponent: int) -> float:
    """2 to a power from -1022 to 1023, exact."""
    value = 1.0
    for _ in range(exponent):
        value = value * 2.0
    for _ in range(-exponent):
        value = value * 0.5
    return value


@kernel
def exp(x: float) -> float:
    """Exponential of x, for x within 700 of 0; beyond, that of the limit."""
    x = min(max(x, -_EXP_LIMIT), _EXP_LIMIT)
    twos = math.floor(x / _LN_2 + 0.5)
    r = (x - twos * _LN_2_HIGH) - twos * _LN_2_LOW
    total = 1.0
    for number in range(14):  # Horner's scheme: 1 + r/1 (1 + r/2 (1 + r/3 ...))
        total = 1.0 + r / (14 - number) * total
    return total * _power_of_2(twos)


@kernel
def log(x: float) -> float:
    """Natural logarithm of a normal number x > 0."""
    twos = 0
    m = x
    while m > _SQRT_2:
        m = m * 0.5
        twos = twos + 1
    while m * _SQRT_2 < 1.0:
        m = m * 2.0
        twos = twos - 1
    s = (m - 1.0) / (m + 1.0)
    q = s * s
    total = 0.0
    for number in range(11):
        total = total * q + 1.0 / (23 - 2 * number)
    return twos * _LN_2_HIGH + (twos * _LN_2_LOW + 2.0 * (s + s * q * total))
