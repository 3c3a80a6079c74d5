"""The exception of the protocol."""

from aseba_vm.errors import AsebaError


class ProtocolError(AsebaError):
    """Bytes that are no message, or a message with values that no frame can carry."""
