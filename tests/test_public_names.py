"""The public names: what type checkers and editors see is what a use imports."""

from __future__ import annotations

import ast
from pathlib import Path

import contactsim


def test_type_checkers_see_each_public_name_in_the_module_that_a_use_imports():
    tree = ast.parse(Path(contactsim.__file__).read_text(encoding="utf-8"))
    (block,) = (node for node in tree.body if isinstance(node, ast.If))
    imports = [node for node in block.body if isinstance(node, ast.ImportFrom)]
    seen = {alias.asname: node.module for node in imports for alias in node.names}
    used = {name: f"contactsim.{module}" for name, module in contactsim.PUBLIC.items()}
    assert seen == used | dict.fromkeys(contactsim.MODULES, "contactsim")
