"""A real nginx with the configuration of docs/serve-a-school.md, in front of a server of a test."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

from tests.patience import PATIENCE_S, PROGRAM_S
from tests.processes import free_port, wait_for_port

PAGE = Path(__file__).parents[1] / "docs/serve-a-school.md"
PREFIX = "/thymio/"
MAIN = """\
{user}
daemon off;
pid {folder}/nginx.pid;
error_log {folder}/error.log;
events {{}}
http {{
    client_body_temp_path {folder}/body;
    proxy_temp_path {folder}/proxy;
    fastcgi_temp_path {folder}/fastcgi;
    uwsgi_temp_path {folder}/uwsgi;
    scgi_temp_path {folder}/scgi;
    access_log off;
    {server}
}}
"""


class Nginx:
    """A running nginx with TLS; skips the test where nginx or openssl is missing."""

    def __init__(
        self,
        folder: Path,
        port: int,
        *,
        passes_upgrade: bool = True,
        removes_path: bool = True,
        is_expired: bool = False,
    ) -> None:
        """Start it in front of a server on loopback, perhaps with a mistake, or with a certificate that has expired."""
        nginx = shutil.which("nginx", path="/usr/sbin:/usr/local/sbin:/usr/bin")
        if nginx is None or shutil.which("openssl") is None:
            pytest.skip("nginx or openssl is not installed")
        self.port = free_port()
        self._log, self._whole_log = folder / "access.log", folder / "whole.log"
        folder.mkdir()
        server = _documented(folder, self.port, port)
        if not passes_upgrade:
            server = re.sub(r"proxy_set_header (Upgrade|Connection) .*;", "", server)
        if not removes_path:
            server = server.replace(f"http://127.0.0.1:{port}/;", f"http://127.0.0.1:{port};")
        self.certificate = folder / "certificate.pem"
        """The file with its certificate, which clients trust by this file only."""
        _make_certificate(folder, is_expired=is_expired)
        (folder / "nginx.conf").write_text(MAIN.format(user=_user(), folder=folder, server=server))
        command = [nginx, "-p", str(folder), "-c", str(folder / "nginx.conf"), "-e", str(folder / "error.log")]
        self._process = subprocess.Popen(command)
        wait_for_port(self.port)

    @property
    def address(self) -> str:
        """The address of the server through the proxy."""
        return f"https://127.0.0.1:{self.port}{PREFIX}"

    @property
    def log(self) -> str:
        """The requests, as the documented configuration logs them."""
        return self._log.read_text()

    @property
    def whole_log(self) -> str:
        """The requests with their queries, as nginx and other proxies log them by default."""
        return self._whole_log.read_text()

    def end(self) -> None:
        """End it."""
        self._process.terminate()
        self._process.wait(PATIENCE_S)


def _documented(folder: Path, listen: int, port: int) -> str:
    """The configuration of the page with the ports and files of a test."""
    match = re.search(r"```nginx\n(.*?)```", PAGE.read_text(encoding="utf-8"), re.DOTALL)
    assert match is not None
    files = {
        "443": f"127.0.0.1:{listen}",
        "127.0.0.1:8100": f"127.0.0.1:{port}",
        "/etc/ssl/certs/school.pem": f"{folder}/certificate.pem",
        "/etc/ssl/private/school.key": f"{folder}/key.pem",
        "/var/log/nginx/thymio.log thymio;": f"{folder}/access.log thymio; access_log {folder}/whole.log combined;",
    }
    text = match[1]
    for documented, used in files.items():
        assert text.count(documented) == 1, documented
        text = text.replace(documented, used)
    return text


def _make_certificate(folder: Path, *, is_expired: bool) -> None:
    key, certificate, extensions = folder / "key.pem", folder / "certificate.pem", folder / "extensions.cnf"
    extensions.write_text("subjectAltName=IP:127.0.0.1")
    request = ["req", "-new", "-newkey", "rsa:2048", "-nodes", "-subj", "/CN=127.0.0.1", "-keyout", key]
    sign = ["x509", "-req", "-signkey", key, "-days", "-1" if is_expired else "2", "-extfile", extensions]
    for command in ([*request, "-out", folder / "request.pem"], [*sign, "-in", folder / "request.pem"]):
        done = subprocess.run(["openssl", *command], check=True, capture_output=True, timeout=PROGRAM_S)
    certificate.write_bytes(done.stdout)


def _user() -> str:
    """The user of the processes of nginx, which must be able to write in the folder of a test; root changes it."""
    return "user root;" if hasattr(os, "geteuid") and os.geteuid() == 0 else ""
