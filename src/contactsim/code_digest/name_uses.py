"""Collect how a module uses names: what each scope binds, what is called and with which keywords."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from typing import Any, TypeGuard

FUNCTIONS = (ast.FunctionDef, ast.AsyncFunctionDef)
COMPREHENSIONS = (ast.ListComp, ast.SetComp, ast.DictComp, ast.GeneratorExp)
CAPTURES = (ast.ExceptHandler, ast.MatchAs, ast.MatchStar, ast.MatchMapping)
BINDING = {
    *(*FUNCTIONS, ast.ClassDef, ast.Lambda, *COMPREHENSIONS),
    *(ast.Import, ast.ImportFrom, ast.Global, ast.Nonlocal, ast.NamedExpr, *CAPTURES),
}
"""Nodes that bind names or open a scope."""
NAME_READERS = {
    *("locals", "globals", "vars", "dir", "eval", "exec", "query"),
    *("currentframe", "_getframe", "f_locals", "getsource", "co_varnames"),
}
"""Names and attributes that may read variables by their name, also in a text: `DataFrame.query("x < @limit")`."""
FIELDS = {
    kind: tuple(field for field in kind._fields if field not in ("ctx", "kind", "type_comment", "type_ignores"))
    for kind in vars(ast).values()
    if isinstance(kind, type) and issubclass(kind, ast.AST)
}
"""Fields of each kind of node that say what it computes."""
GLOBAL, NONLOCAL = "<global>", "<nonlocal>"
Scope = dict[str, str | None]
"""What the names of a scope stand for; None for a variable that was not met yet."""


class ScopeNames:
    """Names that a scope binds: variables, which may be renamed, and fixed ones: functions, classes and imports.

    function: where `:=` binds in the scope, which is another one for a comprehension.
    """

    __slots__ = ("elsewhere", "fixed", "function", "variables")

    def __init__(self, function: ScopeNames | None = None) -> None:
        self.variables: set[str | None] = set()
        self.fixed: set[str] = set()
        self.elsewhere: dict[str, str] = {}
        self.function: ScopeNames = function or self

    def scope(self, renamed: bool) -> Scope:
        """Return what each name stands for at first; renamed: variables stand for nothing yet."""
        names: Scope = {name: None if renamed else name for name in self.variables if name is not None}
        names |= {name: name for name in self.fixed} | self.elsewhere
        return {name: kind for name, kind in names.items() if kind != NONLOCAL}


class NameUses:
    """Uses of names in a module.

    names: those bound, by the node of a scope; loads: how often each name is read; calls: how often it is called;
    keywords: of those calls; attributes: names after a dot; renamed: True unless local variables may be read by name.
    """

    def __init__(self, tree: ast.Module) -> None:
        self.names: dict[ast.AST, ScopeNames] = {tree: ScopeNames()}
        self.loads: dict[str, int] = {}
        self.calls: dict[str, int] = {}
        self.keywords: dict[str, set[str | None]] = {}
        self.attributes: set[str] = set()
        self.top = set(top_imports(tree))
        waiting: list[tuple[ast.AST, ScopeNames]] = [(tree, self.names[tree])]
        while waiting:
            self._look(*waiting.pop(), waiting)
        self.renamed = NAME_READERS.isdisjoint(self.attributes) and NAME_READERS.isdisjoint(self.loads)

    def _look(self, node: Any, names: ScopeNames, waiting: list[tuple[ast.AST, ScopeNames]]) -> None:
        """Note what a node itself does with names, and put its parts on the list with the scope that they are in."""
        kind = node.__class__
        if kind is ast.Name:
            if node.ctx.__class__ is ast.Load:
                self.loads[node.id] = self.loads.get(node.id, 0) + 1
            else:
                names.variables.add(node.id)
            return
        if kind is ast.Constant:
            return
        if kind is ast.Attribute:
            self.attributes.add(node.attr)
        elif kind is ast.Call:
            if node.func.__class__ is ast.Name:
                name = node.func.id
                self.calls[name] = self.calls.get(name, 0) + 1
                if node.keywords:
                    self.keywords.setdefault(name, set()).update(part.arg for part in node.keywords)
        elif kind in BINDING:
            names = self._bind(node, names, waiting)
        for field in FIELDS[kind]:
            value = getattr(node, field)
            if value.__class__ is list:
                waiting.extend([(part, names) for part in value if isinstance(part, ast.AST)])
            elif isinstance(value, ast.AST):
                waiting.append((value, names))

    def _bind(self, node: Any, names: ScopeNames, waiting: list[tuple[ast.AST, ScopeNames]]) -> ScopeNames:
        """Note the names that a node binds; return the scope of its parts."""
        kind = node.__class__
        if kind in (ast.Import, ast.ImportFrom):
            if node not in self.top:
                names.fixed.update(name for name, _, _ in imported_names(node))
        elif kind in (ast.Global, ast.Nonlocal):
            names.elsewhere.update(dict.fromkeys(node.names, GLOBAL if kind is ast.Global else NONLOCAL))
        elif kind is ast.NamedExpr:
            names.function.variables.add(node.target.id)
        elif kind in CAPTURES:
            names.variables.add(node.rest if kind is ast.MatchMapping else node.name)
        else:
            if kind not in (ast.Lambda, *COMPREHENSIONS):
                names.fixed.add(node.name)
            names = self.names[node] = ScopeNames(names.function if kind in COMPREHENSIONS else None)
        return names

    def keywords_of(self, name: str) -> set[str | None] | None:
        """Return the keywords that a function is called with, None if it is used but by calls or with `**`."""
        keywords = self.keywords.get(name, set())
        called = self.loads.get(name, 0) == self.calls.get(name, 0) and name not in self.attributes
        return keywords if called and None not in keywords else None


def parameters_of(node: ast.arguments) -> list[ast.arg]:
    """Return all parameters of a function."""
    rest = [part for part in (node.vararg, node.kwarg) if part is not None]
    return [*node.posonlyargs, *node.args, *node.kwonlyargs, *rest]


def is_type_checking(node: ast.stmt) -> TypeGuard[ast.If]:
    """Return True for `if TYPE_CHECKING:`."""
    if not isinstance(node, ast.If) or node.orelse:
        return False
    return "TYPE_CHECKING" in (getattr(node.test, "id", None), getattr(node.test, "attr", None))


def top_imports(tree: ast.Module) -> Iterator[ast.Import | ast.ImportFrom]:
    """Yield the imports at the top of a module, also those for types alone."""
    for statement in tree.body:
        for part in statement.body if is_type_checking(statement) else [statement]:
            if isinstance(part, (ast.Import, ast.ImportFrom)):
                yield part


def imported_names(node: ast.Import | ast.ImportFrom) -> Iterator[tuple[str, str, set[str]]]:
    """Yield each name that an import binds, what it names, and the dotted names that may be modules."""
    for alias in node.names:
        if isinstance(node, ast.Import):
            name = alias.asname or alias.name.partition(".")[0]
            yield name, alias.name if alias.asname else name, {alias.name}
        else:
            module = "." * node.level + (node.module or "")
            yield alias.asname or alias.name, f"{module}.{alias.name}", {module, f"{module}.{alias.name}"}
