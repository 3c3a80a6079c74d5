"""Programs in processes of their own: what students hand in, against simulated time."""

from __future__ import annotations

import textwrap
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from geometry_msgs.msg import Twist
from rclpy.qos import QoSProfile

from tests.patience import PATIENCE_S
from tests.ros_graph import IS_EMBEDDED
from thymio_sim_ros.ros.simulator.node import Simulator, SimulatorParams
from thymio_sim_ros.testing.ros import Ros, Simulation
from thymio_sim_ros.testing.ros.domain import reserved
from thymio_sim_ros.testing.ros.program import Program
from thymio_sim_ros.testing.ros.program_files import find
from thymio_sim_ros.testing.ros.student_errors import StudentError

pytestmark = pytest.mark.process

SCRIPTS = {
    "forks": """
        import multiprocessing, os, time
        import rclpy
        from geometry_msgs.msg import Twist

        def work(queue):
            time.sleep(0.02)
            queue.put(sum(range(10)))

        program = os.getpid()
        if os.fork() == 0:
            while os.getppid() == program:
                time.sleep(0.001)
            os._exit(0)
        context = multiprocessing.get_context("fork")
        queue = context.Queue()
        worker = context.Process(target=work, args=(queue,))
        start = time.time()
        worker.start()
        rclpy.init()
        node = rclpy.create_node("forks")
        for number in range(10):
            node.create_publisher(Twist, f"wheels_{number}", 10)
            time.sleep(0.1)
        print("sum", queue.get(), "after", round(time.time() - start, 2), "s")
        worker.join()
    """,
    "dance": """
        import sys, time
        import rclpy
        from geometry_msgs.msg import Twist

        rclpy.init()
        node = rclpy.create_node("dance")
        speed = node.declare_parameter("speed", 0.05).value
        wheels = node.create_publisher(Twist, "wheels", 10)
        command = Twist()
        command.linear.x = speed
        start = time.time()
        for _ in range(int(sys.argv[1])):
            wheels.publish(command)
            time.sleep(0.1)
        wheels.publish(Twist())
        print("took", round(time.time() - start, 3))
        rclpy.shutdown()
    """,
    "menu": """
        import rclpy
        from geometry_msgs.msg import Twist

        rclpy.init()
        node = rclpy.create_node("menu")
        wheels = node.create_publisher(Twist, "cmd_vel", 10)
        while (choice := input("forward, stop or quit? ")) != "quit":
            command = Twist()
            command.linear.x = 0.1 if choice == "forward" else 0.0
            wheels.publish(command)
        print("bye")
    """,
    "rated": """
        import threading
        import rclpy
        from geometry_msgs.msg import Twist

        rclpy.init()
        node = rclpy.create_node("rated")
        wheels = node.create_publisher(Twist, "cmd_vel", 10)
        threading.Thread(target=rclpy.spin, args=(node,), daemon=True).start()
        rate = node.create_rate(20)
        while rclpy.ok():
            command = Twist()
            command.linear.x = 0.1
            wheels.publish(command)
            print("now", node.get_clock().now().nanoseconds)
            rate.sleep()
    """,
    "wrong_types": """
        import rclpy
        from geometry_msgs.msg import TwistStamped
        from std_srvs.srv import Empty, Trigger

        rclpy.init()
        node = rclpy.create_node("wrong_types")
        node.create_publisher(TwistStamped, "cmd_vel", 10).publish(TwistStamped())
        for kind in (Empty, Trigger):
            client = node.create_client(kind, "simulator/pause" if kind is Empty else "simulator/reset")
            print(kind.__name__, client.wait_for_service(timeout_sec=1.0))
        answer = client.call_async(Trigger.Request())
        rclpy.spin_until_future_complete(node, answer, timeout_sec=5.0)
        print("reset", answer.result().success)
    """,
    "many": """
        import queue, threading, time
        import rclpy
        from geometry_msgs.msg import Twist
        from rclpy.callback_groups import ReentrantCallbackGroup
        from rclpy.executors import MultiThreadedExecutor
        from sensor_msgs.msg import Range

        rclpy.init()
        node = rclpy.create_node("many")
        group, lock, seen, count = ReentrantCallbackGroup(), threading.Lock(), queue.Queue(), 0

        def hear(message):
            global count
            with lock:
                count += 1
            seen.put(message.range)

        def slow():
            time.sleep(0.25)
            print("slow", round(time.monotonic(), 3), count)

        def work():
            while rclpy.ok():
                try:
                    print("range", seen.get(timeout=0.07), round(time.monotonic(), 3))
                except queue.Empty:
                    print("empty", round(time.monotonic(), 3))

        node.create_subscription(Range, "proximity/center", hear, 10, callback_group=group)
        node.create_timer(0.1, slow, callback_group=group)
        threading.Thread(target=work).start()
        executor = MultiThreadedExecutor(3)
        executor.add_node(node)
        try:
            executor.spin()
        except KeyboardInterrupt:
            print("interrupted")
    """,
    "first": """
        import time
        import rclpy
        from sensor_msgs.msg import Range

        rclpy.init()
        node = rclpy.create_node("first")
        last = None

        def hear(message):
            global last
            last = message

        node.create_subscription(Range, "proximity/center", hear, 10)
        while last is None:
            rclpy.spin_once(node, timeout_sec=0.05)
        print("first at", round(node.get_clock().now().nanoseconds * 1e-9, 2))
        end = time.time() + 0.5
        while time.time() < end:
            rclpy.spin_once(node, timeout_sec=0)
        print("done at", round(node.get_clock().now().nanoseconds * 1e-9, 2))
    """,
    "stays": """
        import threading, time

        threading.Thread(target=time.sleep, args=(1e6,)).start()
    """,
    "deadlock": """
        import rclpy
        from rclpy.node import Node
        from std_srvs.srv import Trigger

        class Calling(Node):
            def __init__(self):
                super().__init__("calling")
                self.client = self.create_client(Trigger, "simulator/reset")
                self.create_timer(0.1, self.tick)

            def tick(self):
                self.client.call(Trigger.Request())

        rclpy.init()
        rclpy.spin(Calling())
    """,
    "busy": """
        import time

        def count():
            number = 0
            while True:
                number += 1

        time.sleep(0.2)
        count()
    """,
    "crash": """
        import time

        time.sleep(0.2)
        print(1 / 0)
    """,
}


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder with all scripts."""
    for name, text in SCRIPTS.items():
        (tmp_path / f"{name}.py").write_text(textwrap.dedent(text))
    return tmp_path


@pytest.fixture
def sim(folder: Path) -> Iterator[Simulation]:
    """A simulation in a graph whose scripts are in `folder`."""
    with reserved() as domain:
        made = simulated(domain, folder)
        yield made
        made.ros.close()


def simulated(domain: int, folder: Path) -> Simulation:
    """A simulation with one robot."""
    ros = Ros(domain, folder=folder)
    simulator = ros.live(Simulator(ros.context, SimulatorParams(start_paused=True, playground="base")))
    made = Simulation(ros, simulator)
    ros.settle()
    return made


def test_a_script_with_sleeps_drives_in_simulated_time_and_ends(sim: Simulation) -> None:
    parameters, remappings = {"speed": 0.1}, {"wheels": "cmd_vel"}
    program = sim.ros.run("dance.py", arguments=["10"], parameters=parameters, remappings=remappings)
    sim.step(0.9)
    assert 0.08 < sim.thymio.pose.x_m < 0.1
    assert program.wait(1) == 0
    assert program.output == "took 1.0\n"
    sim.step(0.5)
    assert sim.thymio.speed == 0


def test_input_comes_at_simulated_times(sim: Simulation) -> None:
    program = sim.ros.run("menu.py", stdin=[(0.5, "forward"), (1.5, "stop"), (2, "quit")])
    assert program.output == "forward, stop or quit? "
    assert "waits for input" in program.lines()[0]
    sim.step(0.4)
    assert sim.thymio.speed == 0
    sim.step(1)
    assert sim.thymio.speed > 0.08
    assert program.wait(1) == 0
    assert sim.now == pytest.approx(2.0, abs=0.02)
    assert program.output.endswith("bye\n")


def test_waiting_for_the_first_message_and_polling_the_clock_both_end(sim: Simulation) -> None:
    program = sim.ros.run("first.py")
    assert program.wait(2) == 0
    first, done = (float(line.split()[-1]) for line in program.output.splitlines())
    assert done == pytest.approx(first + 0.5, abs=0.02)


def test_a_wrong_type_is_no_connection_and_stops_nothing(sim: Simulation) -> None:
    program = sim.ros.run("wrong_types.py")
    assert program.wait(5) == 0
    assert program.output.splitlines() == ["Empty False", "Trigger True", "reset True"]


def test_two_programs_with_threads_run_the_same_twice(folder: Path) -> None:
    assert outcome(folder) == outcome(folder)


def outcome(folder: Path) -> tuple[object, ...]:
    """What two programs at once write and do in 1.5 s."""
    with reserved() as domain:
        sim = simulated(domain, folder)
        try:
            rated, many = sim.ros.run("rated.py"), sim.ros.run("many.py")
            sim.step(1.5)
            assert rated.output.count("now") == 30
            sim.ros.programs.stop(many, sim.world.now_ns)
            assert "interrupted" in many.output
            return rated.output, many.output, sim.thymio.path
        finally:
            sim.ros.close()


def test_forked_processes_run_in_real_time_and_disturb_nothing(sim: Simulation) -> None:
    program = sim.ros.run("forks.py")
    assert program.wait(seconds=5) == 0
    assert program.output == "sum 45 after 1.0 s\n"


def test_a_program_whose_thread_sleeps_for_ever_ends_when_it_is_interrupted(sim: Simulation) -> None:
    program = sim.ros.run("stays.py")
    sim.step(0.1)
    assert program.exit_code is None
    sim.ros.programs.stop(program, sim.world.now_ns)
    assert program.exit_code == 130


@pytest.mark.skipif(not IS_EMBEDDED, reason="the graph of an installed ROS does not name its waits")
def test_the_report_names_a_deadlock_and_what_the_program_waits_for(sim: Simulation) -> None:
    program = sim.ros.run("deadlock.py")
    sim.step(0.3)
    assert "waits for the response of /simulator/reset (deadlock: a callback waits here" in program.lines()[0]


def test_a_busy_loop_and_an_exception_are_named_and_do_not_harm_each_other(sim: Simulation) -> None:
    sim.ros.run("busy.py", cpu_limit=0.2)
    with pytest.raises(pytest.fail.Exception) as failed:
        sim.step(0.3)
    assert "busy.py used more than 0.2 s of processor time without a wait" in str(failed.value)
    assert "in count" in str(failed.value)
    crash = sim.ros.run("crash.py", check=False)
    assert crash.wait(1) == 1
    assert crash.errors.splitlines()[-1] == "ZeroDivisionError: division by zero"
    assert "lockstep" not in crash.errors


def test_until_says_that_no_message_came(sim: Simulation) -> None:
    commands = sim.ros.collect(Twist, "nothing", qos=QoSProfile(depth=1))
    with pytest.raises(pytest.fail.Exception, match="no message came on /nothing"):
        sim.until(lambda: commands.latest.linear.x > 0, seconds=0.1)


def test_an_executable_is_found_in_the_sources_of_its_package(tmp_path: Path) -> None:
    package = tmp_path / "robots"
    package.mkdir()
    (package / "setup.py").write_text("entry_points={'console_scripts': ['drive = robots.drive:main']}")
    assert find("robots", "drive", tmp_path).options == {"function": "robots.drive:main", "folder": str(package)}
    with pytest.raises(StudentError, match="robots fly: no such executable"):
        find("robots", "fly", tmp_path)
    with pytest.raises(StudentError, match=r"absent\.py: no such file in"):
        find("absent.py", "", tmp_path)


def test_a_program_needs_a_simulation(folder: Path) -> None:
    with reserved() as domain:
        ros = Ros(domain, folder=folder)
        run: Callable[..., Program] = ros.run
        try:
            with pytest.raises(LookupError, match="simulation"):
                run("dance.py")
        finally:
            ros.close()


def test_a_failing_assert_shows_the_last_printed_lines(pytester):
    pytester.makepyfile(
        chatty="import time\nfor number in range(9):\n    print('printed', number)\ntime.sleep(60)\n",
        test_it="""
            def test_chatty(ros, simulation):
                simulation()
                ros.run("chatty.py")
                assert 1 == 2

            def test_until(ros, simulation):
                sim = simulation()
                ros.run("chatty.py")
                sim.until(lambda: False, 0.1)
        """,
    )
    done = pytester.runpytest_subprocess("-p", "thymio_sim_ros.pytest_plugin", timeout=PATIENCE_S)
    done.assert_outcomes(failed=2)
    text = done.stdout.str()
    shown = text.partition("test_until")[0]
    assert shown.index("Programs under test") < shown.index("program chatty.py: runs") < shown.index("  | printed 8")
    assert text.count("Programs under test") == 1
