"""Check the licenses of what is installed with the wheel or bundled in the page: `ENV/bin/python .ci/licenses.py`.

Run it with the interpreter of an environment that has nothing but the wheel. It prints a line for each package, and
fails for a license that is not in the list, and for a package that states none.
"""

from __future__ import annotations

import json
import re
import sys
import xml.etree.ElementTree as ElementTree
from collections.abc import Iterator
from importlib.metadata import Distribution, distributions
from pathlib import Path

LOCK = Path(__file__).resolve().parent.parent / "web_ui" / "package-lock.json"

ALLOWED = {
    "Apache-2.0", "Apache-2.0 WITH LLVM-exception", "MIT", "MIT-0", "MIT-CMU", "BSD-3-Clause", "BSD", "0BSD", "Zlib",
    "PSF-2.0", "CC0-1.0", "ISC",
    "LGPL-2.1-or-later",  # zeroconf: a package of its own that is imported, and that users can replace
}  # fmt: skip
"""Licenses that allow to use this project under Apache-2.0 with the packages as they are."""

NAMES = {
    "Apache 2.0": "Apache-2.0", "Apache License 2.0": "Apache-2.0", "Apache License, Version 2.0": "Apache-2.0",
    "Apache Software License": "Apache-2.0", "MIT License": "MIT", "BSD License": "BSD", "zlib License": "Zlib",
    "Python Software Foundation License": "PSF-2.0",
}  # fmt: skip
"""Other names of licenses."""

STATED = {"resvg-py": "MIT", "ros-fastcdr": "Apache-2.0", "ros-fastrtps": "Apache-2.0"}
"""Licenses of packages whose metadata have none, by the text of the license in the package."""

OF_ENVIRONMENT = {"pip", "setuptools", "wheel"}
"""Come with every environment, not with the wheel."""


def main() -> int:
    """Print all packages; return 1 if one of them may not be used."""
    rows = sorted({*_of_python(), *_of_page()})
    wrong = [row for row in rows if not _is_allowed(row[1])]
    for name, license_, where in rows:
        print(f"{name:45} {license_:40} {where}")
    for name, license_, where in wrong:
        print(f"{name} ({where}): found the license '{license_}', expected one of .ci/licenses.py", file=sys.stderr)
    print(f"{len(rows)} packages, {len(wrong)} with another license", file=sys.stderr)
    return 1 if wrong else 0


def _of_python() -> Iterator[tuple[str, str, str]]:
    for found in distributions():
        name = found.metadata["Name"].lower().replace("_", "-")
        if name not in OF_ENVIRONMENT:
            yield name, STATED.get(name) or _license(found), "Python"


def _license(found: Distribution) -> str:
    """The license of a package: by its metadata, or by the manifest of a ROS package; empty if it states none."""
    metadata = found.metadata
    classifiers = [text.rpartition(" :: ")[2] for text in metadata.get_all("Classifier") or () if "License ::" in text]
    for stated in (
        metadata.get("License-Expression"),
        *classifiers,
        metadata.get("License"),
        *_of_ros(metadata["Name"]),
    ):
        if stated and len(stated) < 80:
            return " AND ".join(NAMES.get(part, part) for part in stated.split(" AND "))
    return ""


def _of_ros(name: str) -> list[str]:
    """The licenses in the package.xml of a ROS package, together as one."""
    package = re.sub("^ros-(jazzy-)?", "", name).replace("-", "_")
    manifest = Path(sys.prefix, "share", package, "package.xml")
    if not manifest.is_file():
        return []
    texts = [item.text or "" for item in ElementTree.parse(manifest).getroot().iter("license")]
    return [" AND ".join(NAMES.get(text, text) for text in texts)]


def _of_page() -> Iterator[tuple[str, str, str]]:
    """The packages of npm that are no tools of the build."""
    for place, entry in json.loads(LOCK.read_text(encoding="utf-8"))["packages"].items():
        if place and not entry.get("dev") and not entry.get("optional"):
            stated = entry.get("license", "")
            yield place.removeprefix("node_modules/"), NAMES.get(stated, stated), "page"


def _is_allowed(license_: str) -> bool:
    return bool(license_) and all(part in ALLOWED for part in license_.split(" AND "))


if __name__ == "__main__":
    sys.exit(main())
