"""How long a program is, in the unit of the language in which it was made."""

from __future__ import annotations

import re
from collections.abc import Sequence

from aseba_vm.aesl.network import Network

__all__ = ["length_of"]

_ROW = re.compile(r"<set[^>]*>\s*<block")
"""The editor writes an empty row at the end."""
_BLOCK = re.compile(r"<(?:block|shadow)\s")
_VPL, _BLOCKS = "ThymioVisualProgramming", "ThymioBlockly"


def length_of(network: Network) -> tuple[int, str]:
    """Return the length of all programs of a file and its unit: rows of VPL, blocks, or lines with code."""
    plugins = [plugin for node in network.nodes for plugin in node.plugins]
    for name, part, unit in ((_VPL, _ROW, "rows"), (_BLOCKS, _BLOCK, "blocks")):
        made = [plugin.xml for plugin in plugins if plugin.name == name]
        if made:
            return sum(len(part.findall(xml)) for xml in made), unit
    return sum(_lines(node.code.splitlines()) for node in network.nodes), "lines"


def _lines(lines: Sequence[str]) -> int:
    return sum(bool(line.partition("#")[0].strip()) for line in lines)
