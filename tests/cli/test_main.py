"""The command thymio-sim: what a user gets wrong is one line and exit code 2; the runner needs no ROS."""

from __future__ import annotations

import errno
import importlib.util
import json
import os
import pathlib
import signal
import socket
import subprocess
import sys

import pytest

from tests import disk
from tests.patience import PATIENCE_S, until
from tests.processes import free_port
from thymio_sim_ros.access.tokens import READ_ONLY_VARIABLE, TOKEN_VARIABLE
from thymio_sim_ros.cli import main, page_options, suite
from thymio_sim_ros.cli.signal_handling import StopSignal
from thymio_sim_ros.engine import run_log
from thymio_sim_ros.engine.replay import replay
from thymio_sim_ros.sim.audio.synthesis import SAMPLE_NS


def refused(capsys, *arguments):
    """The one line on stderr of a command that exits with 2."""
    assert main.main(arguments) == 2
    captured = capsys.readouterr()
    assert captured.out == ""
    (line,) = captured.err.splitlines()
    return line


def test_a_missing_playground_is_one_line(capsys):
    assert "did you mean 'obstacle'?" in refused(capsys, "--playground", "obstacel")


def test_a_missing_program_is_one_line(capsys, tmp_path):
    assert "nowhere.aesl" in refused(capsys, "--program", str(tmp_path / "nowhere.aesl"))


def test_a_broken_program_is_located(capsys, tmp_path):
    program = tmp_path / "broken.aesl"
    program.write_text("var a\nonevent prox\n  a = bb + 1\n")
    line = refused(capsys, "--program", str(program))
    assert "broken.aesl" in line
    assert "line 3, column 7" in line
    assert "bb" in line


def test_a_program_that_is_no_text_is_refused(capsys, tmp_path):
    program = tmp_path / "picture.aesl"
    program.write_bytes(b"\x89PNG\xff\xfe")
    assert "this is a picture; choose the file of the program" in refused(capsys, "--program", str(program))
    program.write_bytes(b"var a\xff")
    assert "UTF-8" in refused(capsys, "--program", str(program))


def test_a_broken_playground_is_located(capsys, tmp_path):
    playground = tmp_path / "broken.json"
    playground.write_text('{"title": "x", "shapes": 3}')
    line = refused(capsys, "--playground", str(playground))
    assert "broken.json" in line
    assert "expected" in line


@pytest.mark.parametrize(
    ("words", "text"),
    [
        (["--key", "key.pem"], "--key: expected --certificate, too"),
        (["--certificate", "/no/such.pem"], "--certificate: /no/such.pem: No such file or directory"),
    ],
)
def test_a_certificate_that_cannot_be_used_is_one_line(capsys, words, text):
    assert text in refused(capsys, *words)


def test_a_bridge_without_a_port_of_its_own_needs_the_page(capsys):
    line = refused(capsys, "--no-foxglove-port", "--no-web")
    assert "--no-foxglove-port: found --no-web, expected the port of the page" in line


@pytest.mark.process
@pytest.mark.parametrize(
    ("option", "whose", "others"), [("--port", "page", []), ("--foxglove-port", "Foxglove", ["--no-web"])]
)
def test_a_port_in_use_is_one_line(capsys, option, whose, others):
    with socket.socket() as taken:
        taken.bind(("127.0.0.1", 0))
        taken.listen()
        port = str(taken.getsockname()[1])
        line = refused(capsys, option, port, *others)
    assert port in line
    assert whose in line
    assert option in line


@pytest.mark.parametrize(
    "arguments",
    [
        ("--port", "http"),
        ("--port", "70000"),
        ("--address", "school"),
        ("--address", "::"),
        ("--real-time-factor", "fast"),
        ("--nonsense",),
        ("extra",),
    ],
)
def test_bad_arguments_exit_with_2(capsys, arguments):
    with pytest.raises(SystemExit, match="2"):
        main.main(arguments)
    assert "error" in capsys.readouterr().err


@pytest.mark.process
def test_an_address_of_another_computer_is_one_line(capsys):
    line = refused(capsys, "--address", "192.0.2.1")
    assert "192.0.2.1" in line
    assert "the page" in line


@pytest.mark.parametrize("command", [["--help"], ["runner", "--help"]])
def test_help_has_an_example(capsys, command):
    with pytest.raises(SystemExit, match="0"):
        main.main(command)
    assert "example:" in capsys.readouterr().out


def test_without_ros_the_error_says_how_to_install_it(capsys, monkeypatch):
    monkeypatch.setattr(importlib.util, "find_spec", lambda _name: None)
    assert "`thymio-sim runner` work without" in refused(capsys, "--headless", "--ros")


