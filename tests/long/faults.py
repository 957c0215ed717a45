"""Small faults in a source, one at a time: what mutation testing puts in.

A comparison that takes its border in or leaves it out, or is turned round; an operator for its
opposite; ``and`` for ``or``; a ``not`` or a minus left out; a number one larger; a condition turned
round; a call left out; ``break`` for ``continue``. Annotations, decorators, texts and what is
logged stay as they are.
"""

from __future__ import annotations

import ast
import copy
import hashlib
from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path

_COMPARED = {
    ast.Lt: ast.LtE, ast.LtE: ast.Lt, ast.Gt: ast.GtE, ast.GtE: ast.Gt, ast.Eq: ast.NotEq,
    ast.NotEq: ast.Eq, ast.Is: ast.IsNot, ast.IsNot: ast.Is, ast.In: ast.NotIn, ast.NotIn: ast.In,
}  # fmt: skip
_TURNED = {ast.Lt: ast.GtE, ast.LtE: ast.Gt, ast.Gt: ast.LtE, ast.GtE: ast.Lt}
_OPERATORS = {
    ast.Add: ast.Sub, ast.Sub: ast.Add, ast.Mult: ast.Div, ast.Div: ast.Mult,
    ast.FloorDiv: ast.Mult, ast.Mod: ast.Mult, ast.Pow: ast.Mult, ast.BitAnd: ast.BitOr,
    ast.BitOr: ast.BitAnd, ast.BitXor: ast.BitOr, ast.LShift: ast.RShift, ast.RShift: ast.LShift,
}  # fmt: skip
_BOTH = {ast.And: ast.Or, ast.Or: ast.And}

Change = Callable[[ast.AST], ast.AST]


@dataclass(frozen=True)
class Fault:
    """A fault at one place of a file.

    Attributes
    ----------
    number : int
        Of the file's faults, in the order of `faults_of`.
    key : str
        Tells it from all others, as long as the function that it lies in stays as it is.
    lines : tuple of (first, last)
        Of what is changed.
    """

    path: str
    number: int
    key: str
    lines: tuple[int, int]
    what: str


def faults_of(path: Path, root: Path) -> list[Fault]:
    """Return all faults that can be put into a file, one for each place and way."""
    tree = ast.parse(path.read_bytes())
    name = str(path.relative_to(root))
    faults: list[Fault] = []
    met: Counter[str] = Counter()
    for part in _parts(tree):
        digest = hashlib.blake2b(ast.dump(part).encode(), digest_size=5).hexdigest()
        met[digest] += 1  # a part may stand twice
        for k, (node, what, _) in enumerate(_changes(part)):
            lines = (node.lineno, node.end_lineno or node.lineno)  # type: ignore[attr-defined]
            key = f"{name}:{digest}.{met[digest]}.{k}"
            faults.append(Fault(name, len(faults), key, lines, what))
    return faults


def _parts(tree: ast.Module) -> Iterator[ast.AST]:
    """Return what a file consists of: functions, methods, and what stands beside them."""
    for node in tree.body:
        yield from node.body if isinstance(node, ast.ClassDef) else [node]


def with_fault(path: Path, number: int) -> ast.Module:
    """Return a file's tree with one of its faults in it."""
    tree = ast.parse(path.read_bytes())
    node, _, change = [one for part in _parts(tree) for one in _changes(part)][number]
    changed: ast.Module = _Put(node, change(copy.deepcopy(node))).visit(tree)
    return ast.fix_missing_locations(changed)


class _Put(ast.NodeTransformer):
    def __init__(self, old: ast.AST, new: ast.AST) -> None:
        self._old, self._new = old, new

    def visit(self, node: ast.AST) -> ast.AST:
        if node is self._old:
            return ast.copy_location(self._new, node)
        return self.generic_visit(node)


def _changes(node: ast.AST) -> Iterator[tuple[ast.AST, str, Change]]:
    """Name every fault of a tree: where, what it is, and how it is put in."""
    if _is_left_alone(node):
        return
    for what, change in _of_node(node):
        yield node, what, change
    for name, value in ast.iter_fields(node):
        if name in ("annotation", "returns", "decorator_list", "bases"):
            continue
        for child in value if isinstance(value, list) else [value]:
            if isinstance(child, ast.AST):
                yield from _changes(child)


def _is_left_alone(node: ast.AST) -> bool:
    if isinstance(node, ast.If) and isinstance(node.test, ast.Name):
        return node.test.id == "TYPE_CHECKING"
    if isinstance(node, ast.Expr) and isinstance(node.value, ast.Call):
        function = node.value.func
        if isinstance(function, ast.Attribute) and isinstance(function.value, ast.Name):
            return function.value.id == "_log"
    is_type = isinstance(node, ast.Assign) and isinstance(node.value, ast.BinOp | ast.Subscript)
    return is_type and _is_of_types(node.value)  # type: ignore[attr-defined]


def _is_of_types(value: ast.AST) -> bool:
    """Return whether a value is made of types, as in ``A = B[int] | None``."""
    if isinstance(value, ast.BinOp):
        return isinstance(value.op, ast.BitOr) and _is_of_types(value.left)
    return isinstance(value, ast.Subscript) and ast.unparse(value.value) in (
        "NDArray", "dict", "tuple", "list", "set", "Mapping", "Callable", "Literal", "Sequence",
    )  # fmt: skip


def _of_node(node: ast.AST) -> Iterator[tuple[str, Change]]:
    match node:
        case ast.Compare():
            for i, op in enumerate(node.ops):
                for table in (_COMPARED, _TURNED):
                    if type(op) in table:
                        new = table[type(op)]
                        yield f"{_name(op)} for {_name(new())}", _with_op(i, new)
        case ast.BinOp(op=op) | ast.AugAssign(op=op) if type(op) in _OPERATORS:
            new = _OPERATORS[type(op)]
            yield f"{_name(op)} for {_name(new())}", _with(op=new())
        case ast.BoolOp(op=op):
            yield f"{_name(op)} for {_name(_BOTH[type(op)]())}", _with(op=_BOTH[type(op)]())
        case ast.UnaryOp(op=ast.Not() | ast.USub() | ast.Invert()):
            yield f"without {_name(node.op)}", lambda n: n.operand  # type: ignore[attr-defined]
        case ast.Constant(value=bool() as value):
            yield f"{value} for {not value}", _with(value=not value)
        case ast.Constant(value=int() | float() as number):
            yield f"{number} for {number + 1}", _with(value=number + 1)
        case ast.Expr(value=ast.Call()):
            yield "call left out", lambda n: ast.Pass()
        case ast.Break():
            yield "break for continue", lambda n: ast.Continue()
        case ast.Continue():
            yield "continue for break", lambda n: ast.Break()
        case ast.If() | ast.While() | ast.IfExp() if not isinstance(
            node.test, ast.Compare | ast.BoolOp | ast.UnaryOp | ast.Constant
        ):
            yield "condition turned round", _turned_round


def _turned_round(node: ast.AST) -> ast.AST:
    test: ast.expr = node.test  # type: ignore[attr-defined]
    node.test = ast.UnaryOp(ast.Not(), test)  # type: ignore[attr-defined]
    return node


def _with(**fields: object) -> Change:
    def change(node: ast.AST) -> ast.AST:
        for name, value in fields.items():
            setattr(node, name, value)
        return node

    return change


def _with_op(i: int, new: type[ast.cmpop]) -> Change:
    def change(node: ast.AST) -> ast.AST:
        node.ops[i] = new()  # type: ignore[attr-defined]
        return node

    return change


def _name(op: ast.AST) -> str:
    return type(op).__name__
