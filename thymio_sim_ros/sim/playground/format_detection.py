"""Detects the format of a playground file, reads it as data, and gives access to the files beside it.

The project's own format is JSON with "format"; the JSON of the thesis has other keys; a text that begins with "<" is
Aseba's XML; a zip archive contains one of these and its images. All files are untrusted: sizes are limited before
anything is decompressed, and files are read from one folder or archive only.
"""

from __future__ import annotations

import codecs
import io
import json
import lzma
import re
import zipfile
import zlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath

from thymio_sim_ros.sim.formats import xml_tree
from thymio_sim_ros.sim.formats.html_entities import without_html_entities
from thymio_sim_ros.sim.formats.image_io import MAX_PICTURE_BYTES
from thymio_sim_ros.sim.formats.json_text import parse_json
from thymio_sim_ros.sim.formats.xml_tree import XmlError
from thymio_sim_ros.sim.model.fields import FieldError, describe
from thymio_sim_ros.sim.playground.importers import aseba, thesis

__all__ = ["MAX_BYTES", "Beside", "Source", "folder", "is_recognized", "nothing_beside", "read_source", "unpacked_svg"]

MAX_BYTES = 32_000_000
"""Largest size of a file, images inside it included."""
MAX_ARCHIVE_FILES = 200
MAX_TEXT = 100_000
"""Largest size of a string in JSON, as written; the texts of a playground are far shorter."""
MAX_PICTURE_TEXT = 8_000_000
"""Largest size of an image in JSON, a data URI in ASCII; with room for slashes that are written as `\\/`."""
MAX_PARTS = 1_000_000
"""Largest number of values in JSON: each takes about fifty bytes of memory, even if written with two."""

Beside = Callable[[str], bytes]
"""Reads a file beside the playground by its name, at most one byte more than `MAX_PICTURE_BYTES`; raises FieldError."""

_ZIP = b"PK\x03\x04"
_UTF_16 = (codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE, b"<\0", b"\0<")
"""First bytes of a text in UTF-16, and of XML in it without byte order mark."""
_GZIP = 16
"""Added to the window size of zlib for data with a header of gzip."""
_PLAYGROUND_ENDINGS = (".xml", ".playground", ".json")
_CANNOT_UNPACK = (
    zipfile.BadZipFile, zlib.error, lzma.LZMAError, EOFError, OSError, RuntimeError, ValueError,
)  # fmt: skip
"""Exceptions for a damaged, encrypted or unusual archive; ValueError for offsets before its beginning."""
_STRINGS = re.compile(rb'"(?:[^"\\]++|\\.)*+"?', re.DOTALL)
_MARKS = re.compile(
    rb'"format"\s*:\s*\d|"(?:%s)"\s*:|<aseba-playground' % "|".join(("playground", *thesis.KEYS)).encode()
)
"""Distinguishes a playground from any other JSON or XML."""
_HEAD = 100_000
"""Number of bytes of a file in an archive that are searched for marks."""
_IN_FOLDER = "a file in the playground's folder"


@dataclass(frozen=True, slots=True)
class Source:
    """A playground as unchecked data.

    Attributes:
        data: data of a JSON playground, converted from another format if necessary.
        beside: reads the files beside it.
        notes: what a conversion has lost.
        places: positions in the original by key, for errors in a converted file.
        sets_free: whether robots that start inside something are moved, as the simulator of the original does.
    """

    data: object
    beside: Beside
    notes: tuple[str, ...] = ()
    places: Mapping[str, str] = field(default_factory=dict)
    sets_free: bool = False


