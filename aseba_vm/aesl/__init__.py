"""The .aesl file: definitions and code of the nodes of one network (docs/spec/aseba-language.md section 13).

`loads` is as lenient as the reference; `strict=True` also rejects what would cause surprises later
(docs/aseba_vm.md, "Files"). Declared entities and overlong files are always rejected, and no other document is ever
read.

`dumps` reproduces the text that was read, byte for byte, except for what has been changed since.
"""

from __future__ import annotations

from aseba_vm.aesl.foreign_files import refuse_foreign
from aseba_vm.aesl.network import Network, Node, Plugin
from aseba_vm.aesl.reader import MAX_CHARACTERS, MAX_NODES, checked_length, read
from aseba_vm.aesl.text_decoding import decode
from aseba_vm.aesl.writer import write
from aseba_vm.errors import AeslError, TextError

__all__ = ["MAX_CHARACTERS", "MAX_NODES", "Network", "Node", "Plugin", "bare", "dumps", "is_aesl", "loads"]


def is_aesl(text: str) -> bool:
    """Whether a text is an .aesl file; the plain text of a program never starts with `<`."""
    return text.lstrip("\ufeff \t\r\n").startswith("<")


def loads(text: str | bytes, *, strict: bool = False) -> Network:
    """Parse a file; bytes are decoded as they declare. Raises AeslError with line and column.

    `strict` requires the root `network`, 1 to MAX_NODES nodes with distinct names and numbers, names that a program
    can use and that are defined once, events of 0 to 258 words, constants of 16 bits, and a keyword flag of true or
    false.
    """
    if isinstance(text, bytes):
        try:
            text = decode(text).text
        except TextError as error:
            raise AeslError(error.kind, error.arguments, error.line, error.column) from error
    if strict:
        refuse_foreign(text)
    return read(text, is_strict=strict)


def bare(text: str, name: str) -> Network:
    """A network whose only program is this text, for nodes called `name`.

    Raises AeslError if it is too long, or the file of another program.
    """
    refuse_foreign(text)
    return Network(nodes=(Node(name, code=checked_length(text)),))


def dumps(network: Network) -> str:
    """The text of a file: as it was read except for changes, or all in the format of the reference."""
    return write(network)
