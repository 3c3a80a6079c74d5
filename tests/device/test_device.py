"""The Aseba Thymio: readings in, commands and events out, run control, faults."""

from __future__ import annotations

import pytest

from thymio_sim_ros.device.device import AsebaDevice
from thymio_sim_ros.device.programs.program import load_program
from thymio_sim_ros.device.programs.status import DeviceStatus
from thymio_sim_ros.sim.commands import LED_GROUPS, EnableComm, MotorTargets, ReleaseLeds, SetLeds, ShowOnLeds

BUDGET = 5000
NO_BUTTON = (0, 0, 0, 0, 0)
CENTER = (0, 0, 1, 0, 0)
NEAR = (0, 0, 4000, 0, 0, 0, 0)
GROUND = (0, 0, 900, 800, 900, 800)


def device_with(source, events=()):
    """A device that has run the beginning of a program, its first commands taken."""
    lines = "".join(f'<event size="{size}" name="{name}"/>' for name, size in events)
    code = source.replace("<", "&lt;")
    text = f'<network>{lines}<node name="thymio-II">{code}</node></network>'
    device = AsebaDevice()
    device.load(load_program(text, "test.aesl"))
    device.run(BUDGET)
    device.pop_commands()
    return device


def test_a_new_program_darkens_the_lights_and_stops_the_wheels():
    device = AsebaDevice()
    device.load(load_program("", "none"))
    commands = device.pop_commands()
    assert MotorTargets(0, 0) in commands
    groups = [command.group for command in commands if isinstance(command, ReleaseLeds)]
    assert sorted(groups) == sorted(LED_GROUPS)


def test_a_new_program_gives_the_lights_back_to_the_robot():
    device = device_with("call leds.temperature(1, 2)")
    own = ShowOnLeds("temperature", (32, 0))
    for now_ns, is_own in ((20_000_000, False), (40_000_000, True)):
        device.feed("temperature", (300,))
        device.advance(now_ns)
        assert (own in device.pop_commands()) == is_own
        device.load(load_program("", "none"))


def test_the_identity_of_the_robot_survives_a_reset():
    device = device_with("_id = 99")
    device.run_control.reset()
    assert device.variables.get("_id") == (1,)
    assert device.variables.get("_productId") == (8,)
    assert device.variables.get("_fwversion") == (14, 1)


def test_targets_become_one_command_when_they_change():
    device = device_with("onevent prox\nmotor.left.target = 100\nmotor.right.target = -50")
    for _ in range(3):
        device.feed("proximity", NEAR)
        device.run(BUDGET)
    assert device.pop_commands() == [MotorTargets(100, -50)]
    assert device.pop_commands() == []


def test_prox_comes_once_with_ground_and_horizontal_complete():
    device = device_with(
        "var seen[3]\nvar n = 0\nonevent prox\nn = n + 1\nseen = [n, prox.horizontal[2], prox.ground.delta[1]]"
    )
    device.feed("ground", GROUND)
    device.run(BUDGET)
    assert device.variables.get("n") == (0,)
    device.feed("proximity", NEAR)
    device.run(BUDGET)
    assert device.variables.get("seen") == (1, 4000, 800)


def test_events_that_wait_coalesce_and_the_lowest_number_comes_first():
    device = device_with(
        "var order[3]\nvar n = 0\nonevent motor\norder[n] = 3\nn = n + 1\nonevent prox\norder[n] = 2\nn = n + 1\n"
        "onevent button.center\norder[n] = 1\nn = n + 1"
    )
    for _ in range(4):
        device.feed("motor", (1, 1, 0, 0))
        device.feed("proximity", NEAR)
    device.feed("buttons", CENTER)
    device.run(BUDGET)
    assert device.variables.get("order") == (1, 2, 3)


def test_a_button_raises_its_event_when_it_changes_only():
    device = device_with("var n = 0\nonevent button.center\nn = n + 1")
    for words in (NO_BUTTON, CENTER, CENTER, CENTER, NO_BUTTON, NO_BUTTON):
        device.feed("buttons", words)
        device.run(BUDGET)
    assert device.variables.get("n") == (2,)