@pytest.mark.process
def test_checking_the_ports_accepts_no_connection(capsys, monkeypatch):
    """A browser that waits for the page took the first answer of its port for the page."""

    class Socket(socket.socket):
        def listen(self, *_backlog):
            pytest.fail("listens before there is a page")

    monkeypatch.setattr(socket, "socket", Socket)
    monkeypatch.setattr(importlib.util, "find_spec", lambda _name: None)
    ports = ("--port", str(free_port()), "--foxglove-port", str(free_port()))
    assert "ROS 2 is not installed" in refused(capsys, "--ros", *ports)


def test_the_runner_repeats_itself_bit_for_bit(capsys):
    outputs = []
    for seed in ("3", "3", "4"):
        assert main.main(["runner", "--program", "line_follower", "--seconds", "10", "--seed", seed]) == 0
        outputs.append(json.loads(capsys.readouterr().out)["robots"])
    assert outputs[0] == outputs[1]
    assert outputs[0] != outputs[2]


@pytest.mark.process
def test_only_the_chosen_subcommand_is_imported():
    script = (
        "import sys\n"
        "from thymio_sim_ros.cli import main as cli\n"
        "try:\n"
        "    cli.main(['--version'])\n"
        "finally:\n"
        "    print([word for word in ('suite', 'grade', 'sweep') if f'{cli.__package__}.{word}' in sys.modules])\n"
    )
    result = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, timeout=PATIENCE_S, check=False
    )
    assert result.stdout.splitlines()[-1] == "['suite']", result.stderr


@pytest.mark.process
def test_the_runner_needs_no_ros():
    script = (
        "import sys\n"
        "sys.modules['rclpy'] = None\n"
        "from thymio_sim_ros.cli import main as cli\n"
        "sys.exit(cli.main(['runner', '--seconds', '1']))\n"
    )
    result = subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, timeout=PATIENCE_S, check=False
    )
    assert result.returncode == 0, result.stderr
    assert "real_time_factor" in result.stdout


def test_the_runner_starts_a_built_in_behaviour_and_names_the_others(capsys):
    arguments = ["runner", "--playground", "base", "--behaviour", "explorer", "--seconds", "2"]
    assert main.main(arguments) == 0
    assert json.loads(capsys.readouterr().out)["robots"]["thymio"]["x_m"] > 0.05
    assert "did you mean 'friendly'?" in refused(capsys, "--behaviour", "freindly")
    assert "menu.aesl: line" in refused(capsys, "--behaviour", "menu", "--layout", "playground")


def test_a_card_that_is_no_folder_is_one_line(capsys, tmp_path):
    file = tmp_path / "card"
    file.touch()
    assert refused(capsys, "runner", "--card", str(file)).endswith("expected a folder, or a place for one")


@pytest.mark.parametrize("place", ["robot.aesl", "robot.aesl/deeper"])
def test_settings_in_what_is_no_folder_are_one_line(capsys, tmp_path, place):
    (tmp_path / "robot.aesl").touch()
    line = refused(capsys, "runner", "--settings", str(tmp_path / place))
    assert line == f"thymio-sim: settings {tmp_path / place}: Not a directory; expected a folder, or a place for one"


@pytest.fixture
def secret(monkeypatch):
    """A folder that the user may not look into; root, who runs some tests, may into all."""

    def refusing(function):
        def refuse(path, *how, **more):
            if str(path).startswith("secret/"):
                raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), str(path))
            return function(path, *how, **more)

        return refuse

    monkeypatch.setattr(os, "stat", refusing(os.stat))
    monkeypatch.setattr(pathlib.Path, "read_text", refusing(pathlib.Path.read_text))
    return "secret/there"


@pytest.mark.parametrize("kind", ["playground", "program"])
def test_a_file_in_a_forbidden_folder_is_one_line(capsys, secret, kind):
    line = refused(capsys, "runner", f"--{kind}", secret)
    assert line == f"thymio-sim: {kind} '{secret}': Permission denied; expected a file that can be read"


def test_settings_in_a_forbidden_folder_are_one_line(capsys, secret):
    line = refused(capsys, "runner", "--settings", secret)
    assert line == f"thymio-sim: settings {secret}/settings.json: Permission denied; expected a file that can be read"


def test_a_log_in_a_forbidden_folder_is_one_line(capsys, secret):
    assert refused(capsys, "--log", f"{secret}/run.jsonl").endswith("expected a file in a folder that exists")


def test_settings_that_cannot_be_read_are_one_line(capsys, tmp_path):
    (tmp_path / "settings.json").write_text('{"sound_shift": "loud"}')
    assert "sound_shift: expected 1 whole numbers" in refused(capsys, "runner", "--settings", str(tmp_path))


