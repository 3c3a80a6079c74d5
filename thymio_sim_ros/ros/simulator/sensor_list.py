"""The sensors that viewers show by their declarations: content of `~/_sensors`."""

from __future__ import annotations

from typing import Any

from thymio_sim_ros.sim.plugin_api.display import DisplayedValue, Label
from thymio_sim_ros.sim.sensors import all_sensors

__all__ = ["displayed_sensors"]


def displayed_sensors() -> list[dict[str, Any]]:
    """Return name, label and rows of every sensor that declares values; its words are on `_raw/<name>`."""
    return [
        {
            "name": sensor.name,
            "label": _texts(sensor.label or sensor.name),
            "values": [_row(value) for value in sensor.displayed],
        }
        for sensor in all_sensors()
        if sensor.displayed
    ]


def _row(value: DisplayedValue) -> dict[str, Any]:
    fields = ("unit", "scale", "digits", "full_scale", "words")
    return {"label": _texts(value.label)} | {name: getattr(value, name) for name in fields}


def _texts(label: Label) -> dict[str, str]:
    return {"en": label} if isinstance(label, str) else dict(label)
