"""Bags: what is recorded is what was published, other programs can read it, and playing publishes it again."""

from __future__ import annotations

import signal
import subprocess
import sys
import threading
from pathlib import Path

import pytest
import rclpy
from geometry_msgs.msg import Twist
from rclpy.context import Context
from rclpy.qos import DurabilityPolicy, QoSProfile, ReliabilityPolicy
from rosbags.highlevel import AnyReader
from rosbags.interfaces import QosDurability, QosReliability
from std_msgs.msg import String

from tests import pages
from tests.patience import PATIENCE_S
from tests.systems import posix
from thymio_sim_ros.bags.errors import BagError
from thymio_sim_ros.bags.player import Player
from thymio_sim_ros.bags.recorder import Recorder
from thymio_sim_ros.cli import main

RETAINED = QoSProfile(depth=3, durability=DurabilityPolicy.TRANSIENT_LOCAL)
BEST_EFFORT = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)


def contents(path):
    """What is in a bag, read by rosbags: topic and message by message."""
    with AnyReader([path]) as reader:
        return [
            (connection.topic, reader.deserialize(data, connection.msgtype))
            for connection, _, data in reader.messages()
            if connection.topic in ("/said", "/retained", "/drive")
        ]


@pytest.fixture
def talker(ros):
    node = ros.make_node("talker")
    node.said = node.create_publisher(String, "said", 10)
    node.retained = node.create_publisher(String, "retained", RETAINED)
    return node


def record(ros, path, say, **options):
    """A bag of what is said while a recorder runs."""
    recorder = Recorder(ros.make_node("recorder"), path, **options)
    ros.until(lambda: "/said" in recorder.topics)
    say(recorder)
    recorder.close()
    return recorder


@pytest.mark.parametrize("storage", ["mcap", "sqlite3"])
def test_a_bag_has_what_was_published(ros, talker, tmp_path, storage):
    talker.retained.publish(String(data="before"))

    def say(recorder):
        drive = talker.create_publisher(Twist, "drive", BEST_EFFORT)  # a topic that appears later
        ros.until(lambda: drive.get_subscription_count() == talker.said.get_subscription_count() == 1)
        for number in range(3):
            talker.said.publish(String(data=f"number {number}"))
        message = Twist()
        message.angular.z = 0.5
        drive.publish(message)
        ros.until(lambda: recorder.count >= 5)

    record(ros, tmp_path / "bag", say, storage=storage, topics=["said", "retained", "drive"])
    found = contents(tmp_path / "bag")
    assert [(topic, one.data) for topic, one in found if topic == "/said"] == [
        ("/said", f"number {number}") for number in range(3)
    ]
    assert [one.data for topic, one in found if topic == "/retained"] == ["before"]
    assert [one.angular.z for topic, one in found if topic == "/drive"] == [0.5]
    with AnyReader([tmp_path / "bag"]) as reader:
        offered = {one.topic: one.ext.offered_qos_profiles[0] for one in reader.connections}
        digests = {one.topic: one.digest for one in reader.connections}
    assert offered["/retained"].durability is QosDurability.TRANSIENT_LOCAL
    assert offered["/drive"].reliability is QosReliability.BEST_EFFORT
    assert digests["/said"].startswith("RIHS01_")


def test_without_names_all_topics_are_recorded_that_are_not_hidden(ros, talker, tmp_path):
    talker.create_publisher(String, "_hidden", 10)
    record(ros, tmp_path / "bag", lambda recorder: None)
    with AnyReader([tmp_path / "bag"]) as reader:
        found = {one.topic for one in reader.connections}
    assert {"/said", "/retained"} <= found
    assert "/_hidden" not in found
    record(ros, tmp_path / "all", lambda recorder: None, includes_hidden=True)
    with AnyReader([tmp_path / "all"]) as reader:
        assert "/_hidden" in {one.topic for one in reader.connections}


def test_a_bag_is_played_in_its_order_and_with_its_profiles(ros, talker, tmp_path):
    def say(recorder):
        ros.until(lambda: talker.said.get_subscription_count() == talker.retained.get_subscription_count() == 1)
        for publisher, word in ((talker.said, "number"), (talker.retained, "state")):
            for number in range(3):
                publisher.publish(String(data=f"{word} {number}"))
            ros.until(lambda: recorder.count >= 3)
        ros.until(lambda: recorder.count == 6)

    record(ros, tmp_path / "bag", say, topics=["said", "retained"])
    talker.destroy_publisher(talker.said)
    talker.destroy_publisher(talker.retained)
    heard = []
    listener = ros.make_node("listener")
    listener.create_subscription(String, "said", lambda message: heard.append(message.data), 10)
    node = ros.make_node("player")
    with Player(node, tmp_path / "bag") as player:
        (said,) = (one for one in node.publishers if one.topic_name == "/said")
        ros.until(said.get_subscription_count)
        assert sorted(player.topics) == ["/retained", "/said"]
        assert player.play(rate=1000.0) == 6
        listener.create_subscription(String, "retained", lambda message: heard.append(message.data), RETAINED)
        ros.until(lambda: len(heard) == 6)
    assert heard == [*(f"number {number}" for number in range(3)), *(f"state {number}" for number in range(3))]
    with Player(ros.make_node("player"), tmp_path / "bag", topics=["said"]) as player:
        assert player.play(rate=1000.0) == 3
        assert player.topics == ["/said"]