def read_source(data: bytes, name: str, beside: Beside, part: str = "") -> Source:
    """The playground in the bytes of a file; `name` is its title if it has none.

    `part` names a playground of an archive with several, whose name is the title then.

    Raises FieldError if it is too large, damaged, in none of the formats, or an archive with several playgrounds of
    which `part` names none.
    """
    name = " ".join(name.encode("utf-8", "replace").decode("utf-8").split()) or "Playground"
    if len(data) > MAX_BYTES:
        raise FieldError("", f"more than {MAX_BYTES} bytes", "a smaller file")
    if data.startswith(_ZIP):
        data, beside = _unzip(data, part)
        name = PurePosixPath(part).stem or name
    elif part:
        raise FieldError("", f"'#{part}' behind the name of a file that is no archive", "the file alone")
    data = _without_mark(data)
    if data.lstrip().startswith(b"<"):
        return _read_xml(data, name, beside)
    _check_parts(data)
    parsed = parse_json(data)
    if isinstance(parsed, Mapping) and "format" not in parsed and parsed.keys() & {"playground", *thesis.KEYS}:
        converted = thesis.convert(parsed, name)
        return Source(converted.data(), beside, tuple(converted.notes), converted.places)
    return Source(parsed, beside)


def is_recognized(data: bytes) -> bool:
    """Whether a rejected file looks like a playground, so that an error may quote from it. Never raises."""
    if data.startswith(_ZIP):
        try:
            archive, names = _opened(data)
            return any(_has_marks(archive, name) for name in names)
        except FieldError:
            return False
    return _MARKS.search(_without_mark(data)) is not None


def nothing_beside(name: str) -> bytes:
    """Raise FieldError: there is no file beside a text without a folder."""
    raise FieldError("", f"the file '{name}'", "the image as a data URI, or a zip archive with both files")


def folder(path: Path) -> Beside:
    """A function that reads files of a folder and its subfolders, and raises FieldError for any other."""

    def read_file(name: str) -> bytes:
        try:
            found = (path / name).resolve()
            if "\\" in name or not found.is_relative_to(path.resolve()):
                raise FieldError("", describe(name), _IN_FOLDER)
            with found.open("rb") as file:
                return file.read(MAX_PICTURE_BYTES + 1)
        except (OSError, ValueError) as error:
            raise FieldError("", f"{describe(name)}, which cannot be read", _IN_FOLDER) from error

    return read_file


def unpacked_svg(data: bytes) -> bytes:
    """The SVG in an `.svgz` file, which is packed with gzip; FieldError without a key. One byte more than
    `MAX_PICTURE_BYTES` at most is unpacked."""
    unpacker = zlib.decompressobj(zlib.MAX_WBITS | _GZIP)
    try:
        unpacked = unpacker.decompress(data, MAX_PICTURE_BYTES + 1)
    except zlib.error as error:
        raise FieldError("", "an .svgz file that cannot be decompressed", "an SVG compressed with gzip") from error
    if not unpacker.eof and len(unpacked) <= MAX_PICTURE_BYTES:
        raise FieldError("", "a truncated .svgz file", "a complete file")
    return unpacked


def _without_mark(data: bytes) -> bytes:
    """A text without byte order mark; one in UTF-16, as some editors save it, in UTF-8."""
    if data.startswith(_UTF_16):
        big = data.startswith((codecs.BOM_UTF16_BE, b"\0<"))
        data = data.decode("utf-16-be" if big else "utf-16-le", "replace").encode("utf-8", "replace")
    return data.removeprefix(codecs.BOM_UTF8)


def _read_xml(data: bytes, name: str, beside: Beside) -> Source:
    try:
        text, refused = xml_tree.text_of(data)
        root = xml_tree.parse(without_html_entities(text))
    except XmlError as error:
        raise FieldError(f"line {error.line}", error.found, error.expected) from error
    converted = aseba.convert(root, name)
    guessed = () if refused is None else (f"read as {xml_tree.OTHER_ENCODING}, as the file is not in {refused}",)
    return Source(converted.data(), beside, (*guessed, *converted.notes), converted.places, sets_free=True)


