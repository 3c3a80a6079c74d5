"""The parameters of page and bridge for TLS."""

from __future__ import annotations

import ssl

from thymio_sim_ros.bridge.tls import TlsError, tls_context
from thymio_sim_ros.ros.rclpy_ext.node_runner import StartError
from thymio_sim_ros.ros.rclpy_ext.parameters import param

__all__ = ["CERTFILE", "KEYFILE", "TLS", "given_tls"]

TLS: bool = param(False, "Serve https:// and wss:// with certfile and keyfile", fixed=True)
CERTFILE: str = param("", "PEM file with the certificate chain", fixed=True)
KEYFILE: str = param("", "PEM file with the private key", fixed=True)


def given_tls(*, tls: bool, certfile: str, keyfile: str) -> ssl.SSLContext | None:
    """The context for these values of the parameters, None without TLS. Raises StartError for unusable files."""
    if not tls:
        return None
    if not certfile:
        raise StartError("parameter tls: no certificate given; set certfile and keyfile to PEM files")
    try:
        return tls_context(certfile, keyfile)
    except TlsError as error:
        raise StartError(f"parameters certfile and keyfile: {error}") from error
