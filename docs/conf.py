"""The site of `make docs`: the pages of docs/ and of the root, and a reference from docstrings."""

from __future__ import annotations

import re
import sys
from pathlib import Path

ROOT = Path(__file__).parent.parent
sys.path.insert(0, str(ROOT / "docs"))  # docstring_sections

project = "Thymio Sim ROS"
author = "Thymio Sim ROS maintainers"
copyright = author  # noqa: A001  # the name that Sphinx reads
version = release = re.search(r'"(.+)"', (ROOT / "thymio_sim_ros" / "__init__.py").read_text("utf-8"))[1]

extensions = ["myst_parser", "autodoc2", "sphinx_design"]
root_doc = "docs/index"
include_patterns = [
    "docs/*.md",
    "docs/apidocs/index.rst",
    "docs/**/*.md",
    "*.md",
    "playgrounds/README.md",
    "tests/README.md",
    "tests/data/*/README.md",
]
exclude_patterns = ["build", ".venv*", "web_ui", "node_modules"]
html_theme = "furo"
html_title = project

myst_enable_extensions = ["attrs_inline"]
myst_heading_anchors = 4

# Public interfaces only: what docs/aseba_vm.md, docs/plugins.md, docs/reinforcement-learning.md and the page about
# grading promise.
autodoc2_packages = [
    {"path": "aseba_vm", "exclude_dirs": ["cli", "jit", "__pycache__"]},
    {"path": "thymio_sim_ros/testing", "module": "thymio_sim_ros.testing"},
    {"path": "thymio_sim_ros/sim/plugin_api", "module": "thymio_sim_ros.sim.plugin_api"},
    {"path": "thymio_sim_ros/rl", "module": "thymio_sim_ros.rl"},
    {"path": "thymio_sim_ros/tf", "module": "thymio_sim_ros.tf"},
]
autodoc2_output_dir = "docs/apidocs"
autodoc2_render_plugin = "myst"
autodoc2_docstring_parser_regexes = [(r".*", "docstring_sections")]
autodoc2_hidden_objects = {"private", "dunder", "inherited", "undoc"}