def test_a_button_that_is_held_while_a_program_is_loaded_raises_no_event_until_it_is_let_go():
    device = device_with("")
    device.feed("buttons", CENTER)
    device.load(
        load_program("var n = 0\nvar held\nonevent buttons\nheld = button.center\nonevent button.center\nn++", "a")
    )
    device.feed("buttons", CENTER)
    device.run(BUDGET)
    assert (device.variables.get("n"), device.variables.get("held")) == ((0,), (1,))
    device.feed("buttons", NO_BUTTON)
    device.run(BUDGET)
    assert device.variables.get("n") == (1,)


def test_indicators_show_values_written_to_variables_from_outside():
    device = device_with("")
    device.feed("temperature", (200,))
    device.advance(20_000_000)
    device.pop_commands()
    device.variables.set("temperature", (300,))
    device.advance(40_000_000)
    assert ShowOnLeds("temperature", (32, 0)) in device.pop_commands()


def test_natives_of_the_lights_become_commands_in_order():
    device = device_with("onevent prox\ncall leds.top(32, 0, 99)\ncall leds.prox.v(1, 2)\ncall leds.top(0, -1, 5)")
    device.feed("proximity", NEAR)
    device.run(BUDGET)
    assert device.pop_commands() == [
        SetLeds("top", (32, 0, 32)),
        SetLeds("ground", (1, 2)),
        SetLeds("top", (0, 32, 5)),
    ]
    assert device.variables.get("leds.top") == (0, -1, 5)


def test_lights_set_to_the_same_levels_again_cause_one_command():
    device = device_with(
        "onevent prox\ncall leds.top(1, 2, 3)\ncall leds.sound(4)\nonevent motor\nleds.top = [0, 0, 0]\n"
        "onevent tap\ncall _leds.set(30, 9)"
    )

    def reported(sensor, words):
        device.feed(sensor, words)
        device.run(BUDGET)
        return [command for command in device.pop_commands() if isinstance(command, SetLeds)]

    both = [SetLeds("top", (1, 2, 3)), SetLeds("microphone", (4,))]
    assert reported("proximity", NEAR) == both
    assert reported("proximity", NEAR) == []
    assert reported("motor", (0, 0, 0, 0)) == [SetLeds("top", (0, 0, 0))]
    assert reported("proximity", NEAR) == both[:1]
    reported("tap", (1,))
    assert reported("proximity", NEAR) == both


def test_the_same_reading_again_takes_back_what_the_program_wrote_over_it():
    device = device_with("onevent buttons\nprox.horizontal[2] = 7")
    device.feed("proximity", NEAR)
    device.feed("buttons", (0, 0, 0, 0, 0))
    device.run(BUDGET)
    assert device.variables.get("prox.horizontal")[2] == 7
    device.feed("proximity", NEAR)
    assert device.variables.get("prox.horizontal") == tuple(NEAR)


def test_variables_of_the_lights_work_like_their_natives():
    device = device_with("onevent prox\nleds.circle[3] = 20")
    device.feed("proximity", NEAR)
    device.run(BUDGET)
    assert device.pop_commands() == [SetLeds("circle", (0, 0, 0, 20, 0, 0, 0, 0))]


def test_timers_raise_their_events_in_simulated_time():
    device = device_with("var n[2]\ntimer.period = [100, 250]\nonevent timer0\nn[0]++\nonevent timer1\nn[1]++")
    for tick in range(6001):
        device.advance(tick * 10_000_000)
        device.run(BUDGET)
    assert device.variables.get("n") == (600, 240)


def test_a_timer_set_from_outside_runs_from_the_next_run_on():
    device = device_with("var n = 0\nonevent timer0\nn++")
    for now_ms, expected in ((0, 0), (10, 0), (109, 0), (110, 1)):
        device.advance(now_ms * 1_000_000)
        if now_ms == 10:
            device.variables.set("timer.period", (100, 0))
        device.run(BUDGET)
        assert device.variables.get("n") == (expected,)


