"""Every example of the documentation is run."""

import doctest
import json
import pathlib

import pytest

import pantin
from pantin import body, evaluator, runs

FLAGS = doctest.ELLIPSIS | doctest.NORMALIZE_WHITESPACE
HERE = pathlib.Path(__file__).parent


@pytest.mark.parametrize("module", [pantin, body, evaluator, runs], ids=lambda module: module.__name__)
def test_docstrings(module, walk):
    globs = {"demo_cameras": lambda: pantin.Cameras.of_sequence(walk)}
    assert doctest.testmod(module, extraglobs=globs, optionflags=FLAGS).failed == 0


def test_something_is_tried():
    finder = doctest.DocTestFinder()
    examples = [test for module in (body, evaluator, runs) for test in finder.find(module) if test.examples]
    assert len(examples) >= 5


def test_everything_public_is_documented():
    for name in pantin.__all__:
        thing = getattr(pantin, name)
        if callable(thing):
            assert thing.__doc__ and thing.__doc__.strip(), name
            for member, value in vars(thing).items() if isinstance(thing, type) else ():
                if not member.startswith("_") and (callable(value) or isinstance(value, (property, classmethod))):
                    assert getattr(thing, member).__doc__, f"{name}.{member}"


def test_readme(walk, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    result = doctest.testfile(str(HERE.parent / "README.md"), module_relative=False, optionflags=FLAGS)
    assert result.attempted > 5 and result.failed == 0


@pytest.mark.parametrize("notebook", sorted((HERE.parent / "notebooks").glob("*.ipynb")), ids=lambda path: path.stem)
def test_notebooks(notebook, tmp_path):
    nbformat = pytest.importorskip("nbformat")
    nbclient = pytest.importorskip("nbclient")
    pages = nbformat.read(notebook, as_version=4)
    nbclient.NotebookClient(pages, timeout=300, resources={"metadata": {"path": str(tmp_path)}}).execute()
    pictures = [
        output
        for cell in pages.cells
        if cell.cell_type == "code"
        for output in cell.outputs
        if "image/png" in output.get("data", {})
    ]
    assert pictures, "nothing was plotted"


def test_notebooks_are_kept_without_outputs():
    notebooks = sorted((HERE.parent / "notebooks").glob("*.ipynb"))
    assert len(notebooks) >= 2
    for notebook in notebooks:
        for cell in json.loads(notebook.read_text())["cells"]:
            assert not cell.get("outputs"), notebook.name