def _opened(data: bytes) -> tuple[zipfile.ZipFile, list[str]]:
    """An archive and the names of its files that may be playgrounds."""
    try:
        archive = zipfile.ZipFile(io.BytesIO(data))
    except _CANNOT_UNPACK as error:
        raise FieldError("", "a damaged zip archive", "a complete zip archive") from error
    names = [entry.filename for entry in archive.infolist() if entry.filename and not entry.is_dir()]
    if len(names) > MAX_ARCHIVE_FILES:
        raise FieldError("", f"{len(names)} files in the archive", f"at most {MAX_ARCHIVE_FILES}")
    return archive, [name for name in names if name.lower().endswith(_PLAYGROUND_ENDINGS) and "__MACOSX" not in name]


def _has_marks(archive: zipfile.ZipFile, name: str) -> bool:
    """Whether the beginning of a file in an archive looks like a playground."""
    return _MARKS.search(_without_mark(_extract(archive, name, _HEAD))) is not None


def _chosen(archive: zipfile.ZipFile, names: list[str], part: str) -> str:
    """The playground of an archive that `part` names, by its path, its name, or its name without ending."""
    playgrounds = [name for name in names if PurePosixPath(name).name == "world.xml"] or names
    if part or len(playgrounds) > 1:
        playgrounds = [name for name in names if _has_marks(archive, name)] or names
    paths = {name: PurePosixPath(name) for name in playgrounds}
    for called in (str, lambda path: path.name, lambda path: path.stem):
        named = [name for name, path in paths.items() if called(path) == part]
        if len(named) == 1:
            return named[0]
    if len(playgrounds) == 1 and not part:
        return playgrounds[0]
    if not playgrounds:
        raise FieldError("", "no playground in the archive", "one world.xml with its images")
    quoted = ", ".join(json.dumps(name, ensure_ascii=False) for name in playgrounds)
    wanted = f", none of them {describe(part)}" if part else ""
    found = f"{len(playgrounds)} playgrounds in the archive ({quoted}){wanted}"
    raise FieldError("", found, f"the name of one, as FILE#{playgrounds[0]}")


def _unzip(data: bytes, part: str) -> tuple[bytes, Beside]:
    """The file of a playground in an archive, and a function that reads the files beside it."""
    archive, playgrounds = _opened(data)
    names = {entry.filename for entry in archive.infolist()}
    inner = _chosen(archive, playgrounds, part)
    home = PurePosixPath(inner).parent

    def read_entry(name: str) -> bytes:
        path = home / name
        entry = str(path)
        if "\\" in name or path.is_absolute() or ".." in path.parts or entry not in names:
            raise FieldError("", describe(name), "a file in the archive")
        return _extract(archive, entry, MAX_PICTURE_BYTES + 1)

    content = _extract(archive, inner, MAX_BYTES + 1)
    if len(content) > MAX_BYTES:
        raise FieldError(inner, f"more than {MAX_BYTES} bytes", "a smaller file")
    return content, read_entry


def _extract(archive: zipfile.ZipFile, name: str, most: int) -> bytes:
    """The first bytes of an entry; no more are decompressed, whatever size the archive declares."""
    try:
        with archive.open(name) as file:
            return file.read(most)
    except _CANNOT_UNPACK as error:
        raise FieldError(describe(name), "an entry that cannot be extracted", "a plain zip archive") from error


def _check_parts(data: bytes) -> None:
    """Raise FieldError for JSON that would need far more memory than its bytes; it is not decoded or parsed before."""
    if sum(map(data.count, (b",", b"[", b"{"))) > MAX_PARTS or data.count(b'"') > 2 * MAX_PARTS:
        raise FieldError("", f"more than {MAX_PARTS} values", "fewer values")
    for match in _STRINGS.finditer(data):
        begin, size = match.start(), match.end() - match.start()
        if size <= MAX_TEXT:
            continue
        is_picture = data.startswith(b'"data:', begin) and match.group().isascii()
        most = MAX_PICTURE_TEXT if is_picture else MAX_TEXT
        if size > most:
            line, column = data.count(b"\n", 0, begin) + 1, begin - data.rfind(b"\n", 0, begin)
            raise FieldError(f"line {line}, column {column}", f"a string of {size} bytes", f"at most {most}")