def test_a_log_on_a_full_disk_is_one_line(capsys):
    assert main.main(["runner", "--seconds", "3", "--log", "/dev/full"]) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err == "thymio-sim: /dev/full: No space left on device; expected a file that can be written\n"


def test_a_log_in_no_folder_is_one_line(capsys, tmp_path):
    path = tmp_path / "nowhere" / "run.jsonl"
    assert refused(capsys, "--log", str(path)).endswith("run.jsonl: expected a file in a folder that exists")


@pytest.mark.parametrize("option", ["--layout", "--events", "--motors", "--proximity"])
def test_a_choice_that_does_not_exist_lists_the_others(capsys, option):
    with pytest.raises(SystemExit, match="2"):
        main.main(["runner", option, "other"])
    assert "choose from" in capsys.readouterr().err


def test_the_runner_gives_the_robot_its_card(capsys, tmp_path):
    program = tmp_path / "note.aesl"
    program.write_text("var status\nvar n\ncall sd.open(7, status)\ncall sd.write([1, 2, 3], n)\n")
    card = tmp_path / "card"
    arguments = ("--program", str(program), "--card", str(card), "--layout", "playground", "--motors", "firmware")
    assert main.main(["runner", "--seconds", "0.1", *arguments]) == 0
    assert (card / "u7.dat").read_bytes() == b"\x01\x00\x02\x00\x03\x00"


def test_the_runner_lets_sensors_see_as_wanted(tmp_path):
    log = tmp_path / "run.jsonl"
    assert main.main(["runner", "--seconds", "0.1", "--proximity", "enki", "--log", str(log)]) == 0
    ((_, begun), *_) = run_log.read(log)
    assert begun.start.world.proximity_model == "enki"


def test_the_runner_stores_the_sound(capsys, tmp_path):
    program = tmp_path / "song.aesl"
    program.write_text("call sound.system(0)")
    sound = tmp_path / "sound.wav"
    arguments = ("--program", str(program), "--sound", str(sound))
    assert main.main(["runner", "--seconds", "0.5", *arguments]) == 0
    assert sound.stat().st_size == 44 + 3906
    capsys.readouterr()
    assert "nowhere" in refused(capsys, "runner", "--sound", str(tmp_path / "nowhere" / "sound.wav"))


COMMAND = (sys.executable, "-c", "import sys; from thymio_sim_ros.cli.main import main; sys.exit(main(sys.argv[1:]))")
LONG_S = "1e7"


