"""Files for viewers, by `package://<package>/<path>`: meshes, textures, robot descriptions, and nothing else."""

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
"""What viewers need: the files that are given unless the user says otherwise (docs/spec/foxglove.md section 5)."""

_MAX_SIZE = 64 << 20


class AssetError(ThymioSimError):
    """Why a file is not given; the text is for the client."""


def load_asset(uri: str, allowed: Iterable[str] = (ASSETS,)) -> bytes:
    """Content of the file; raises AssetError. It must lie in its package's share folder, links resolved.

    `allowed`: regular expressions for the URI without its escapes.
    """
    if not uri.startswith(_SCHEME):
        raise AssetError(f"expected {_SCHEME}…, found {uri!r:.80}")
    plain = unquote(uri)
    package, _, path = plain.removeprefix(_SCHEME).partition("/")
    if not package.isidentifier() or ".." in Path(path).parts or "\0" in path:
        raise AssetError(f"{uri!r:.80} leaves its package")
    if not allow_list(allowed)(plain):
        raise AssetError(f"{uri!r:.80} is not given: asset_uri_allowlist does not allow it")
    for share in share_folders():
        try:
            folder = (share / package).resolve()
            file = (folder / path).resolve()
            if file.is_relative_to(folder) and file.is_file():
                return _read(file, uri)
        except (OSError, ValueError):  # a name that no file can have
            break
    raise AssetError(f"{uri!r:.80} does not exist")


def _read(file: Path, uri: str) -> bytes:
    try:
        if file.stat().st_size > _MAX_SIZE:
            raise AssetError(f"{uri!r:.80} is larger than {_MAX_SIZE >> 20} MiB")
        return file.read_bytes()
    except OSError as error:
        raise AssetError(f"{uri!r:.80}: {error.strerror}") from error
