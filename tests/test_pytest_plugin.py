"""The plug-in as other people's projects meet it: found by its entry point, free of cost, honest without ROS."""

from __future__ import annotations

import importlib.util
from collections.abc import Callable
from pathlib import Path

import pytest

from tests.patience import PROGRAM_S
from thymio_sim_ros.portable_ros import import_hook

pytestmark = pytest.mark.process

ROOT = Path(__file__).parents[1]
PLUGIN = "thymio_sim_ros.pytest_plugin"
HAS_ROS = importlib.util.find_spec("rclpy") is not None and not import_hook.is_served("rclpy")
NO_ROS = "import sys\nsys.modules.update(dict.fromkeys(['rclpy', 'std_msgs', 'geometry_msgs']))\n"

Run = Callable[..., pytest.RunResult]


@pytest.fixture
def run(pytester: pytest.Pytester, monkeypatch: pytest.MonkeyPatch) -> Run:
    """Run pytest in a process of its own, in a project of its own where the package is installed."""
    installed = pytester.path / "site" / "thymio_sim_ros-0.dist-info"
    installed.mkdir(parents=True)
    (installed / "METADATA").write_text("Metadata-Version: 2.1\nName: thymio_sim_ros\nVersion: 0\n")
    (installed / "entry_points.txt").write_text(f"[pytest11]\n{PLUGIN} = {PLUGIN}\n")
    monkeypatch.setenv("PYTHONPATH", f"{installed.parent}:{ROOT}")
    return lambda *arguments: pytester.runpytest_subprocess("-p", "no:cacheprovider", *arguments, timeout=PROGRAM_S)


def test_the_fixtures_are_there_without_a_line_in_conftest(pytester: pytest.Pytester, run: Run) -> None:
    pytester.makepyfile(
        """
        import pytest

        @pytest.mark.thymio(playground="line", program="line_follower", seed=2)
        def test_it(thymio):
            thymio.run(1)
            assert thymio.pose.x_m != 0
        """
    )
    run("--strict-markers", "-W", "error").assert_outcomes(passed=1)


def test_a_project_that_does_not_use_it_imports_nothing_of_it(pytester: pytest.Pytester, run: Run) -> None:
    pytester.makepyfile(
        """
        import sys

        def test_it():
            heavy = ("rclpy", "numpy", "pymunk", "aseba_vm", "thymio_sim_ros.sim", "thymio_sim_ros.testing")
            assert [name for name in heavy if name in sys.modules] == []
        """
    )
    result = run("-v", "-W", "error")
    result.assert_outcomes(passed=1)
    assert "Exit" not in result.stderr.str()


def test_it_can_be_switched_off(pytester: pytest.Pytester, run: Run) -> None:
    pytester.makepyfile("def test_it(thymio): pass")
    result = run("-p", f"no:{PLUGIN}")
    result.assert_outcomes(errors=1)
    result.stdout.fnmatch_lines(["*fixture 'thymio' not found*"])


def test_a_name_of_the_project_s_own_wins(pytester: pytest.Pytester, run: Run) -> None:
    pytester.makeconftest("import pytest\n@pytest.fixture\ndef ros(): return 7\n")
    pytester.makepyfile("def test_it(ros): assert ros == 7")
    run().assert_outcomes(passed=1)


def test_an_installed_ros_that_is_wanted_and_missing_skips_tests_of_nodes_with_a_reason(
    pytester: pytest.Pytester, run: Run
) -> None:
    pytester.makeconftest(NO_ROS)
    pytester.makepyfile(
        """
        def test_a_robot(thymio):
            thymio.load("motor.left.target = 100")
            thymio.run(0.5)
            assert thymio["motor.left.target"] == 100

        def test_a_node(simulation): pass
        def test_another(ros_node, spin_until): pass
        def test_a_program(runtime): pass
        """
    )
    result = run("-rs", "--ros")
    result.assert_outcomes(passed=1, skipped=3)
    result.stdout.fnmatch_lines(["*--ros: rclpy cannot be imported. Source a ROS 2 Jazzy installation*"])


GRAPH = """
    import rclpy

    def test_it({fixtures}):
        assert (rclpy.get_rmw_implementation_identifier() == "portable_ros") is {is_embedded}
"""


def test_a_file_of_tests_of_nodes_gets_the_embedded_graph(pytester: pytest.Pytester, run: Run) -> None:
    pytester.makepyfile(GRAPH.format(fixtures="ros", is_embedded=True))
    run().assert_outcomes(passed=1)


@pytest.mark.skipif(not HAS_ROS, reason="needs an installed ROS 2")
@pytest.mark.parametrize(("fixtures", "options"), [("ros", ["--ros"]), ("", [])])
def test_an_installed_ros_stays_if_it_is_wanted_or_no_test_of_nodes_is_there(
    pytester: pytest.Pytester, run: Run, fixtures: str, options: list[str]
) -> None:
    pytester.makepyfile(GRAPH.format(fixtures=fixtures, is_embedded=False))
    run(*options).assert_outcomes(passed=1)


