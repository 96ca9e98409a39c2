"""What the tests share: a short synthetic sequence."""

import pathlib

import pytest

import pantin


@pytest.fixture(scope="session")
def walk(tmp_path_factory: pytest.TempPathFactory) -> pathlib.Path:
    """The folder of the built-in demo's first frames."""
    return pantin.synth(tmp_path_factory.mktemp("walk") / "walk", preset="demo", frames=4)
