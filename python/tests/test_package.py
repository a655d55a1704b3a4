"""The package itself: its documentation and its stubs."""

import ast
import doctest
import importlib
import inspect
import pathlib

import nucleus
from nucleus import _nucleus

MODULES = ["_cache", "_errors", "_run", "_scene", "_simulation", "_wedge"]


def members(owner):
    """The public functions, methods and properties of a class or module, by name."""
    return {name: one for name, one in vars(owner).items() if not name.startswith("_") and not inspect.ismodule(one)}


def test_everything_public_has_a_docstring():
    for name in nucleus.__all__:
        one = getattr(nucleus, name)
        if name == "__version__":
            continue
        assert one.__doc__, name
        if inspect.isclass(one):
            own = {member: of for member, of in members(one).items() if callable(of) or isinstance(of, property)}
            assert [member for member, of in own.items() if not of.__doc__] == [], name


def test_the_examples_in_docstrings_are_correct(folder):
    found = [doctest.testmod(importlib.import_module(f"nucleus.{name}")) for name in MODULES]
    assert sum(one.attempted for one in found) > 0 and sum(one.failed for one in found) == 0


def test_the_stubs_name_what_the_compiled_module_has():
    stub = ast.parse((pathlib.Path(nucleus.__file__).parent / "_nucleus.pyi").read_text(encoding="utf-8"))
    classes = {node.name: node for node in stub.body if isinstance(node, ast.ClassDef)}
    functions = {node.name for node in stub.body if isinstance(node, ast.FunctionDef)}
    assert functions | set(classes) == set(members(_nucleus))
    for name, node in classes.items():
        named = {one.name for one in node.body if isinstance(one, ast.FunctionDef)}
        named |= {one.target.id for one in node.body if isinstance(one, ast.AnnAssign)}
        public = {one for one in named if not one.startswith("_")}
        assert public == set(members(getattr(_nucleus, name))), name
    assert (pathlib.Path(nucleus.__file__).parent / "py.typed").exists()
