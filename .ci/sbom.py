"""Write the software bill of materials of an environment and of the page, as CycloneDX JSON.

    python .ci/sbom.py PYTHON FILE      PYTHON: the interpreter of an environment with the wheel

Needs the package cyclonedx-bom. The parts of the page are those of web_ui/package-lock.json that are bundled.
"""

from __future__ import annotations

import base64
import json
import subprocess
import sys
import urllib.parse
from collections.abc import Iterator
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parent.parent
LOCK = ROOT / "web_ui" / "package-lock.json"
FOLDER = "node_modules/"


def main(python: str, path: str) -> None:
    """Write the file, the same for the same environment."""
    command = [sys.executable, "-m", "cyclonedx_py", "environment", python]
    options = ["--pyproject", str(ROOT / "pyproject.toml"), "--output-reproducible", "--output-format", "JSON"]
    found = subprocess.run([*command, *options], check=True, capture_output=True, text=True, encoding="utf-8")
    bill = json.loads(found.stdout)
    bill["components"] += parts_of_page(json.loads(LOCK.read_text(encoding="utf-8")))
    Path(path).write_text(json.dumps(bill, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")
    print(f"{path}: {len(bill['components'])} components")


def parts_of_page(lock: Any) -> Iterator[dict[str, Any]]:
    """Yield the packages of npm that are no tools of the build."""
    for place, entry in sorted(lock["packages"].items()):
        if not place or entry.get("dev") or entry.get("optional"):
            continue
        name = place.rpartition(FOLDER)[2]
        purl = f"pkg:npm/{urllib.parse.quote(name)}@{entry['version']}"
        algorithm, _, digest = entry["integrity"].partition("-")
        yield {
            "bom-ref": purl,
            "type": "library",
            "name": name,
            "version": entry["version"],
            "purl": purl,
            "licenses": [{"expression": entry["license"]}],
            "hashes": [{"alg": f"SHA-{algorithm.removeprefix('sha')}", "content": base64.b64decode(digest).hex()}],
        }


if __name__ == "__main__":
    main(*sys.argv[1:])
