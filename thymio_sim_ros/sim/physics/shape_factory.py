"""Outlines as pymunk's shapes."""

from __future__ import annotations

import pymunk

from thymio_sim_ros.sim.model.primitives import Disc, Outline

__all__ = ["shape_of"]


def shape_of(outline: Outline, body: pymunk.Body) -> pymunk.Shape:
    """A shape for a body whose origin is that of the outline."""
    if isinstance(outline, Disc):
        return pymunk.Circle(body, outline.radius_m)
    return pymunk.Poly(body, outline.vertices)