INVALID_MARKS = [
    ('playgruond="line"', "found 'playgruond', expected keywords playground, program, programs, seed, noise"),
    ('"line"', "found 'line', expected keywords playground"),
    ('playground="lien"', "no playground 'lien'*did you mean 'line'?"),
    ('playground="two_robots"', "2 robots here: use the fixture classroom and classroom*name*"),
    ('program="motor.left.target = "', "program: line 1, column 20: expected one of"),
]


def test_an_invalid_mark_is_explained(pytester: pytest.Pytester, run: Run) -> None:
    tests = (
        f"@pytest.mark.thymio({mark})\ndef test_{number}(thymio): pass\n"
        for number, (mark, _) in enumerate(INVALID_MARKS)
    )
    pytester.makepyfile("import pytest\n" + "".join(tests))
    result = run()
    result.assert_outcomes(errors=len(INVALID_MARKS))
    result.stdout.fnmatch_lines([f"*{reported}*" for _, reported in INVALID_MARKS])


def test_an_error_in_a_program_is_shown_without_the_frames_of_the_compiler(pytester: pytest.Pytester, run: Run) -> None:
    (pytester.path / "f.aesl").write_text("motor.left.target = ")
    pytester.makepyfile("import pytest\n@pytest.mark.thymio(program='f.aesl')\ndef test_it(thymio): pass")
    result = run()
    result.assert_outcomes(errors=1)
    result.stdout.fnmatch_lines(["f.aesl: line 1, column 20: expected one of *found the end of the program"])
    assert "Traceback" not in result.stdout.str()
    result.stdout.no_fnmatch_line("*direct cause*")


def test_the_nearest_mark_wins_keyword_by_keyword(pytester: pytest.Pytester, run: Run) -> None:
    pytester.makepyfile(
        """
        import pytest

        pytestmark = pytest.mark.thymio(playground="obstacle", program="var a = 1")

        @pytest.mark.thymio(program="var a = 2")
        def test_it(thymio):
            assert thymio["a"] == 2
            assert thymio.stage.world.playground.name == "obstacle"
        """
    )
    run().assert_outcomes(passed=1)


def test_parameters_of_a_test_may_say_what_the_mark_says(pytester: pytest.Pytester, run: Run) -> None:
    pytester.makepyfile(
        """
        import pytest

        POSES = []

        @pytest.mark.thymio(playground="obstacle", program="explorer", seed=9)
        @pytest.mark.parametrize("seed", [1, 1, 2])
        def test_it(thymio, seed):
            thymio.run(5)
            POSES.append(thymio.pose)
            assert [pose == POSES[0] for pose in POSES] == [True, True, False][:len(POSES)]
        """
    )
    run().assert_outcomes(passed=3)


def test_files_are_looked_for_beside_the_test(pytester: pytest.Pytester, run: Run) -> None:
    folder = pytester.mkpydir("exercise")
    (folder / "turn.aesl").write_text("var turned = 5\n")
    (folder / "test_turn.py").write_text(
        "import pytest\n"
        "@pytest.mark.thymio(program='turn.aesl')\n"
        "def test_it(classroom, thymio):\n"
        "    assert thymio['turned'] == 5\n"
        "    assert classroom.robots[thymio.name] is thymio\n"
    )
    run().assert_outcomes(passed=1)


def test_a_project_with_ros_runs_in_parallel_without_crosstalk(pytester: pytest.Pytester, run: Run) -> None:
    pytest.importorskip("xdist")
    pytester.makepyfile(
        """
        import pytest
        from std_msgs.msg import Int32

        @pytest.mark.parametrize("number", range(8))
        def test_it(ros, spin_until, number):
            heard = ros.collect(Int32, "numbers", qos=10)
            publisher = ros.publisher(Int32, "numbers")
            for _ in range(10):
                publisher.publish(Int32(data=number))
            spin_until(lambda: len(heard) == 10)
            assert {message.data for message in heard} == {number}
            assert ros.node.count_publishers("numbers") == 1
        """
    )
    run("-n", "2", "-W", "error").assert_outcomes(passed=8)


@pytest.mark.parametrize("capture", ["sys", *(pytest.param(one, marks=pytest.mark.slow) for one in ("tee-sys", "no"))])
def test_output_may_be_captured_in_every_way(pytester: pytest.Pytester, run: Run, capture: str) -> None:
    pytester.makepyfile("def test_it(ros): assert ros.context.ok()")
    run(f"--capture={capture}").assert_outcomes(passed=1)


def test_the_world_and_program_of_a_mark_are_those_of_the_nodes(pytester: pytest.Pytester, run: Run) -> None:
    pytester.makepyfile(
        """
        import pytest
        from thymio_sim_ros.testing import emitted, followed_line

        PROGRAM = '''<network><event size="1" name="seen"/>
        <node name="thymio-II">onevent prox emit seen [3]</node></network>'''

        @pytest.mark.thymio(playground="line", seed=3, program=PROGRAM)
        def test_it(simulation, runtime):
            sim = simulation()
            assert sim.simulator.params.values.seed == 3
            runtime()
            sim.until(emitted(sim.thymio, "seen", [3]), seconds=2)
            sim.thymio.load("line_follower")
            sim.until(followed_line(sim.thymio, laps=0.1), seconds=60)
        """
    )
    run().assert_outcomes(passed=1)
