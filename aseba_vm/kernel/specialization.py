"""Kernels for given arguments: parameters become constants, and short loops over constant ranges are unrolled."""

from __future__ import annotations

import ast
import operator
from collections.abc import Mapping
from copy import deepcopy

from aseba_vm.kernel.integers import wrap32

__all__ = ["MAX_ITERATIONS", "specialize"]

MAX_ITERATIONS = 32
"""Largest number of iterations of a loop that is unrolled."""

_OPERATORS = {ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul}


class _SpecializationError(Exception):
    """A kernel has other loops, or changes a parameter."""


def specialize(kernel: ast.FunctionDef, arguments: Mapping[str, int]) -> list[ast.stmt] | None:
    """The body of a kernel for the arguments by name; None if it has other loops or changes a parameter."""
    try:
        return _Specializer(arguments).block(kernel.body)
    except _SpecializationError:
        return None


class _Specializer(ast.NodeTransformer):
    """Replaces known names by their values, and computes expressions that are constant then."""

    def __init__(self, known: Mapping[str, int]) -> None:
        self._known = dict(known)

    def block(self, body: list[ast.stmt]) -> list[ast.stmt]:
        """A new list of statements; the given ones stay as they are."""
        statements: list[ast.stmt] = []
        for statement in body:
            made = self.visit(deepcopy(statement))
            statements += made if isinstance(made, list) else [made]
        return statements

    def visit_Name(self, node: ast.Name) -> ast.expr:
        """A known name is a constant."""
        if node.id not in self._known:
            return node
        if not isinstance(node.ctx, ast.Load):
            raise _SpecializationError
        return ast.copy_location(ast.Constant(self._known[node.id]), node)

    def visit_BinOp(self, node: ast.BinOp) -> ast.expr:
        """Sums and products of constants are constants."""
        self.generic_visit(node)
        match node.left, type(node.op), node.right:
            case ast.Constant(value=int() as left), kind, ast.Constant(value=int() as right) if kind in _OPERATORS:
                return ast.copy_location(ast.Constant(wrap32(_OPERATORS[kind](left, right))), node)
        return node

    def visit_While(self, _node: ast.While) -> ast.stmt:
        """Refuse: such a loop is worth a function of its own."""
        raise _SpecializationError

    def visit_Break(self, _node: ast.Break) -> ast.stmt:
        """Refuse: a loop that ends early cannot be unrolled."""
        raise _SpecializationError

    def visit_Continue(self, _node: ast.Continue) -> ast.stmt:
        """Refuse: a loop that skips the rest of an iteration cannot be unrolled."""
        raise _SpecializationError

    def visit_For(self, node: ast.For) -> ast.stmt | list[ast.stmt]:
        """The iterations one after the other; the loop if there are too many."""
        if not isinstance(node.target, ast.Name) or not isinstance(node.iter, ast.Call):
            raise _SpecializationError
        node.iter.args = [self.visit(limit) for limit in node.iter.args]
        limits = [
            limit.value for limit in node.iter.args if isinstance(limit, ast.Constant) and isinstance(limit.value, int)
        ]
        if len(limits) < len(node.iter.args) or len(range(*limits)) > MAX_ITERATIONS:
            node.body = self.block(node.body)
            return node
        statements: list[ast.stmt] = []
        for number in range(*limits):
            self._known[node.target.id] = number
            statements += self.block(node.body)
        self._known.pop(node.target.id, None)
        return statements
