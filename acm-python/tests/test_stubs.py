"""The stubs name what the package has, and nothing else."""

import ast
import inspect
import pathlib

import acm


def stub():
    text = (pathlib.Path(acm.__file__).parent / "__init__.pyi").read_text()
    return [node for node in ast.parse(text).body if isinstance(node, (ast.ClassDef, ast.FunctionDef))]


def names(body):
    return {node.name for node in body if isinstance(node, ast.FunctionDef) and not node.name.startswith("_")}


def test_stubs_have_every_name_and_every_argument():
    nodes = {node.name: node for node in stub() if node.name != "ArrowFrame"}
    assert set(nodes) == set(acm.__all__) - {"__version__"}
    assert (pathlib.Path(acm.__file__).parent / "py.typed").is_file()
    for name, node in nodes.items():
        found = getattr(acm, name)
        if isinstance(node, ast.FunctionDef):
            arguments = node.args.args + node.args.kwonlyargs + [node.args.kwarg] * (node.args.kwarg is not None)
            told = [argument.arg for argument in arguments]
            assert told == list(inspect.signature(found).parameters), name
        elif not issubclass(found, Exception):
            assert names(node.body) == {own for own in vars(found) if not own.startswith("_")}, name
