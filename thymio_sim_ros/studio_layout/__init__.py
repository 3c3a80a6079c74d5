"""Layouts of Foxglove and Lichtblick for one robot: one description, two files.

    panels    what a layout is made of
    thymio    the description: which panels, on which topics
    forms     the description as either application's file

The two files for a robot without a namespace are shipped beside this module; `tests/studio_layout` holds them equal to
what the description says today.
"""

from __future__ import annotations

from thymio_sim_ros.studio_layout.forms import APPS, SHIPPED, render

__all__ = ["APPS", "SHIPPED", "render"]
