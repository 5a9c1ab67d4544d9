"""Sources that compute the same have one normal form; sources that may not have different ones."""

from __future__ import annotations

from textwrap import dedent

import pytest

from contactsim.code_digest.normal_form import read_source

SAME = {
    "a comment": ("x = 1", "x = 1  # of all"),
    "layout": ("x = f(1, [2, 3])", "x = f(\n    1,\n    [2,\n     3],\n)"),
    "quotes and joined texts": ("x = 'ab'", 'x = ("a" "b")'),
    "a docstring": ("def f():\n    return 1", 'def f():\n    """Return one."""\n    return 1'),
    "a docstring of a module": ("x = 1", '"""Numbers."""\nx = 1'),
    "a docstring alone in a class": ("class A:\n    pass", 'class A:\n    """Nothing."""'),
    "a text beside a constant": ("x = 1", 'x = 1\n"""Of all."""'),
    "a text in a branch": ("if x:\n    f()", 'if x:\n    "now"\n    f()'),
    "an annotation of a function": ("def f(a):\n    return a", "def f(a: int) -> float:\n    return a"),
    "an annotation of a variable": ("def f():\n    x = 1\n    return x", "def f():\n    x: int = 1\n    return x"),
    "an annotation of a constant": ("x = 1", "x: Final = 1"),
    "an order of imports": ("import a\nimport b\nx = a.f(b)", "import b\nimport a\nx = a.f(b)"),
    "an import that nothing uses": ("x = 1", "import a\nx = 1"),
    "an import for types": ("x = 1", "if TYPE_CHECKING:\n    from a import B\nx = 1"),
    "an alias of an import": ("import numpy as np\nx = np.pi", "import numpy as numbers\nx = numbers.pi"),
    "a local variable": ("def f(a):\n    x = a\n    return x", "def f(a):\n    y = a\n    return y"),
    "two local variables": ("def f():\n    a, b = g()\n    return a - b", "def f():\n    b, a = g()\n    return b - a"),
    "a variable of a comprehension": ("x = [a for a in y if a]", "x = [b for b in y if b]"),
    "a variable of a comprehension in a class": (
        "class A:\n    x = [a for a in y]",
        "class A:\n    x = [b for b in y]",
    ),
    "a variable of a loop": ("def f():\n    for a in x:\n        g(a)", "def f():\n    for b in x:\n        g(b)"),
    "a variable of with": ("def f():\n    with g() as a:\n        h(a)", "def f():\n    with g() as b:\n        h(b)"),
    "an error caught": (
        "def f():\n    try:\n        g()\n    except E as a:\n        h(a)",
        "def f():\n    try:\n        g()\n    except E as b:\n        h(b)",
    ),
    "a variable that is matched": (
        "def f(x):\n    match x:\n        case [a, *r]:\n            g(a, r)",
        "def f(x):\n    match x:\n        case [b, *s]:\n            g(b, s)",
    ),
    "a walrus within a comprehension": (
        "def f(x):\n    return any((a := y) for y in x) and a",
        "def f(x):\n    return any((b := z) for z in x) and b",
    ),
    "a variable of a closure": (
        "def f():\n    a = 1\n    def g():\n        return a\n    return g",
        "def f():\n    b = 1\n    def g():\n        return b\n    return g",
    ),
    "a nonlocal variable": (
        "def f():\n    a = 1\n    def g():\n        nonlocal a\n        a = 2\n    return g, a",
        "def f():\n    b = 1\n    def g():\n        nonlocal b\n        b = 2\n    return g, b",
    ),
    "a parameter of a private function": (
        "def _f(a):\n    return a\nx = _f(1)",
        "def _f(b):\n    return b\nx = _f(1)",
    ),
    "a parameter of a function within a function": (
        "def f():\n    def g(a):\n        return a\n    return g(1)",
        "def f():\n    def g(b):\n        return b\n    return g(1)",
    ),
}
OTHER = {
    "a number": ("x = 1", "x = 2"),
    "a kind of number": ("x = 1", "x = 1.0"),
    "a sign of zero": ("x = 0.0", "x = -0.0"),
    "a text": ("x = 'a'", "x = 'b'"),
    "text and bytes": ("x = 'a'", "x = b'a'"),
    "an operator": ("x = a + b", "x = a - b"),
    "a comparison": ("x = a < b", "x = a <= b"),
    "and for or": ("x = a and b", "x = a or b"),
    "a sign": ("x = -a", "x = +a"),
    "an operator of an assignment": ("x += a", "x -= a"),
    "a filter of a comprehension": ("x = [a for a in y if a]", "x = [a for a in y]"),
    "a key of a comprehension": ("x = {a: 1 for a in y}", "x = {-a: 1 for a in y}"),
    "a step of a slice": ("x = a[::2]", "x = a[::3]"),
    "arguments in place of one": ("x = f(*a)", "x = f(a)"),
    "the rest of a loop": ("for a in x:\n    f()", "for a in x:\n    f()\nelse:\n    g()"),
    "a guard of a case": ("match x:\n    case 1:\n        f()", "match x:\n    case 1 if a:\n        f()"),
    "a format": ("x = f'{a:.2f}'", "x = f'{a:.3f}'"),
    "a cause of an error": ("raise E from a", "raise E"),
    "what is done in the end": ("try:\n    f()\nfinally:\n    g()", "try:\n    f()\nfinally:\n    h()"),
    "an order of terms": ("x = a + b + c", "x = a + (b + c)"),
    "a default": ("def f(a=1):\n    return a", "def f(a=2):\n    return a"),
    "a default of a keyword": ("def f(*, a=1):\n    return a", "def f(*, a=2):\n    return a"),
    "a default of a lambda": ("f = lambda a=1: a", "f = lambda a=2: a"),
    "an order of statements": ("f()\ng()", "g()\nf()"),
    "a branch": ("if x:\n    f()", "if x:\n    f()\nelse:\n    g()"),
    "an indentation": ("if x:\n    f()\n    g()", "if x:\n    f()\ng()"),
    "a decorator": ("def f():\n    return 1", "@cache\ndef f():\n    return 1"),
    "a global": ("x = 1", "y = 1"),
    "a function": ("def f():\n    return 1", "def g():\n    return 1"),
    "a member": ("class A:\n    x = 1", "class A:\n    y = 1"),
    "an attribute": ("x = a.b", "x = a.c"),
    "a keyword of a call": ("x = f(a=1)", "x = f(b=1)"),
    "a parameter of a public function": ("def f(a):\n    return a", "def f(b):\n    return b"),
    "a parameter of a method": (
        "class A:\n    def _f(self, a):\n        g(a)",
        "class A:\n    def _f(self, b):\n        g(b)",
    ),
    "an order of parameters called by keyword": (
        "def _f(a, b):\n    return a - b\nx = _f(a=1, b=2)",
        "def _f(b, a):\n    return b - a\nx = _f(a=1, b=2)",
    ),
    "a parameter of a function called with settings": (
        "def _f(a, b):\n    return a - b\nx = _f(**s)",
        "def _f(b, a):\n    return b - a\nx = _f(**s)",
    ),
    "a parameter of a private function passed on": (
        "def _f(a, b):\n    return a - b\nx = g(_f)",
        "def _f(b, a):\n    return b - a\nx = g(_f)",
    ),
    "a field of a dataclass": ("@dataclass\nclass A:\n    x: int", "@dataclass\nclass A:\n    y: int"),
    "an annotation of a field": ("@dataclass\nclass A:\n    x: int", "@dataclass\nclass A:\n    x: float"),
    "an annotation that is dispatched on": (
        "@f.register\ndef _(a: int):\n    return 1",
        "@f.register\ndef _(a: float):\n    return 1",
    ),
    "a module that a name comes from": ("from a import f\nx = f()", "from b import f\nx = f()"),
    "a name behind an alias": ("from a import f as h\nx = h()", "from a import g as h\nx = h()"),
    "two imports of one name": ("import a as x\nimport b as x\nf(x)", "import b as x\nimport a as x\nf(x)"),
    "an import in a branch": (
        "try:\n    import a as x\nexcept E:\n    x = 1",
        "try:\n    import b as x\nexcept E:\n    x = 1",
    ),
    "an import in a function": ("def f():\n    from a import b\n    b()", "def f():\n    from c import b\n    b()"),
    "which of two variables": (
        "def f():\n    a = b = g()\n    return a - a",
        "def f():\n    a = b = g()\n    return a - b",
    ),
    "two variables made one": (
        "def f(x):\n    a = g(x)\n    b = h(x)\n    return a + b",
        "def f(x):\n    a = g(x)\n    a = h(x)\n    return a + a",
    ),
    "a variable that was global": ("def f():\n    a = 1\n    g(a)", "def f():\n    global a\n    a = 1\n    g(a)"),
    "a variable that was of the outer function": (
        "def f():\n    a = 1\n    def g():\n        nonlocal a\n        a = 2\n    return g",
        "def f():\n    a = 1\n    def g():\n        a = 2\n    return g",
    ),
    "a member that hides a global in the class, not in its methods": (
        "def f():\n    x = 1\n    class A:\n        x = 2\n        y = x\n    return A",
        "def f():\n    x = 1\n    class A:\n        z = 2\n        y = x\n    return A",
    ),
    "variables that are read by name": (
        "def f():\n    x = 1\n    return locals()",
        "def f():\n    y = 1\n    return locals()",
    ),
    "variables in a query": (
        "def f(t):\n    x = 1\n    return t.query('a < @x')",
        "def f(t):\n    y = 1\n    return t.query('a < @x')",
    ),
    "a name shown by a text": ("def f():\n    x = 1\n    return f'{x=}'", "def f():\n    y = 1\n    return f'{y=}'"),
}


