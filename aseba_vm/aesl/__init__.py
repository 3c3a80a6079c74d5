"""The .aesl file: definitions and code of the nodes of one network (docs/spec/aseba-language.md section 13).

``loads`` forgives what the reference forgives; with ``strict=True`` it refuses what would surprise a person later
(docs/aseba_vm.md, "Files"). Declared entities and overlong files are always refused, and no other document is ever
read.
``dumps`` gives back the text that was read, byte for byte, but for what has been changed in between.
"""

from __future__ import annotations

from aseba_vm.aesl.network import Network, Node, Plugin
from aseba_vm.aesl.reader import MAX_CHARACTERS, MAX_NODES, checked_length, read
from aseba_vm.aesl.text_decoding import decode
from aseba_vm.aesl.writer import write
from aseba_vm.errors import AeslError, TextError

__all__ = ["MAX_CHARACTERS", "MAX_NODES", "Network", "Node", "Plugin", "bare", "dumps", "is_aesl", "loads"]


def is_aesl(text: str) -> bool:
    """Tell an .aesl file from the bare text of a program, which never begins with ``<``."""
    return text.lstrip("\ufeff \t\r\n").startswith("<")


def loads(text: str | bytes, *, strict: bool = False) -> Network:
    """Read a file; bytes are decoded as they declare. Raises AeslError with line and column.

    ``strict`` demands the root ``network``, 1 to MAX_NODES nodes with names and numbers of their own, names that a
    program can use, none twice, events of 0 to 258 words, constants of 16 bits, a keyword flag that is true or false.
    """
    if isinstance(text, bytes):
        try:
            text = decode(text).text
        except TextError as error:
            raise AeslError(error.kind, error.arguments, error.line, error.column) from error
    return read(text, is_strict=strict)


def bare(text: str, name: str) -> Network:
    """Return the network of a bare program for nodes of a name. Raises AeslError if it is longer than a file may be."""
    return Network(nodes=(Node(name, code=checked_length(text)),))


def dumps(network: Network) -> str:
    """Return the text of a file: as it was read but for what is new, or all as the reference writes it."""
    return write(network)
