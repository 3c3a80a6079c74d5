"""A disk that takes no more."""

from __future__ import annotations

import errno
import os
import resource
from collections.abc import Iterator
from contextlib import contextmanager

FILE_TOO_LARGE = os.strerror(errno.EFBIG)
"""What the system says when a file would become too large."""


@contextmanager
def files_end_at(size: int) -> Iterator[None]:
    """Meanwhile this process can write so many bytes to a file, and no more."""
    limits = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, limits[1]))
    try:
        yield
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, limits)
