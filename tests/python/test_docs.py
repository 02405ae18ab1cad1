"""What is written about the package is true."""

import ast
import doctest
import inspect
import operator
import os
import pathlib
import re
import subprocess
import sys

import numpy as np
import pytest

import cyber_radar
from conftest import write_obj
from cyber_radar import _chain, _cutters, _engine, _scene, _shapes, _turns

ROOT = pathlib.Path(__file__).parents[2]
PACKAGE = pathlib.Path(cyber_radar.__file__).parent


@pytest.mark.parametrize("page", ["README.md", "docs/python.md"])
def test_the_examples_of_a_page_print_what_it_says(page, tmp_path):
    """The examples of a page follow on from each other, as one script."""
    prints_what_it_says("\n".join(examples(page)), tmp_path, [sys.executable, "-W", "error"])


def test_the_example_with_many_processes_prints_what_it_says(tmp_path):
    pytest.importorskip("mpi4py")
    (of_mpi,) = examples("docs/scaling.md")
    prints_what_it_says(of_mpi, tmp_path, ["mpirun", "-n", "2", sys.executable])


def examples(page: str) -> list[str]:
    return re.findall(r"^```python\n(.*?)^```", (ROOT / page).read_text(), re.M | re.S)


def prints_what_it_says(script: str, folder: pathlib.Path, command: list[str]) -> None:
    write_obj(folder / "part.obj")
    (folder / "page.py").write_text(script)
    # Open MPI wants to be told that root runs it, and that there may be no network.
    environment = os.environ | {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
    environment |= {"OMPI_MCA_rmaps_base_oversubscribe": "1", "OMPI_MCA_btl_vader_single_copy_mechanism": "none"}
    environment |= {"OMPI_MCA_btl": "^tcp"}
    run = subprocess.run([*command, "page.py"], cwd=folder, capture_output=True, text=True, env=environment)
    expected = re.findall(r"print\(.*?  # (.*)$", script, re.M)
    assert (run.stdout.splitlines(), run.stderr) == (expected, "")
    assert expected


@pytest.mark.parametrize("module", [_chain, _cutters, _scene, _shapes, _turns])
def test_doctests(module):
    results = doctest.testmod(module, extraglobs={"np": np})
    assert results.attempted >= 4 and results.failed == 0


def test_everything_public_has_a_docstring_and_types():
    for name in cyber_radar.__all__:
        item = getattr(cyber_radar, name)
        assert item.__doc__, name
        if inspect.isclass(item) and item.__module__.startswith("cyber_radar"):
            for member, value in vars(item).items():
                if inspect.isfunction(value) and not member.startswith("_"):
                    assert value.__doc__ and value.__annotations__, f"{name}.{member}"
    assert (PACKAGE / "py.typed").exists()


def test_cast_has_every_option_of_a_query():
    keywords = inspect.signature(cyber_radar.Scene.cast).parameters
    assert set(_engine.OPTIONS) <= set(keywords)
    assert all(keywords[name].kind == inspect.Parameter.KEYWORD_ONLY for name in _engine.OPTIONS)


def test_the_page_of_query_files_has_the_tables_of_options_and_answers():
    run = subprocess.run([os.environ["RADAR_PROGRAM"], "fields"], capture_output=True, text=True, check=True)
    options, answers = run.stdout.split("\n\n")
    page = (ROOT / "docs/query-file.md").read_text()
    assert options + "\n" in page and answers in page


@pytest.mark.parametrize("method", ["Scene.cast", "Chain.move"])
def test_help_shows_the_arguments_of(method):
    text = subprocess.run(
        [sys.executable, "-c", f"import cyber_radar; help(cyber_radar.{method})"],
        capture_output=True, text=True, check=True, env=os.environ | {"PAGER": "cat"},
    ).stdout  # fmt: skip
    names = set(inspect.signature(operator.attrgetter(method)(cyber_radar)).parameters) - {"self", "start", "end"}
    assert all(f"{name}:" in text for name in names)


def test_the_class_of_moves_says_what_each_member_of_a_record_is():
    text = cyber_radar.Moves.__doc__
    words = set(re.findall(r"\w+", " ".join(re.findall(r"^    (\w[\w, ]*):", text, re.M))))
    assert set(_engine.MOVES.names) == words


def test_the_stubs_declare_what_the_compiled_half_has():
    tree = ast.parse((PACKAGE / "_engine.pyi").read_text())
    declared = {node.name for node in tree.body if isinstance(node, (ast.FunctionDef, ast.ClassDef))}
    declared |= {node.target.id for node in tree.body if isinstance(node, ast.AnnAssign)}
    assert declared == {name for name in vars(_engine) if not name.startswith("__")}
    (scene,) = (node for node in tree.body if isinstance(node, ast.ClassDef) and node.name == "Scene")
    methods = {node.name for node in scene.body if isinstance(node, ast.FunctionDef)}
    of_pybind11 = ("__module__", "__doc__", "__new__", "_pybind11_")
    assert methods == {name for name in vars(_engine.Scene) if not name.startswith(of_pybind11)}


def test_pip_gives_the_package_the_version_it_has():
    assert f'version = "{cyber_radar.__version__}"' in (ROOT / "pyproject.toml").read_text()
