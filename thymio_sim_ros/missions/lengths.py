"""How long a program is, in the unit of the language in which it was made."""

from __future__ import annotations

import re

from thymio_sim_ros.device.programs.program import ThymioProgram, parse

__all__ = ["length_of"]

_ROW = re.compile(r"<set[^>]*>\s*<block")
"""The editor writes an empty row at the end."""
_BLOCK = re.compile(r"<(?:block|shadow)\s")
_VPL, _BLOCKS = "ThymioVisualProgramming", "ThymioBlockly"


def length_of(program: ThymioProgram) -> tuple[int, str]:
    """Return the length of all programs of its file and their unit: rows of VPL, blocks, or lines with code."""
    nodes = parse(program.text or program.source).nodes
    for name, part, unit in ((_VPL, _ROW, "rows"), (_BLOCKS, _BLOCK, "blocks")):
        made = [plugin.xml for node in nodes for plugin in node.plugins if plugin.name == name]
        if made:
            return sum(len(part.findall(xml)) for xml in made), unit
    lines = [line for node in nodes for line in node.code.splitlines()]
    return sum(bool(line.partition("#")[0].strip()) for line in lines), "lines"
