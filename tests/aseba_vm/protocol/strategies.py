"""Hypothesis strategies of messages, made from the declared fields."""

from __future__ import annotations

from dataclasses import fields as fields_of
from typing import Any, get_type_hints

from hypothesis import strategies as st

from aseba_vm import protocol
from aseba_vm.protocol import Command, Message, UnknownMessage, UserMessage, fields
from aseba_vm.target import Parameter

#: Every class of messages with a type of its own.
SYSTEM = [
    kind
    for name in protocol.__all__
    if isinstance(kind := getattr(protocol, name), type)
    and issubclass(kind, Message)
    and kind not in (Message, Command, UserMessage, UnknownMessage)
]

U8, U16, I16 = st.integers(0, 0xFF), st.integers(0, 0xFFFF), st.integers(-0x8000, 0x7FFF)
texts = st.text(st.characters(exclude_categories=["Cs"]), max_size=60)
words = st.lists(I16, max_size=40).map(tuple)

VALUES: dict[Any, st.SearchStrategy[Any]] = {
    fields.U8: U8,
    fields.U16: U16,
    fields.I16: I16,
    fields.Version: U16,
    fields.OptionalU16: U16,
    fields.OptionalI16: I16,
    fields.Text: texts,
    fields.Words: words,
    fields.Code: st.lists(U16, max_size=40).map(tuple),
    fields.FourBytes: st.binary(min_size=4, max_size=4),
    fields.Bytes8: st.binary(max_size=255),
    fields.Bytes16: st.binary(max_size=300),
    fields.Ranges: st.lists(st.tuples(U16, words), max_size=5).map(tuple),
    fields.Parameters: st.lists(st.builds(Parameter, texts, I16), max_size=6).map(tuple),
}


def of_kind(kind: type[Message]) -> st.SearchStrategy[Message]:
    """Messages of one class."""
    hints = get_type_hints(kind, include_extras=True)
    payload = {field.name: VALUES[hints[field.name]] for field in fields_of(kind) if field.name != "source"}
    return st.builds(kind, source=U16, **payload)


user_messages = st.builds(UserMessage, U16, st.integers(0, 0x7FFF), words)
unknown_messages = st.builds(
    UnknownMessage, U16, st.integers(0xA016, 0xFFFF) | st.integers(0x8007, 0x8FFF), st.binary(max_size=40)
)
messages = st.one_of(user_messages, unknown_messages, *map(of_kind, SYSTEM))
