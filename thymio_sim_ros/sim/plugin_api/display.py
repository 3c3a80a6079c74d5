"""The display of the words of a sensor: labels, units, scales. The page derives rows of its sensor panel from it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

__all__ = ["DisplayedValue", "Label"]

Label = str | Mapping[str, str]
"""A text in English, or texts by language ("en", "de", "fr", "it"); where a language is missing, English is shown."""


@dataclass(frozen=True, slots=True)
class DisplayedValue:
    """A row of the panel: the next words of a reading, each multiplied by `scale`.

    Args:
        label: Label of the row.
        unit: Unit of the scaled words, such as "°C"; empty for plain numbers.
        scale: Unit per word.
        digits: Decimal places of the scaled words.
        full_scale: The absolute value of a word that fills the bar; None for a row without bar.
        words: Number of words in the row.
    """

    label: Label
    unit: str = ""
    scale: float = 1.0
    digits: int = 0
    full_scale: float | None = None
    words: int = 1
