import pytest

from aseba_vm import NativeFault, NativeFunction, Parameter, TargetDescription, Variable, VirtualMachine, compile
from aseba_vm.machine import machine_messages
from aseba_vm.targets import THYMIO_II
from tests.aseba_vm.engines import AVAILABLE


def after(source, address=128, count=1, **options):
    """Return the words of the memory after the initialization."""
    machine = VirtualMachine(THYMIO_II, **options)
    machine.load(compile(source, THYMIO_II))
    machine.run()
    return machine.variables[address : address + count]


@pytest.mark.parametrize(
    ("source", "words"),
    [
        ("var d[3] call math.copy(d, [1, 2, 3])", [1, 2, 3]),
        ("var d[3] call math.fill(d, 7)", [7, 7, 7]),
        ("var d[2] call math.addscalar(d, [32767, 1], 1)", [-32768, 2]),
        ("var d[2] call math.sub(d, [-32768, 5], [1, 2])", [32767, 3]),
        ("var d[2] call math.mul(d, [300, -2], [300, 4])", [24464, -8]),
        ("var d[2] call math.div(d, [-7, 7], [2, -2])", [-3, -3]),
        ("var d[2] call math.min(d, [1, 5], [2, 4])", [1, 4]),
        ("var d[2] call math.max(d, [1, 5], [2, 4])", [2, 5]),
        ("var d[3] call math.clamp(d, [1, 5, 9], [2, 2, 8], [4, 4, 3])", [2, 4, 3]),
        ("var d call math.dot(d, [1000, 1000], [1000, 1000], 8)", [7812]),
        ("var d call math.dot(d, [1], [1], 33)", [0]),
        ("var d[3] call math.stat([3, -1, 7, 2], d[0], d[1], d[2])", [-1, 7, 2]),
        ("var d[2] call math.argbounds([3, -1, 7, -1, 7], d[0], d[1])", [1, 2]),
        ("var d[3] = [3, 1, 2] call math.sort(d)", [1, 2, 3]),
        ("var d call math.muldiv(d, 30000, 20000, 10000)", [-5536]),
        ("var d[2] call math.rot2(d, [1000, 0], 16384)", [0, 999]),
        ("var d call math.sqrt(d, 143)", [11]),
        ("var d[3] call math.rand(d)", [13849, -16794, 31223]),
    ],
)
def test_the_standard_functions(source, words):
    assert after(source, count=len(words)) == words


def test_results_are_stored_before_the_next_element_is_read():
    assert after("var d[4] = [1, 2, 3, 4] call math.copy(d[1:3], d[0:2])", count=4) == [1, 1, 1, 1]


def test_a_zero_divisor_ends_the_call_and_keeps_what_was_done():
    machine = VirtualMachine(THYMIO_II)
    machine.load(compile("var d[3] call math.div(d, [8, 8, 8], [2, 0, 4]) d[2] = 9", THYMIO_II))
    machine.run()
    assert machine.variables[128:131] == [4, 0, 0]
    assert isinstance(machine.fault, machine_messages.DivisionByZero)


def test_a_function_of_the_node_reads_and_writes_its_arguments():
    def double(call):
        call.write(1, [2 * word for word in call.read(0)])

    target = TargetDescription(
        "t",
        100,
        100,
        10,
        (Variable("a", 2), Variable("b", 2)),
        (),
        (NativeFunction("double", (Parameter("source", -1), Parameter("destination", -1))),),
    )
    machine = VirtualMachine(target, {"double": double})
    machine.load(compile("a = [3, 20000] call double(a, b)", target))
    machine.run()
    assert machine.variables[:4] == [3, 20000, 6, -25536]


@pytest.mark.parametrize("engine", AVAILABLE)
def test_a_standard_function_may_be_declared_with_other_sizes(engine):
    parameters = (Parameter("destination", 2), Parameter("source", 2))
    target = TargetDescription(
        "t", 100, 100, 10, (Variable("a", 2), Variable("b", 2)), (), (NativeFunction("math.copy", parameters),)
    )
    machine = VirtualMachine(target, engine=engine)
    machine.load(compile("a = [3, 20000] call math.copy(b, a)", target))
    machine.run()
    assert machine.variables[:4] == [3, 20000, 3, 20000]


def test_a_function_of_the_node_may_refuse():
    def refuse(call):
        raise NativeFault(f"no card: {call.value(0)}")

    machine = VirtualMachine(THYMIO_II, {"sound.play": refuse})
    machine.load(compile("call sound.play(5)", THYMIO_II))
    machine.run()
    assert machine.fault == machine_messages.NodeSpecific(5 + 1, "no card: 5")


def test_a_function_without_implementation_pops_its_arguments_and_is_reported():
    machine = VirtualMachine(THYMIO_II)
    machine.load(compile("call leds.top(1, 2, 3) acc[0] = 4", THYMIO_II))
    machine.run()
    call = next(message for message in machine.pop_messages() if isinstance(message, machine_messages.NativeCalled))
    assert call.name == "leds.top"
    assert [words for _, _, words in call.arguments] == [(1,), (2,), (3,)]
    assert machine.variables[THYMIO_II.addresses["acc"][0]] == 4
    assert machine.sp == -1


def test_a_standard_function_may_be_replaced():
    assert after("var d call math.rand(d)", natives={"math.rand": lambda call: call.write(0, [4])}) == [4]


@pytest.mark.parametrize(
    ("calls", "words"),
    [
        ("call deque.push_back(q, 5) call deque.push_back(q, 6)", [2, 0, 5, 6, 0]),
        ("call deque.push_front(q, 5) call deque.push_front(q, 6)", [2, 0, 6, 5, 0]),
        ("call deque.push_back(q, [5, 6, 7]) call deque.pop_front(q, d)", [2, 1, 5, 6, 7]),
        ("call deque.push_back(q, [5, 6, 7]) call deque.set(q, 9, 1)", [3, 0, 5, 9, 7]),
        ("call deque.push_back(q, [5, 6]) call deque.insert(q, 9, 1)", [3, 0, 5, 9, 6]),
        ("call deque.push_back(q, [5, 6, 7]) call deque.erase(q, 1, 1)", [2, 0, 5, 7, 7]),
    ],
)
def test_deques_are_rings_in_arrays(calls, words):
    assert after(f"var q[5] var d {calls}", count=5) == words


def test_a_failing_pop_reports_two_faults():
    machine = VirtualMachine(THYMIO_II)
    machine.load(compile("var q[5] var d call deque.pop_front(q, d)", THYMIO_II))
    machine.run()
    assert [type(message) for message in machine.pop_messages()][-2:] == [machine_messages.OutOfBounds] * 2


def test_a_deque_that_the_reference_never_finishes_is_a_fault():
    machine = VirtualMachine(THYMIO_II)
    machine.load(compile("var q[5] = [4, -1, 1, 2, 3] var d call deque.pop_front(q, d)", THYMIO_II))
    machine.run()
    assert isinstance(machine.fault, machine_messages.OutOfBounds)
