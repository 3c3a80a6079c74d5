"""What the page's creator knows of missions is what their reader declares."""

from __future__ import annotations

import json
from pathlib import Path

from thymio_sim_ros.missions.declarations import declarations

GENERATED = Path(__file__).parents[2] / "web_ui" / "playground" / "mission_declarations.json"


def test_the_generated_file_of_the_page_holds_the_declarations() -> None:
    generated = json.loads(GENERATED.read_text(encoding="utf-8"))
    remedy = f"python -m thymio_sim_ros.missions.declarations > {GENERATED.relative_to(GENERATED.parents[2])}"
    assert generated == declarations(), remedy