def test_a_period_below_the_tick_loses_nothing():
    device = device_with("var n = 0\ntimer.period[0] = 3\nonevent timer0\nn++")
    for tick in range(31):
        device.advance(tick * 10_000_000)
        device.run(BUDGET)
    assert device.variables.get("n") == (100,)


def test_a_timer_set_by_a_sensor_s_event_counts_from_that_moment():
    device = device_with("var n = 0\nonevent prox\ntimer.period[0] = 25\nonevent timer0\nn++")
    for now_ms, expected in ((0, 0), (100, 0), (120, 0), (124, 0), (125, 1), (149, 1), (150, 2)):
        device.advance(now_ms * 1_000_000)
        if now_ms == 100:
            device.feed("proximity", NEAR)
        device.run(BUDGET)
        assert device.variables.get("n") == (expected,), now_ms


def test_timer_events_coalesce_while_a_handler_runs():
    device = device_with(
        "var i\nvar n = 0\ntimer.period[0] = 1\nonevent prox\nfor i in 1:500 do\nend\nonevent timer0\nn++"
    )
    device.advance(0)
    device.feed("proximity", NEAR)
    for now_ms in (0, 100, 200, 300):
        device.advance(now_ms * 1_000_000)
        device.run(100)
    assert device.is_busy
    while device.is_busy:
        device.run(BUDGET)
    assert device.variables.get("n") == (101,)


def test_emitted_events_are_taken_in_order():
    device = device_with(
        "onevent prox\nemit two [3, 4]\nemit none\nemit two prox.horizontal[1:2]", [("none", 0), ("two", 2)]
    )
    device.feed("proximity", NEAR)
    device.run(BUDGET)
    assert [(event.name, event.args) for event in device.pop_events()] == [
        ("two", (3, 4)),
        ("none", ()),
        ("two", (0, 4000)),
    ]
    assert device.pop_events() == []


def test_a_received_event_brings_source_and_arguments():
    device = device_with("var got[3]\nonevent two\ngot = [event.source, event.args[0:1]]", [("two", 2)])
    assert device.declares("two")
    assert not device.declares("three")
    device.receive_event("two", (7, -8), source=5)
    device.run(BUDGET)
    assert device.variables.get("got") == (5, 7, -8)
    with pytest.raises(KeyError):
        device.receive_event("three", ())


def test_events_that_arrive_together_are_all_handled():
    device = device_with("var sum = 0\nonevent add\nsum = sum * 10 + event.args[0]", [("add", 1)])
    for number in (1, 2, 3):
        device.receive_event("add", (number,))
    device.run(BUDGET)
    assert device.variables.get("sum") == (123,)


def test_a_handler_that_never_ends_is_ended_by_a_global_event():
    device = device_with(
        "var n = 0\nvar i\nonevent prox\nwhile n == 0 do\ni++\nend\nonevent rescue\nn = 1", [("rescue", 0)]
    )
    device.feed("proximity", NEAR)
    device.run(BUDGET)
    device.receive_event("rescue", ())
    device.run(BUDGET)
    assert device.variables.get("n") == (0,)
    device.run(2 * 65535)
    assert device.variables.get("n") == (1,)
    assert not device.is_busy


def test_events_beyond_what_can_wait_are_lost_with_a_notice():
    device = device_with("var n = 0\nonevent add\nn++", [("add", 0)])
    for _ in range(150):
        device.receive_event("add", ())
    device.run(BUDGET)
    assert device.variables.get("n") == (100,)
    assert device.notices.pop() == ["more events arrive than the program can handle: add is lost"]


def test_a_machine_that_does_not_run_ignores_events():
    device = device_with("var n = 0\nonevent add\nn++", [("add", 0)])
    device.run_control.stop()
    device.receive_event("add", ())
    device.run_control.resume()
    device.run(BUDGET)
    assert device.variables.get("n") == (0,)


