"""Certificates for https and wss."""

from __future__ import annotations

import ssl

from thymio_sim_ros.errors import ThymioSimError

__all__ = ["TlsError", "tls_context"]

_NOT_YET_VALID, _EXPIRED = 9, 10
"""Codes of OpenSSL for a certificate that is not valid at the moment."""


class TlsError(ThymioSimError):
    """Files that cannot be used for TLS."""


def tls_context(certificate: str, key: str = "") -> ssl.SSLContext:
    """The context of a server with a chain of certificates and its private key, PEM files.

    `key` may be empty if the first file has both. Raises TlsError for files that clients could not connect with.
    """
    for file in filter(None, (certificate, key)):
        try:
            with open(file, "rb"):
                pass
        except OSError as error:
            raise TlsError(f"{file}: {error.strerror}; expected a PEM file") from error
    context = ssl.SSLContext(ssl.PROTOCOL_TLS_SERVER)
    try:
        # With a password, OpenSSL does not ask for that of an encrypted key on the terminal.
        context.load_cert_chain(certificate, key or None, password="")
    except (ssl.SSLError, ValueError) as error:
        if getattr(error, "reason", "") == "KEY_VALUES_MISMATCH":
            raise TlsError(f"{certificate}: the key in {key or 'this file'} is that of another certificate") from error
        files = f"{certificate} and {key}" if key else certificate
        raise TlsError(f"{files}: expected a certificate and its key as PEM, the key without a password") from error
    _check_validity(context, certificate)
    return context


def _check_validity(context: ssl.SSLContext, certificate: str) -> None:
    """Raise TlsError for a certificate that is expired: connect in memory, with a client that trusts no other one."""
    trust = ssl.SSLContext(ssl.PROTOCOL_TLS_CLIENT)
    trust.check_hostname = False
    trust.load_verify_locations(certificate)
    trust.verify_flags |= ssl.VERIFY_X509_PARTIAL_CHAIN
    to_server, to_client = ssl.MemoryBIO(), ssl.MemoryBIO()
    server = context.wrap_bio(to_server, to_client, server_side=True)
    client = trust.wrap_bio(to_client, to_server)
    for side in (client, server, client):
        try:
            side.do_handshake()
        except ssl.SSLWantReadError:
            continue
        except ssl.SSLCertVerificationError as error:
            if error.verify_code in (_NOT_YET_VALID, _EXPIRED):
                raise TlsError(f"{certificate}: {error.verify_message}; expected one that is valid today") from error
            return
