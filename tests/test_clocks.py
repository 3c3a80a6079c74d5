"""No clock in a verdict: only `tests/patience.py` compares clocks, and tests sleep only where sleep is what they test.

Every module of the tests is read as a syntax tree. Programs in strings are not: most of them run in simulated time.
"""

from __future__ import annotations

import ast
import re
import textwrap
from collections.abc import Iterator
from pathlib import Path

import pytest

TESTS = Path(__file__).parent
OWNER = "patience.py"
SLEEPS = {
    "data/student_nodes/turn_server.py": "a program of a student, which waits as tutorials do",
    "network/test_live_tools.py": "a window that does not report whether it is ready",
    "testing/ros/test_cpu_limit.py": "real time in which no processor time is used",
}
"""Modules that sleep outside of `patience.until`, and what for."""

CLOCKS = {"time", "time_ns", "monotonic", "monotonic_ns", "perf_counter", "perf_counter_ns"}
"""Functions of `time`; an event loop has a `time()`, too."""
DATES = {"now", "utcnow", "today"}
"""Methods of `datetime` and `date`."""
MENTIONS = re.compile(r"time\(|time_ns|monotonic|perf_counter|time import|now\(|utcnow|today|sleep")
"""Whatever a module that reads a clock or sleeps contains; the others need not be parsed."""
ARITHMETIC = {"abs", "float", "int", "max", "min", "round", "sum"}
"""Functions whose value is a clock reading if an argument is one."""


def _dotted(node: ast.AST) -> str:
    """The text of a name or of an attribute, such as `self.began_s`; empty for anything else."""
    if isinstance(node, ast.Name):
        return node.id
    if isinstance(node, ast.Attribute):
        return f"{base}.{node.attr}" if (base := _dotted(node.value)) else ""
    return ""


class _Clocks:
    """The names of one function, or of a module, that are clock readings, differences of them, or sums with them."""

    def __init__(self, known: set[str], readers: set[str]) -> None:
        self._names = set(known)
        self._readers = readers

    def add(self, tree: ast.AST) -> set[str]:
        """Find names bound from clock readings, also from those of other names; return all of them."""
        size = -1
        while size < len(self._names):
            size = len(self._names)
            for node in ast.walk(tree):
                for target, value in _bindings(node):
                    if self.is_read(value) and (name := _dotted(target)):
                        self._names.add(name)
        return self._names

    def is_read(self, node: ast.AST) -> bool:
        """Whether the value of an expression depends on a clock."""
        match node:
            case ast.Call(func=ast.Attribute(value=base, attr=name), args=arguments):
                if name in CLOCKS and not arguments:
                    return True
                if name in DATES and _dotted(base).split(".")[-1] in ("date", "datetime"):
                    return True
                return self.is_read(base)  # such as `(now - began).total_seconds()`
            case ast.Call(func=ast.Name(id=name), args=arguments):
                return name in self._readers or (name in ARITHMETIC and any(map(self.is_read, arguments)))
            case ast.Name() | ast.Attribute():
                return _dotted(node) in self._names
            case ast.BinOp(left=left, right=right):
                return self.is_read(left) or self.is_read(right)
            case ast.UnaryOp(operand=value) | ast.NamedExpr(value=value) | ast.Starred(value=value):
                return self.is_read(value)
            case ast.IfExp(body=first, orelse=second):
                return self.is_read(first) or self.is_read(second)
            case ast.Tuple(elts=items) | ast.List(elts=items):
                return any(map(self.is_read, items))
        return False


def _bindings(node: ast.AST) -> Iterator[tuple[ast.AST, ast.AST]]:
    """Targets and values of an assignment, one by one where both are tuples of one length."""
    match node:
        case ast.Assign(targets=targets, value=value):
            for target in targets:
                match target, value:
                    case ast.Tuple(elts=names), ast.Tuple(elts=values) if len(names) == len(values):
                        yield from zip(names, values, strict=True)
                    case _:
                        yield target, value
        case ast.AnnAssign(target=target, value=ast.expr() as value) | ast.NamedExpr(target=target, value=value):
            yield target, value
        case ast.AugAssign(target=target, value=value):
            yield target, value


def comparisons(tree: ast.Module) -> list[int]:
    """Lines that compare a clock reading, or something computed from one."""
    readers = {
        alias.asname or alias.name
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom) and node.module == "time"
        for alias in node.names
        if alias.name in CLOCKS
    }
    clocks = _Clocks(set(), readers)
    if not any(isinstance(node, ast.Call) and clocks.is_read(node) for node in ast.walk(tree)):
        return []
    readers |= {
        function.name
        for function in ast.walk(tree)
        if isinstance(function, ast.FunctionDef)
        for node in ast.walk(function)
        if isinstance(node, ast.Return) and node.value is not None and clocks.is_read(node.value)
    }
    statements, functions = _scopes(tree)
    shared = {name for name in clocks.add(tree) if "." in name}  # bound in another method
    shared = _Clocks(shared, readers).add(statements)
    found = set()
    for scope in (statements, *functions):
        clocks = _Clocks(shared, readers)
        clocks.add(scope)
        found |= {
            node.lineno
            for node in ast.walk(scope)
            if isinstance(node, ast.Compare) and any(map(clocks.is_read, (node.left, *node.comparators)))
        }
    return sorted(found)