def test_a_program_that_writes_a_button_raises_no_event_of_it():
    device = device_with("var n = 0\nonevent button.center\nn++\nbutton.center = 7")
    for _ in range(3):
        device.feed("buttons", CENTER)
        device.run(BUDGET)
    assert device.variables.get("n") == (1,)


def test_random_numbers_repeat_after_a_reset_and_differ_between_robots():
    program = load_program("var r[3]\ncall math.rand(r)", "random")
    numbers = []
    for node_id in (1, 1, 2):
        device = AsebaDevice(node_id=node_id)
        device.load(program)
        device.run(BUDGET)
        numbers.append(device.variables.get("r"))
    device.load(program)
    device.run(BUDGET)
    assert numbers[0] == numbers[1] != numbers[2] == device.variables.get("r")


@pytest.mark.parametrize(
    ("source", "event", "line", "fault"),
    [
        ("var a = 0\n\na = 5 / a", "init", 3, "division by zero"),
        ("var a = -4\nonevent prox\ncall math.sqrt(a, a)", "prox", 3, "square root of a negative number"),
        (
            "var t[2]\nvar i = 3\nonevent prox\ncallsub s\nsub s\nt[i] = 1",
            "prox",
            6,
            "index 3 is outside an array of 2",
        ),
    ],
)
def test_faults_name_event_line_and_reason(source, event, line, fault):
    device = device_with(source)
    device.feed("proximity", NEAR)
    device.run(BUDGET)
    assert device.status == DeviceStatus("fault", event, line, fault)


def test_a_fault_stops_machine_and_wheels_and_names_the_line():
    device = device_with("var t[2]\nvar i = 0\nmotor.left.target = 200\nonevent prox\ni = 5\nt[i] = 1")
    device.feed("proximity", NEAR)
    device.run(BUDGET)
    assert device.status == DeviceStatus("fault", "prox", 6, "index 5 is outside an array of 2")
    assert device.pop_commands() == [MotorTargets(0, 0)]
    device.feed("proximity", NEAR)
    assert not device.is_busy


@pytest.mark.parametrize(
    "end", [lambda device: device.run_control.stop(), lambda device: device.run(BUDGET)], ids=["stopped", "failed"]
)
def test_pending_events_are_dropped_when_a_program_ends(end):
    device = device_with("var n = 0\nvar zero = 0\nonevent button.center\nn = 1 / zero\nonevent prox\nn = 7")
    device.feed("buttons", CENTER)
    device.feed("proximity", NEAR)
    end(device)
    device.run_control.resume()
    device.run(BUDGET)
    assert (device.status.state, device.variables.get("n")) == ("running", (0,))


def test_a_paused_machine_accepts_events_between_handlers_only():
    device = device_with("var n = 0\nvar m = 0\nonevent prox\nm = 1\nm = 2\nonevent add\nn++", [("add", 0)])
    device.run_control.pause()
    for within, heard in ((False, 1), (True, 1), (False, 2)):
        if within:
            device.feed("proximity", NEAR)
            device.run_control.step()
            assert device.status.event == "prox"
        device.receive_event("add", ())
        device.run_control.resume()
        device.run(BUDGET)
        assert device.variables.get("n") == (heard,)
        device.run_control.pause()
    assert device.variables.get("m") == (2,)


def test_a_long_handler_goes_on_in_the_next_turn():
    device = device_with("var i\nvar n\nonevent prox\nn = 0\nfor i in 1:2000 do\nn = n + 1\nend")
    device.feed("proximity", NEAR)
    device.run(1000)
    assert device.is_busy
    assert 0 < device.variables.get("n")[0] < 2000
    turns = 0
    while device.is_busy:
        device.run(1000)
        turns += 1
    assert device.variables.get("n") == (2000,)
    assert turns > 10