@pytest.mark.process
@pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM])
def test_a_run_that_is_interrupted_keeps_what_it_made(tmp_path, number):
    log, sound = tmp_path / "run.jsonl", tmp_path / "sound.wav"
    command = [*COMMAND, "runner", "--seconds", LONG_S, "--log", str(log), "--sound", str(sound)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as running:
        until(lambda: running.poll() is not None or (log.exists() and '"state"' in log.read_text()))
        assert running.poll() is None, running.communicate()
        running.send_signal(number)
        output, errors = running.communicate(timeout=PATIENCE_S)
    assert running.returncode == -number  # so that the loop of a shell around it ends, too
    seconds = json.loads(output)["seconds"]
    assert 0 < seconds < float(LONG_S)
    assert errors == f"thymio-sim: stopped after {seconds:g} of 1e+07 seconds\n"
    found = replay(log)
    assert (found.is_complete, found.differs, found.seconds) == (True, None, pytest.approx(seconds))
    assert sound.stat().st_size == 44 + seconds * 1e9 // SAMPLE_NS


@pytest.fixture
def ctrl_c():
    """What Ctrl-C does to a program in front of a terminal; what shells start in the background ignores it."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield signal.default_int_handler
    signal.signal(signal.SIGINT, before)


def test_a_second_ctrl_c_ends_at_once(ctrl_c):
    with StopSignal() as stop:
        signal.raise_signal(signal.SIGINT)
        assert stop.number == signal.SIGINT
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(signal.SIGINT)
    assert signal.getsignal(signal.SIGINT) is ctrl_c


@pytest.mark.process
@pytest.mark.skipif(not os.path.exists("/dev/full"), reason="no /dev/full here")
@pytest.mark.parametrize("arguments", [["runner", "--seconds", "0.1"], ["foxglove-layout"]])
def test_a_full_disk_behind_the_output_is_one_line(arguments):
    with open("/dev/full", "w") as full:
        ended = subprocess.run([*COMMAND, *arguments], stdout=full, stderr=subprocess.PIPE, text=True, check=False)
    assert (ended.returncode, ended.stderr) == (2, "thymio-sim: standard output: No space left on device\n")


def test_the_runner_reports_programs_that_fail(capsys, tmp_path):
    program = tmp_path / "faulty.aesl"
    program.write_text("var n\nonevent prox\n  n = 1 / n\n")
    arguments = ["--program", str(program), "--playground", "two_robots"]
    assert main.main(["runner", "--seconds", "0.5", *arguments]) == 1
    captured = capsys.readouterr()
    fault = "faulty.aesl: fault in prox, line 3: division by zero"
    assert {name: robot["fault"] for name, robot in json.loads(captured.out)["robots"].items()} == {
        "red": fault,
        "blue": fault,
    }
    assert captured.err.splitlines() == [f"thymio-sim: {name}, at 0.10 s: {fault}" for name in ("red", "blue")]


def test_the_runner_reports_a_program_that_fails_at_once(capsys, tmp_path):
    program = tmp_path / "faulty.aesl"
    program.write_text("var n\nn = 1 / n\n")
    assert main.main(["runner", "--seconds", "0", "--program", str(program)]) == 1
    assert "at 0.00 s: faulty.aesl: fault in init, line 2: division by zero" in capsys.readouterr().err


def test_the_runner_reports_what_the_robot_could_not_do(capsys, tmp_path):
    program = tmp_path / "flash.aesl"
    program.write_text("onevent prox\ncall _system.settings.flash()\n")
    with disk.files_end_at(100):
        assert main.main(["runner", "--seconds", "0.5", "--program", str(program), "--settings", str(tmp_path)]) == 0
    reported = f"settings are not stored: {tmp_path / 'settings.json'}: {disk.FILE_TOO_LARGE}"
    assert capsys.readouterr().err == f"thymio-sim: thymio, at 0.10 s: {reported}\n"
    assert list(tmp_path.iterdir()) == [program]


TWO_NODES = """<network>
<node nodeId="1" name="{}">motor.left.target = 0</node>
<node nodeId="2" name="{}">motor.left.target = 200 motor.right.target = 200</node>
</network>"""


@pytest.mark.parametrize("names", [("blue", "red"), ("red", "thymio-II"), ("thymio-II", "thymio-II")])
def test_each_robot_of_the_runner_gets_its_program_of_a_file(capsys, tmp_path, names):
    program = tmp_path / "two.aesl"
    program.write_text(TWO_NODES.format(*names))
    assert main.main(["runner", "--seconds", "1", "--playground", "two_robots", "--program", str(program)]) == 0
    captured = capsys.readouterr()
    robots = json.loads(captured.out)["robots"]
    moved = {name: not -0.26 < robots[name]["x_m"] < -0.24 and not 0.24 < robots[name]["x_m"] < 0.26 for name in robots}
    driver = "red" if names[1] == "red" else "blue"
    assert moved == {name: name == driver for name in ("red", "blue")}
    assert captured.err == ""


def test_mismatches_of_a_file_are_reported_once(capsys, tmp_path):
    program = tmp_path / "two.aesl"
    program.write_text(TWO_NODES.format("thymio-II", "e-puck0"))
    assert main.main(["runner", "--seconds", "0", "--playground", "two_robots", "--program", str(program)]) == 0
    assert capsys.readouterr().err == "thymio-sim: red, blue: not for a Thymio, left out: node 'e-puck0'\n"


def test_the_suite_takes_a_file_with_a_node_for_each_robot(capsys, tmp_path, monkeypatch):
    program = tmp_path / "two.aesl"
    program.write_text(TWO_NODES.format("red", "blue"))
    monkeypatch.setattr(importlib.util, "find_spec", lambda _name: None)
    line = refused(capsys, "--ros", "--headless", "--playground", "two_robots", "--program", str(program))
    assert "ROS 2 is not installed" in line


@pytest.mark.parametrize("token", ["abc", "has space", "a/b?c", "ä" * 8, ""])
def test_a_text_that_cannot_be_a_token_is_refused(capsys, token):
    with pytest.raises(SystemExit) as ended:
        main.main(["--token", token])
    assert ended.value.code == 2
    assert "expected 4 to 200 letters" in capsys.readouterr().err


@pytest.mark.parametrize("command", [(), ("class", "--pupils", "names.csv")])
@pytest.mark.parametrize("proxy", ["proxy.example", "10.0.0.5/8", "0.0.0.0/0"])
def test_what_names_no_proxy_is_refused(capsys, command, proxy):
    with pytest.raises(SystemExit) as ended:
        main.main([*command, "--trusted-proxy", proxy])
    assert ended.value.code == 2
    assert f"argument --trusted-proxy: '{proxy}' found" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("arguments", "text"),
    [
        (("--no-token", "--token", "abcd"), "--no-token"),
        (("--token", "abcd", "--read-only-token", "abcd"), "two different ones"),
    ],
)
def test_tokens_that_contradict_each_other_are_one_line(capsys, arguments, text):
    assert text in refused(capsys, *arguments)


def test_a_wrong_token_of_the_environment_is_one_line_that_does_not_show_it(capsys, monkeypatch):
    monkeypatch.setenv(TOKEN_VARIABLE, "not a token")
    line = refused(capsys)
    assert TOKEN_VARIABLE in line
    assert "not a token" not in line


@pytest.mark.parametrize(
    ("arguments", "environment", "full", "read_only"),
    [
        ((), {}, "", ""),
        (("--token", "abcd"), {}, "abcd", None),
        ((), {TOKEN_VARIABLE: "fromenv"}, "fromenv", None),
        (("--token", "abcd"), {TOKEN_VARIABLE: "fromenv"}, "abcd", None),
        (("--address", "0.0.0.0"), {}, None, None),
        (("--trusted-proxy", "127.0.0.1"), {}, None, None),
        (("--address", "0.0.0.0", "--no-token"), {TOKEN_VARIABLE: "fromenv"}, "", ""),
        (("--address", "0.0.0.0", "--read-only-token", "look"), {}, None, "look"),
    ],
)
def test_where_tokens_come_from(monkeypatch, arguments, environment, full, read_only):
    """None stands for a random one."""
    monkeypatch.delenv(TOKEN_VARIABLE, raising=False)
    monkeypatch.delenv(READ_ONLY_VARIABLE, raising=False)
    for name, value in environment.items():
        monkeypatch.setenv(name, value)
    tokens = page_options.given_tokens(suite._parser().parse_args(arguments))
    for found, expected in ((tokens.full, full), (tokens.read_only, read_only)):
        assert found == expected if expected is not None else len(found) >= 20


@pytest.mark.parametrize("content", ["root:x:0:0:hunter2", '{"auths": "hunter2"}', "<a pw='hunter2'/>", "hunter2"])
@pytest.mark.parametrize("option", ["--playground", "--program"])
def test_what_lies_on_this_computer_for_other_purposes_is_not_quoted(capsys, tmp_path, option, content):
    (tmp_path / "hunter2_file").write_text(content)
    line = refused(capsys, option, str(tmp_path / "hunter2_file"))
    assert "hunter2" not in line.replace("hunter2_file", "")


def test_a_replay_takes_its_world_from_the_log(capsys, tmp_path):
    log = tmp_path / "run.jsonl"
    log.write_text("nothing")
    assert "found --seed, --program" in refused(capsys, "--replay", str(log), "--seed", "3", "--program", "explorer")
    assert f"{log}: line 1" in refused(capsys, "--replay", str(log))
    with pytest.raises(SystemExit):
        main.main(["--replay", str(log), "--replay-from", "nan"])
    assert "--replay-from" in capsys.readouterr().err
    assert "expected a run log" in refused(capsys, "--replay", str(tmp_path / "absent.jsonl"))


@pytest.mark.parametrize(
    ("arguments", "found"),
    [
        (("--robot", "usb0"), "robot 'usb0': expected tcp:host:port"),
        (("--robot", "tcp:robot:0"), "found port '0', expected a number from 1 to 65535"),
        (
            ("--robot", "ser", "--playground", "line", "--real-time-factor", "2"),
            "found --playground, --real-time-factor",
        ),
        (("--robot", "ser", "--behaviour", "menu"), "found --behaviour; a real robot has no simulator"),
        (("--robot", "ser", "--program", "nowhere.aesl"), "nowhere.aesl"),
    ],
)
def test_a_real_robot_takes_no_options_of_the_simulator(capsys, arguments, found):
    assert found in refused(capsys, *arguments)


@pytest.mark.process
def test_the_suite_does_not_serve_the_port_of_its_own_robot(capsys):
    port = free_port()
    line = refused(capsys, "--robot", f"tcp:localhost:{port}", "--headless", "--aseba-port", str(port))
    assert line.endswith(f"Aseba port {port}: this is the port of the robot; choose another with --aseba-port")


def test_a_program_for_a_real_robot_is_compiled_before_anything_starts(capsys, tmp_path):
    program = tmp_path / "broken.aesl"
    program.write_text("motor.left.targt = 1\n")
    line = refused(capsys, "--robot", "ser", "--program", str(program))
    assert "line 1, column 1" in line
    assert "motor.left.target" in line
