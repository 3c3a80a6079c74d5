"""Certificates that cannot be used are refused with the reason."""

from __future__ import annotations

import shutil
import subprocess
from pathlib import Path

import pytest

from tests.bridge.certificates import make_certificate
from thymio_sim_ros.bridge.tls import TlsError, tls_context

pytestmark = pytest.mark.process


def test_a_certificate_and_its_key_are_accepted_in_two_files_or_one(tmp_path: Path) -> None:
    cert, key = make_certificate(tmp_path)
    tls_context(str(cert), str(key))
    both = tmp_path / "both.pem"
    both.write_bytes(cert.read_bytes() + key.read_bytes())
    tls_context(str(both))


def test_a_missing_file_is_named(tmp_path: Path) -> None:
    cert, _ = make_certificate(tmp_path)
    with pytest.raises(TlsError, match=r"other\.pem: No such file or directory; expected a PEM file"):
        tls_context(str(cert), str(tmp_path / "other.pem"))


def test_a_key_of_another_certificate_is_refused(tmp_path: Path) -> None:
    cert, _ = make_certificate(tmp_path)
    (tmp_path / "other").mkdir()
    _, other = make_certificate(tmp_path / "other")
    with pytest.raises(TlsError, match=r"cert\.pem: the key in .*other.* is that of another certificate"):
        tls_context(str(cert), str(other))


@pytest.mark.parametrize("contents", [b"", b"not PEM", b"-----BEGIN CERTIFICATE-----\nAAAA\n"])
def test_a_file_that_is_no_certificate_is_refused(tmp_path: Path, contents: bytes) -> None:
    _, key = make_certificate(tmp_path)
    wrong = tmp_path / "wrong.pem"
    wrong.write_bytes(contents)
    with pytest.raises(TlsError, match="expected a certificate and its key as PEM"):
        tls_context(str(wrong), str(key))


def test_a_key_with_a_password_is_refused_without_asking_for_it(tmp_path: Path) -> None:
    cert, key = make_certificate(tmp_path)
    secret = tmp_path / "secret.pem"
    command = ["openssl", "ec", "-in", key, "-out", secret, "-aes128", "-passout", "pass:secret"]
    subprocess.run(command, check=True, capture_output=True)
    with pytest.raises(TlsError, match="the key without a password"):
        tls_context(str(cert), str(secret))


def test_an_expired_certificate_is_refused(tmp_path: Path) -> None:
    _, key = make_certificate(tmp_path)
    request = tmp_path / "request.pem"
    openssl = shutil.which("openssl")
    subprocess.run([openssl, "req", "-new", "-key", key, "-subj", "/CN=old", "-out", request], check=True)
    expired = tmp_path / "expired.pem"
    dates = ["-days", "-1"]
    command = [openssl, "x509", "-req", "-in", request, "-signkey", key, *dates, "-out", expired]
    subprocess.run(command, check=True, capture_output=True)
    with pytest.raises(TlsError, match=r"expired\.pem: certificate has expired; expected one that is valid today"):
        tls_context(str(expired), str(key))