@pytest.mark.parametrize("what", SAME)
def test_what_cannot_change_a_result_is_not_seen(what):
    one, other = SAME[what]
    assert read_source(one).normal_form == read_source(other).normal_form


@pytest.mark.parametrize("what", OTHER)
def test_what_may_change_a_result_is_seen(what):
    one, other = OTHER[what]
    assert read_source(one).normal_form != read_source(other).normal_form


@pytest.mark.parametrize(
    "text", ["", "# nothing\n", '"""A package."""\n', "from __future__ import annotations\nimport a\n"]
)
def test_a_module_without_code_has_an_empty_normal_form(text):
    assert read_source(text).normal_form == ""


def test_imports_that_only_annotations_of_functions_use_are_told_from_those_that_code_uses():
    source = read_source(
        dedent("""
        from typing import TYPE_CHECKING
        from a.types import Field
        from a.types import Shape
        import a.numbers
        if TYPE_CHECKING:
            from a.scene import Scene
        class Body:
            shape: "Shape"
        def f(field: Field, scene: Scene) -> Field:
            from a.late import g
            return g(a.numbers.one)
        """)
    )
    used = {"a.types", "a.types.Shape", "a.numbers", "a.late", "a.late.g"}
    assert source.used_imports == used
    assert source.imports == used | {"typing", "typing.TYPE_CHECKING", "a.types.Field", "a.scene", "a.scene.Scene"}


def test_docstrings_are_collected_and_a_module_that_reads_them_is_known():
    source = read_source('"""One."""\ndef f():\n    """Two."""\n')
    assert source.docstrings == ("One.", "Two.")
    assert not source.reads_docstrings
    assert read_source("x = f.__doc__").reads_docstrings


def test_reading_leaves_the_collector_of_garbage_as_it_was():
    import gc

    gc.disable()
    try:
        read_source("x = 1")
        assert not gc.isenabled()
    finally:
        gc.enable()
    read_source("x = 1")
    assert gc.isenabled()