def test_playing_ends_with_the_context(ros, talker, tmp_path):
    def say(recorder):
        ros.until(lambda: talker.said.get_subscription_count() == 1)
        for number in range(2):
            talker.said.publish(String(data=f"number {number}"))
        ros.until(lambda: recorder.count == 2)

    record(ros, tmp_path / "bag", say, topics=["said"])
    context = Context()
    rclpy.init(context=context)
    node = rclpy.create_node("player", context=context)
    counts = []
    with Player(node, tmp_path / "bag") as player:
        playing = threading.Thread(target=lambda: counts.append(player.play(rate=1e-9)))
        playing.start()
        rclpy.shutdown(context=context)
        playing.join(PATIENCE_S)
    node.destroy_node()
    assert counts in ([0], [1])


def test_the_time_of_a_message_is_that_of_the_node(ros, talker, tmp_path):
    def say(recorder):
        ros.until(lambda: talker.said.get_subscription_count() == 1)
        talker.said.publish(String(data="now"))
        ros.until(lambda: recorder.count)

    before = talker.get_clock().now().nanoseconds
    record(ros, tmp_path / "bag", say, topics=["said"])
    with AnyReader([tmp_path / "bag"]) as reader:
        stamps = [stamp for _, stamp, _ in reader.messages()]
    assert len(stamps) == 1
    assert stamps[0] >= before


def test_what_cannot_be_written_or_read_is_said(ros, talker, tmp_path):
    node = ros.make_node("recorder")
    (tmp_path / "there").mkdir()
    with pytest.raises(BagError, match=r"there: cannot be written: .* exists already"):
        Recorder(node, tmp_path / "there")
    with pytest.raises(BagError, match=r"nothing: cannot be read"):
        Player(node, tmp_path / "nothing")
    record(ros, tmp_path / "bag", lambda recorder: None, topics=["said"])
    with pytest.raises(BagError, match=r"bag: found no topic /other, expected one of /said"):
        Player(node, tmp_path / "bag", topics=["other"])
    (tmp_path / "bag" / "bag.mcap").write_bytes(b"\x89MCAP0\r\n" + bytes(40))
    with pytest.raises(BagError, match=r"bag: cannot be read"):
        Player(node, tmp_path / "bag").play()


@pytest.mark.parametrize("rate", ["0", "-1", "inf", "nan", "fast"])
def test_a_wrong_rate_is_refused(rate, capsys):
    with pytest.raises(SystemExit):
        main.main(["play", "bag", "--rate", rate])
    assert "--rate" in capsys.readouterr().err


@pytest.mark.process
def test_the_example_of_the_page_works(tmp_path: Path) -> None:
    (example,) = pages.blocks(pages.read("bags.md"), "python")
    (tmp_path / "example.py").write_text(example)
    words = [sys.executable, "-m", "thymio_sim_ros.portable_ros", "example.py"]
    done = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.stdout == "1 ['/said']\n", done.stderr
    assert [one.data for _, one in contents(tmp_path / "talk")] == ["hello"]


PROGRAM = """\
import sys
import threading

import rclpy
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from std_msgs.msg import String
from thymio_sim_ros.bags import commands
from thymio_sim_ros.cli.ros.tools import parser_of

rclpy.init()
node = rclpy.create_node("talker")
publisher = node.create_publisher(String, "said", 10)
said = 0


def say():
    global said
    if publisher.get_subscription_count():
        publisher.publish(String(data=f"number {said}"))
        said += 1
        if said == 100:
            print("said", flush=True)


node.create_timer(0.001, say)


def spin():
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    try:
        executor.spin()
    except ExternalShutdownException:
        return


threading.Thread(target=spin, daemon=True).start()
rclpy.init = lambda **_: None  # the program has one context
sys.exit(commands.run(parser_of("record").parse_args(["record", "-o", sys.argv[1], "said"]), []))
"""


@posix
@pytest.mark.process
def test_ctrl_c_completes_a_bag(tmp_path: Path) -> None:
    (tmp_path / "program.py").write_text(PROGRAM)
    words = [sys.executable, "-m", "thymio_sim_ros.portable_ros", "program.py", "bag"]
    with subprocess.Popen(words, cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        assert "Recording to bag" in process.stdout.readline()
        assert process.stdout.readline() == "said\n"
        process.send_signal(signal.SIGINT)
        process.send_signal(signal.SIGINT)
        out, errors = process.communicate(timeout=PATIENCE_S)
    assert (process.returncode, errors) == (0, "")
    found = [one.data for topic, one in contents(tmp_path / "bag")]
    assert found == [f"number {number}" for number in range(len(found))]
    assert found
    assert f"Recorded {len(found)} messages of 1 topics to bag." in out