def _scopes(tree: ast.Module) -> tuple[ast.Module, list[ast.AST]]:
    """The statements of a module and its classes, and their functions, each with those inside of it."""
    statements, functions, waiting = [], [], list(tree.body)
    for node in waiting:
        if isinstance(node, ast.ClassDef):
            waiting += node.body
        elif isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
            functions.append(node)
        else:
            statements.append(node)
    return ast.Module(statements, []), functions


def sleeps(tree: ast.Module) -> list[int]:
    """Lines that sleep; `asyncio.sleep(0)` does not."""
    return [
        node.lineno
        for node in ast.walk(tree)
        if isinstance(node, ast.Call)
        and _dotted(node.func) in ("time.sleep", "asyncio.sleep", "sleep")
        and not (node.args and isinstance(node.args[0], ast.Constant) and node.args[0].value == 0)
    ]


@pytest.fixture(scope="module")
def modules() -> dict[str, ast.Module]:
    """The syntax trees of the modules that mention a clock, except the owner of clocks, by their paths."""
    texts = {path.relative_to(TESTS).as_posix(): path.read_text(encoding="utf-8") for path in TESTS.rglob("*.py")}
    return {name: ast.parse(text) for name, text in sorted(texts.items()) if name != OWNER and MENTIONS.search(text)}


def test_no_verdict_depends_on_a_clock(modules: dict[str, ast.Module]) -> None:
    found = [f"{name}:{line}" for name, tree in modules.items() for line in comparisons(tree)]
    assert found == [], "expected `patience.until` or `patience.Deadline`, processor time, or counts"


def test_no_test_sleeps_instead_of_waiting_for_a_condition(modules: dict[str, ast.Module]) -> None:
    assert {name for name, tree in modules.items() if sleeps(tree)} == set(SLEEPS), "expected `patience.until`"


@pytest.mark.parametrize(
    "text",
    [
        "assert time.monotonic() - began < 3",
        "while time.monotonic() < end: pass",
        "if datetime.now() > end: pass",
        "if datetime.datetime.now(datetime.UTC) > end: pass",
        "began = time.monotonic()\nassert 3 > time.perf_counter() - began",
        "spent_s = time.monotonic() - began\nassert spent_s < 3",
        "end = time.time_ns() + 10**9\nlater = end\nassert now() <= later",
        "began, count = time.monotonic(), 0\nassert began < 5",
        "while (now_s := time.monotonic()) - first_s < 3: pass",
        "assert round(time.perf_counter() - began) == 0",
        "assert (datetime.now() - began).total_seconds() >= 0.2",
        "spent_s = 0.0\nspent_s += time.monotonic()\nassert not spent_s > 3",
        "times = [time.monotonic(), time.monotonic()]\nassert times < limits",
        "from time import monotonic as clock\ndef test():\n    began = clock()\n    assert clock() - began < 3",
        "def test():\n    end = time.monotonic() + 3\n    def ended():\n        return now > end\n    until(ended)",
        """
        class Wait:
            def __init__(self):
                self.end_s = time.monotonic() + 3

            def is_over(self):
                return now_s() > self.end_s
        """,
        "def spent_s():\n    return time.monotonic() - BEGAN_S\ndef test():\n    assert spent_s() < 3",
        "async def test():\n    end = loop.time() + 3\n    assert end > 3",
    ],
)
def test_a_comparison_of_clocks_is_refused(text: str) -> None:
    assert comparisons(ast.parse(textwrap.dedent(text)))


@pytest.mark.parametrize(
    "text",
    [
        "began_s = time.process_time()\nassert time.process_time() - began_s < 1",
        "assert time.thread_time() < limit_s",
        "device.advance(time.monotonic_ns())\nassert device.now == 3",
        "assert world.publish_if_due(time.monotonic_ns()) == 1",
        "assert robot.now_ns < 3",
        "assert message.time == 3",
        "began = time.monotonic()\nprint(time.monotonic() - began)",
        "def first():\n    end = time.monotonic()\ndef second():\n    end = 3\n    assert end < 4",
        "monkeypatch.setattr(module, 'time', SimpleNamespace(monotonic=lambda: now))\nassert now > 3",
        "deadline = Deadline()\nassert not deadline.is_over",
    ],
)
def test_processor_time_simulated_time_and_readings_that_are_not_compared_are_accepted(text: str) -> None:
    assert comparisons(ast.parse(text)) == []


def test_sleeps_are_found() -> None:
    assert sleeps(
        ast.parse("time.sleep(0.1)\nawait asyncio.sleep(pause_s)\nawait asyncio.sleep(0)\nturns.sleep(3)")
    ) == [1, 2]
