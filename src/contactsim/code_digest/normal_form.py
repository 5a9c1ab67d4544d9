"""Read the source of a module as what it computes.

The text of a module says more than it computes. Its normal form is its syntax tree without what cannot change a result:
comments, layout, docstrings, annotations of functions, imports that nothing uses, and the names of local variables.
"""

from __future__ import annotations

import ast
import gc
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

from contactsim.code_digest.name_uses import (
    COMPREHENSIONS,
    FIELDS,
    GLOBAL,
    NameUses,
    Scope,
    imported_names,
    is_type_checking,
    parameters_of,
    top_imports,
)

Scopes = tuple[Scope, ...]
_CLASS = "<class>"


@dataclass(frozen=True)
class SourceCode:
    """The source of a module in its normal form.

    Parameters
    ----------
    normal_form
        Text that two sources share if they compute the same by the rules of this module; empty if there is no code.
    imports
        Dotted names of all that the module imports: modules, and members that may be modules.
    used_imports
        The part of them that is used by code, and not by annotations of functions alone.
    import_targets
        Dotted names behind each name that an import at the top of the module binds: others may import it from here.
    docstrings
        All docstrings, in order.
    reads_docstrings
        True if the module reads a docstring, so that docstrings may enter its results.
    """

    normal_form: str
    imports: frozenset[str]
    used_imports: frozenset[str]
    import_targets: dict[str, set[str]]
    docstrings: tuple[str, ...]
    reads_docstrings: bool


def read_source(text: str) -> SourceCode:
    """Return the normal form of a module's source.

    Parameters
    ----------
    text
        Source of the module.

    Notes
    -----
    Names that code outside a function can see are kept: globals, functions, classes, members, attributes, keywords of
    calls, and parameters. Parameters of a private function of the module, or of a function within a function, are
    renamed like local variables if the function is only called, and by position; so no module may import a private
    function of another. In a module that may read variables by name (`NAME_READERS`) all names stay.

    Annotations in classes are kept, since dataclasses make fields of them; those of functions are not, except where a
    decorator dispatches on them. A name that is imported stands for what it names, so aliases and order do not matter.
    Importing a module of this package must do nothing but define names.
    """
    collecting = gc.isenabled()
    gc.disable()  # a syntax tree has no cycles, and the collector would look through it again and again
    try:
        tree = ast.parse(text)
        return _Normaliser(tree).source_code(tree)
    finally:
        if collecting:
            gc.enable()


