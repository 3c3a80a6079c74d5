"""Layouts of Foxglove and Lichtblick for one robot, written from one description.

    panels    parts of a layout: panels, split areas, tabs
    thymio    the description: panels, topics, services and parameters
    forms     conversion to the file of each application

The two files for a robot without a namespace are shipped beside this module; `tests/studio_layout` checks that
they are equal to the present description.
"""

from __future__ import annotations

from thymio_sim_ros.studio_layout.forms import APPS, SHIPPED, render

__all__ = ["APPS", "SHIPPED", "render"]
