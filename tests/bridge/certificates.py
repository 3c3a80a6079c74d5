"""A certificate for tests of TLS."""

from __future__ import annotations

import shutil
import ssl
import subprocess
from pathlib import Path

import pytest


def make_certificate(folder: Path) -> tuple[Path, Path]:
    """Create a self-signed certificate for localhost and its key; skip the test without openssl."""
    openssl = shutil.which("openssl")
    if openssl is None:
        pytest.skip("openssl is not installed")
    cert, key = folder / "cert.pem", folder / "key.pem"
    command = [openssl, "req", "-x509", "-newkey", "ec", "-pkeyopt", "ec_paramgen_curve:prime256v1", "-nodes"]
    names = ["-subj", "/CN=localhost", "-addext", "subjectAltName=DNS:localhost", "-days", "2"]
    subprocess.run([*command, *names, "-keyout", key, "-out", cert], check=True, capture_output=True)
    return cert, key


def trusting(cert: Path | str) -> ssl.SSLContext:
    """Return a TLS context for clients that read and write in different threads, such as synchronous `websockets`.

    It excludes TLS 1.3, which sends tickets after the handshake: one in five hundred such clients, which read them
    while the request was being written, waited forever (Python 3.11). Asynchronous clients are not affected.
    """
    context = ssl.create_default_context(cafile=cert)
    context.maximum_version = ssl.TLSVersion.TLSv1_2
    return context