class _Normaliser:
    """Writes the normal form of a module, part by part."""

    def __init__(self, tree: ast.Module) -> None:
        self.parts: list[str] = []
        self.docstrings: list[str] = []
        self.count = 0
        self.imports: set[str] = set()
        self.used_imports: set[str] = set()
        self.uses = NameUses(tree)
        self.module: Scope = {}
        self.import_targets: dict[str, set[str]] = {}
        self._bind_imports(tree)

    def source_code(self, tree: ast.Module) -> SourceCode:
        """Return the normal form of the whole module."""
        self._body(tree, (self.module,))
        names = self.uses.attributes | self.uses.loads.keys()
        return SourceCode(
            "".join(self.parts),
            frozenset(self.imports),
            frozenset(self.used_imports),
            self.import_targets,
            tuple(self.docstrings),
            "__doc__" in names or "getdoc" in names,
        )

    def _bind_imports(self, tree: ast.Module) -> None:
        """Let names that only an import at the top of the module binds stand for what they name."""
        others = set(self.uses.names[tree].scope(renamed=False))
        first: dict[str, str] = {}
        for statement in top_imports(tree):
            for name, target, modules in imported_names(statement):
                if name in first and first[name] != target:
                    others.add(name)
                first.setdefault(name, target)
                self.import_targets.setdefault(name, set()).update(modules)
        self.module = {name: f"@{target}" for name, target in first.items() if name not in others}

    def write(self, node: ast.AST, scopes: Scopes) -> None:
        """Write the normal form of a node; scopes: from the module to the innermost."""
        special = _SPECIAL.get(node.__class__)
        if special is not None:
            special(self, node, scopes)
            return
        parts = self.parts
        parts.append(node.__class__.__name__)
        parts.append("(")
        for field in FIELDS[node.__class__]:
            value = getattr(node, field)
            if value.__class__ is list:
                self._list(value, scopes)
            elif isinstance(value, ast.AST):
                self.write(value, scopes)
            else:
                parts.append(repr(value))
            parts.append(",")
        parts.append(")")

    def _list(self, values: Iterable[object], scopes: Scopes) -> None:
        """Write the nodes and values of a list."""
        self.parts.append("[")
        for value in values:
            before = len(self.parts)
            if isinstance(value, ast.AST):
                self.write(value, scopes)
            else:
                self.parts.append(repr(value))
            if len(self.parts) > before:
                self.parts.append(";")
        self.parts.append("]")

    def _name(self, name: str, scopes: Scopes) -> str:
        """Return what a name stands for where it is used."""
        for depth in range(len(scopes) - 1, 0, -1):
            scope = scopes[depth]
            if name in scope and not (_CLASS in scope and depth < len(scopes) - 1):
                meaning = scope[name]
                if meaning == GLOBAL:
                    break
                if meaning is None:
                    meaning = scope[name] = f"%{self.count}"
                    self.count += 1
                return meaning
        if name in self.import_targets:
            self.used_imports |= self.import_targets[name]
        return self.module.get(name) or name

    def _body(self, node: ast.Module | ast.ClassDef | ast.FunctionDef, scopes: Scopes) -> None:
        """Write the statements of a module, class or function, without its docstring."""
        docstring = ast.get_docstring(node, clean=False)
        if docstring is not None:
            self.docstrings.append(docstring)
        for statement in node.body:
            if isinstance(node, ast.Module) and self._is_bound_import(statement):
                continue
            self.write(statement, scopes)

    def _is_bound_import(self, statement: ast.stmt) -> bool:
        """Return True for an import at the top of the module whose names all stand for what they name."""
        if isinstance(statement, (ast.Import, ast.ImportFrom)):
            self._note_imports(statement)
            if isinstance(statement, ast.ImportFrom) and statement.module == "__future__":
                return True
            return all(name in self.module for name, _, _ in imported_names(statement))
        return False

    def _note_imports(self, statement: ast.Import | ast.ImportFrom) -> set[str]:
        """Add the modules of an import to those of the module; return them."""
        modules = {module for _, _, names in imported_names(statement) for module in names}
        self.imports |= modules
        return modules

    def write_name(self, node: ast.Name, scopes: Scopes) -> None:
        """Write what a name stands for."""
        self.parts.append(self._name(node.id, scopes))

    def write_constant(self, node: ast.Constant, scopes: Scopes) -> None:
        """Write a constant by its value."""
        self.parts.append(repr(node.value))

    def write_expression(self, node: ast.Expr, scopes: Scopes) -> None:
        """Write an expression that is a statement; a text on its own does nothing."""
        if not isinstance(node.value, ast.Constant):
            self.parts.append("Expr(")
            self.write(node.value, scopes)
            self.parts.append(")")

    def write_nothing(self, node: ast.AST, scopes: Scopes) -> None:
        """Write nothing: the node does nothing."""

    def write_import(self, node: ast.Import | ast.ImportFrom, scopes: Scopes) -> None:
        """Write an import as it is."""
        self.used_imports |= self._note_imports(node)
        self.parts.append(ast.dump(node))

    def write_if(self, node: ast.If, scopes: Scopes) -> None:
        """Write a condition; imports for type checking alone are noted only."""
        if is_type_checking(node):
            for statement in node.body:
                if isinstance(statement, (ast.Import, ast.ImportFrom)):
                    self._note_imports(statement)
            return
        self.parts.append("If(")
        self.write(node.test, scopes)
        self._list(node.body, scopes)
        self._list(node.orelse, scopes)
        self.parts.append(")")

    def write_annotated(self, node: ast.AnnAssign, scopes: Scopes) -> None:
        """Write an annotated assignment: as one without, but in a class, where the annotation may make a field."""
        in_class = _CLASS in scopes[-1]
        if node.value is None and not in_class:
            return
        self.parts.append("Field(" if in_class else "Assign([")
        self.write(node.target, scopes)
        self.parts.append(";")
        if in_class:
            self._annotation(node.annotation, scopes)
            self.parts.append(",")
        else:
            self.parts.append("],")
        if node.value is not None:
            self.write(node.value, scopes)
        self.parts.append(",)")

    def _annotation(self, node: ast.expr, scopes: Scopes) -> None:
        """Write an annotation of a class, also one that is a text."""
        text = node.value if isinstance(node, ast.Constant) else None
        self.write(ast.parse(text, mode="eval").body if isinstance(text, str) else node, scopes)

    def write_function(self, node: ast.FunctionDef, scopes: Scopes) -> None:
        """Write a function without annotations, its local names by number."""
        self.parts.append(f"{node.__class__.__name__}({node.name},")
        self._list(node.decorator_list, scopes)
        typed = any(isinstance(part, ast.Attribute) and part.attr == "register" for part in node.decorator_list)
        if typed:
            self._list([part.annotation for part in parameters_of(node.args)], scopes)
        within = _CLASS not in scopes[-1] and (len(scopes) > 1 or node.name.startswith("_")) and not node.decorator_list
        keywords = self.uses.keywords_of(node.name) if within else None
        scope = self.uses.names[node].scope(self.uses.renamed)
        for part in parameters_of(node.args):
            free = keywords is not None and part.arg not in keywords and self.uses.renamed
            scope[part.arg] = None if free else part.arg
        inner = (*scopes, scope)
        self._arguments(node.args, scopes, inner)
        self._body(node, inner)
        self.parts.append(")")

    def write_lambda(self, node: ast.Lambda, scopes: Scopes) -> None:
        """Write a function without a name, its local names by number."""
        parameters: Scope = {part.arg: part.arg for part in parameters_of(node.args)}
        inner = (*scopes, self.uses.names[node].scope(self.uses.renamed) | parameters)
        self.parts.append("Lambda(")
        self._arguments(node.args, scopes, inner)
        self.write(node.body, inner)
        self.parts.append(")")

    def _arguments(self, node: ast.arguments, outer: Scopes, inner: Scopes) -> None:
        """Write the parameters of a function and their defaults."""
        for kind in ("posonlyargs", "args", "kwonlyargs"):
            self.parts.append(f"{[self._name(part.arg, inner) for part in getattr(node, kind)]}")
        for part in (node.vararg, node.kwarg):
            self.parts.append(f"*{self._name(part.arg, inner)}," if part else "*,")
        self._list(node.defaults, outer)
        self._list(node.kw_defaults, outer)

    def write_class(self, node: ast.ClassDef, scopes: Scopes) -> None:
        """Write a class with its annotations, which may make fields."""
        self.parts.append(f"ClassDef({node.name},")
        for values in (node.decorator_list, node.bases, node.keywords):
            self._list(values, scopes)
        scope = self.uses.names[node].scope(renamed=False) | {_CLASS: ""}
        self._body(node, (*scopes, scope))
        self.parts.append(")")

    def write_comprehension(self, node: ast.ListComp, scopes: Scopes) -> None:
        """Write a comprehension, its own names by number."""
        inner = (*scopes, self.uses.names[node].scope(self.uses.renamed))
        self.parts.append(f"{node.__class__.__name__}(")
        for place, item in enumerate(node.generators):
            self.parts.append(f"for {item.is_async} ")
            self.write(item.iter, inner if place else scopes)
            self.write(item.target, inner)
            self._list(item.ifs, inner)
        for field in ("key", "value", "elt"):
            if hasattr(node, field):
                self.write(getattr(node, field), inner)
                self.parts.append(",")
        self.parts.append(")")

    def write_handler(self, node: ast.ExceptHandler, scopes: Scopes) -> None:
        """Write a handler of exceptions."""
        self.parts.append("Except(")
        self._list([node.type], scopes)
        self.parts.append(f"{self._name(node.name, scopes) if node.name else None},")
        self._list(node.body, scopes)
        self.parts.append(")")

    def write_capture(self, node: ast.MatchAs | ast.MatchStar, scopes: Scopes) -> None:
        """Write a pattern that binds a name."""
        self.parts.append(f"{node.__class__.__name__}({self._name(node.name, scopes) if node.name else None},")
        self._list([getattr(node, "pattern", None)], scopes)
        self.parts.append(")")

    def write_mapping(self, node: ast.MatchMapping, scopes: Scopes) -> None:
        """Write a pattern of a mapping."""
        self.parts.append(f"MatchMapping({self._name(node.rest, scopes) if node.rest else None},")
        self._list(node.keys, scopes)
        self._list(node.patterns, scopes)
        self.parts.append(")")


_SPECIAL: dict[type, Callable[[_Normaliser, Any, Scopes], None]] = {
    ast.Name: _Normaliser.write_name,
    ast.Constant: _Normaliser.write_constant,
    ast.Expr: _Normaliser.write_expression,
    ast.Pass: _Normaliser.write_nothing,
    ast.Nonlocal: _Normaliser.write_nothing,
    ast.Import: _Normaliser.write_import,
    ast.ImportFrom: _Normaliser.write_import,
    ast.If: _Normaliser.write_if,
    ast.AnnAssign: _Normaliser.write_annotated,
    ast.FunctionDef: _Normaliser.write_function,
    ast.AsyncFunctionDef: _Normaliser.write_function,
    ast.Lambda: _Normaliser.write_lambda,
    ast.ClassDef: _Normaliser.write_class,
    **dict.fromkeys(COMPREHENSIONS, _Normaliser.write_comprehension),
    ast.ExceptHandler: _Normaliser.write_handler,
    ast.MatchAs: _Normaliser.write_capture,
    ast.MatchStar: _Normaliser.write_capture,
    ast.MatchMapping: _Normaliser.write_mapping,
}
"""Nodes that are not written by their fields alone."""
