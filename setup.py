"""For colcon alone: it wants this file and the bare call, and then reads setup.cfg (pip builds by pyproject.toml)."""

from setuptools import setup

setup()
