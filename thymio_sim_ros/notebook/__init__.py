"""The robot in Jupyter: a suite of a notebook, and the tile in the launcher of JupyterLab and JupyterHub."""

from __future__ import annotations

from thymio_sim_ros.notebook.suite import Suite

__all__ = ["Suite"]