def test_pause_step_and_resume():
    device = device_with("var n = 0\nonevent prox\nn = 1\nn = 2")
    device.run_control.pause()
    assert device.status.state == "paused"
    device.feed("proximity", NEAR)
    device.run(BUDGET)
    assert device.variables.get("n") == (0,)
    for _ in range(2):
        device.run_control.step()
    assert device.variables.get("n") == (1,)
    assert device.status == DeviceStatus("paused", "prox", 4)
    device.run_control.resume()
    device.run(BUDGET)
    assert device.variables.get("n") == (2,)
    assert device.status.state == "running"


def test_stop_halts_and_reset_begins_anew():
    device = device_with("var n = 5\nmotor.left.target = 100\nonevent prox\nn = n + 1")
    device.run_control.stop()
    assert device.pop_commands() == [MotorTargets(0, 0)]
    assert device.status.state == "stopped"
    device.variables.set("n", (40,))
    device.run_control.reset()
    device.run_control.resume()
    device.run(BUDGET)
    assert device.variables.get("n") == (5,)
    assert MotorTargets(100, 0) in device.pop_commands()


def test_variables_are_read_and_written_whole():
    device = device_with("var a[3] = [1, 2, 3]")
    assert device.variables.get("a") == (1, 2, 3)
    device.variables.set("a", (-32768, 0, 32767))
    assert device.variables.get("a") == (-32768, 0, 32767)
    with pytest.raises(ValueError, match="2 words found, expected 3"):
        device.variables.set("a", (1, 2))
    with pytest.raises(ValueError, match="40000"):
        device.variables.set("a", (1, 2, 40000))
    with pytest.raises(KeyError):
        device.variables.get("b")


def test_words_of_the_wrong_number_are_refused():
    with pytest.raises(ValueError, match="3 words found, expected 7"):
        AsebaDevice().feed("proximity", (1, 2, 3))


def test_without_a_card_files_cannot_be_opened_and_sounds_not_played():
    device = device_with("var status = 5\nonevent prox\ncall sound.play(1)\ncall sd.open(1, status)")
    for _ in range(2):
        device.feed("proximity", NEAR)
        device.run(BUDGET)
    assert device.notices.pop() == ["no card: p1.wav"]
    assert device.variables.get("status") == (-1,)


def test_a_device_is_due_for_events_and_for_changed_indicators():
    device = device_with("onevent prox\nmotor.left.target = 100")
    device.advance(1_000_000_000)
    assert not device.is_due
    assert device.due.ns > 10_000_000_000
    device.advance(1_010_000_000)
    device.feed("motor", (1, 2, 3, 4))
    assert not device.is_due
    device.feed("ground", GROUND)
    device.feed("proximity", NEAR)
    assert device.is_due
    device.run(BUDGET)
    assert device.is_due
    assert MotorTargets(100, 0) in device.pop_commands()
    assert not device.is_due
    assert device.due.ns == 1_020_000_000
    device.advance(1_200_000_000)
    assert device.is_due


def test_a_robot_that_switches_itself_off_is_dark_silent_and_deaf_to_its_variables():
    device = device_with("onevent button.center\nleds.top = [32, 0, 0]\ncall prox.comm.enable(1)\ncall _poweroff()")
    device.feed("buttons", CENTER)
    device.run(BUDGET)
    commands = device.pop_commands()
    assert commands.index(SetLeds("top", (32, 0, 0))) < commands.index(ReleaseLeds("top"))
    assert commands.index(EnableComm(True)) < commands.index(EnableComm(False))
    device.feed("temperature", (300,))
    device.advance(1_000_000_000)
    assert device.pop_commands() == []
    device.variables.set("motor.left.target", (300,))
    device.variables.set("leds.top", (0, 32, 0))
    assert device.pop_commands() == []
    device.run_control.resume()
    device.run(BUDGET)
    device.variables.set("leds.top", (0, 32, 0))
    assert SetLeds("top", (0, 32, 0)) in device.pop_commands()
