"""The JavaScript client of Scratch, Blockly and VPL 3 against our device manager, under Node.

It needs the packages `@mobsya-association/thymio-api` and `esbuild` in the folder that `THYMIO_SIM_NODE_MODULES` names
(`npm install --prefix DIR …` creates `DIR/node_modules`) or in `web_ui/node_modules`.
"""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from pathlib import Path

import pytest

from tests.network.tdm.machine_node import MachineNode
from tests.network.tdm.served import served
from tests.patience import PATIENCE_S

ROOT = Path(__file__).parents[3]
SCRIPT = ROOT / "tests" / "data" / "network" / "tdm_client.js"
CLIENT = "@mobsya-association/thymio-api"
PROGRAM = "var total\nonevent double\ntotal = event.args[0] * 2\nemit doubled total\n"

# The client is a bundle for browsers.
BANNER = "globalThis.document={currentScript:{src:''}};globalThis.window=globalThis;globalThis.self=globalThis;"

pytestmark = pytest.mark.process


def _modules() -> Path:
    """The folder with the packages; skips the test if there is none."""
    places = [os.environ.get("THYMIO_SIM_NODE_MODULES", ""), str(ROOT / "web_ui" / "node_modules")]
    for place in map(Path, filter(None, places)):
        if (place / CLIENT).is_dir() and (place / ".bin" / "esbuild").exists():
            return place
    pytest.skip(f"the npm packages {CLIENT} and esbuild are not installed (THYMIO_SIM_NODE_MODULES)")


@pytest.mark.skipif(shutil.which("node") is None, reason="Node is not installed")
def test_the_javascript_client_uses_a_robot(tmp_path: Path) -> None:
    modules = _modules()
    bundle = tmp_path / "client.js"
    build = [modules / ".bin" / "esbuild", SCRIPT, "--bundle", "--platform=node", f"--outfile={bundle}"]
    subprocess.run(
        [*build, f"--banner:js={BANNER}"],
        env={**os.environ, "NODE_PATH": str(modules)},
        check=True,
        capture_output=True,
    )
    with served(MachineNode(), MachineNode()) as found:
        environment = {**os.environ, "TDM_URL": f"ws://127.0.0.1:{found.ws_port}", "DOUBLE": PROGRAM}
        done = subprocess.run(
            ["node", str(bundle)], env=environment, capture_output=True, text=True, timeout=PATIENCE_S, check=False
        )
        said = [json.loads(line[1:]) for line in done.stdout.splitlines() if line.startswith("#")]
        assert said == [
            ["node", "thymio_0", "Simulated Thymio 2", "available", True],
            ["locked", "ready", True],
            ["rejected", "no variable is called 'b'"],
            ["event", [42]],
            ["variables", -300, 42, [0, 0, 0]],
            ["shared", 5, ["double", "doubled"]],
            ["renamed", "mine"],
            ["unlocked", "available"],
        ], done.stdout + done.stderr
        assert found.networks[0].node.name == "mine"
