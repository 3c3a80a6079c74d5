"""Files for viewers by their URI `package://<package>/<path>`: only meshes, textures and robot descriptions."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from urllib.parse import unquote

from thymio_sim_ros.errors import ThymioSimError
from thymio_sim_ros.ros.foxglove.graph import allow_list
from thymio_sim_ros.ros.foxglove.schemas import share_folders

__all__ = ["ASSETS", "AssetError", "load_asset"]

_SCHEME = "package://"
ASSETS = r"(?i)package://[^?#]+\.(dae|fbx|glb|gltf|jpeg|jpg|mtl|obj|png|stl|tif|tiff|urdf|webp|xacro)"
"""Default of the allowed URIs: the files that viewers need (docs/spec/foxglove.md section 5)."""

_MAX_SIZE = 64 << 20
"""Size of the largest file that is sent, bytes."""


class AssetError(ThymioSimError):
    """A file is not available; the text is sent to the client."""


def load_asset(uri: str, allowed: Iterable[str] = (ASSETS,)) -> bytes:
    """Return the content of a file in the share folder of its package, also after links are resolved.

    `allowed` are regular expressions for the URI without its escapes. Raises AssetError for other files.
    """
    if not uri.startswith(_SCHEME):
        raise AssetError(f"expected {_SCHEME}…, found {uri!r:.80}")
    plain = unquote(uri)
    package, _, path = plain.removeprefix(_SCHEME).partition("/")
    if not package.isidentifier() or ".." in Path(path).parts or "\0" in path:
        raise AssetError(f"{uri!r:.80} is not inside its package")
    if not allow_list(allowed)(plain):
        raise AssetError(f"{uri!r:.80} is rejected: asset_uri_allowlist does not allow it")
    for share in share_folders():
        try:
            folder = (share / package).resolve()
            file = (folder / path).resolve()
            if file.is_relative_to(folder) and file.is_file():
                return _read(file, uri)
        except (OSError, ValueError):  # not a possible name of a file
            break
    raise AssetError(f"{uri!r:.80} does not exist")


def _read(file: Path, uri: str) -> bytes:
    try:
        if file.stat().st_size > _MAX_SIZE:
            raise AssetError(f"{uri!r:.80} is larger than {_MAX_SIZE >> 20} MiB")
        return file.read_bytes()
    except OSError as error:
        raise AssetError(f"{uri!r:.80}: {error.strerror}") from error
