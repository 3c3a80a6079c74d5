"""Constants of the protocol, and the modules that their import loads."""

from __future__ import annotations

import subprocess
import sys

import pytest

from thymio_sim_ros.bridge.protocol.constants import ASSET_OPCODE, SUBPROTOCOLS, BinaryOpcode, ClientBinaryOpcode


def test_opcodes_are_those_of_the_specification() -> None:
    assert {name: int(code) for name, code in BinaryOpcode.__members__.items()} == {
        "MESSAGE_DATA": 1,
        "TIME": 2,
        "SERVICE_CALL_RESPONSE": 3,
    }
    assert {name: int(code) for name, code in ClientBinaryOpcode.__members__.items()} == {
        "MESSAGE_DATA": 1,
        "SERVICE_CALL_REQUEST": 2,
    }
    assert ASSET_OPCODE == 4


def test_the_vendors_present_name_is_preferred() -> None:
    assert SUBPROTOCOLS == ("foxglove.sdk.v1", "foxglove.websocket.v1")


@pytest.mark.process
def test_the_constants_do_not_import_deprecated_websockets() -> None:
    unwanted = ("websockets.legacy", "rclpy", "foxglove_websocket.server")
    code = f"import sys, thymio_sim_ros.bridge; print([name for name in sys.modules if name.startswith({unwanted})])"
    done = subprocess.run([sys.executable, "-W", "error", "-c", code], capture_output=True, text=True, check=False)
    assert (done.stdout.strip(), done.stderr) == ("[]", "")
