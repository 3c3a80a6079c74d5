"""Syntax trees of Python files, for tests of rules about source text; a process parses each file once."""

from __future__ import annotations

import ast
from functools import cache
from pathlib import Path

ROOT = Path(__file__).parent.parent


@cache
def tree(path: Path) -> ast.Module:
    """The syntax tree of a file; it must not be changed."""
    return ast.parse(path.read_text(encoding="utf-8"), str(path))


def place(path: Path, node: ast.stmt | ast.expr) -> str:
    """File and line of a node, for messages: `thymio_sim_ros/sim/world.py:12`."""
    return f"{path.relative_to(ROOT)}:{node.lineno}"
