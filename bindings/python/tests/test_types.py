"""Stubs say what is there; docstrings run; everything public has one."""

import doctest
import inspect
import subprocess
import sys
from pathlib import Path
from typing import List

import darboux

PACKAGE = Path(__file__).resolve().parents[1]


def mypy(*arguments: str) -> None:
    ran = subprocess.run(
        [sys.executable, "-m", *arguments], cwd=PACKAGE, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True
    )
    assert ran.returncode == 0, ran.stdout


def test_stubs_agree_with_the_module() -> None:
    mypy("mypy.stubtest", "darboux._darboux", "--mypy-config-file", "pyproject.toml")


def test_the_package_and_its_use_are_typed() -> None:
    mypy("mypy", "python", "tests/typed_use.py")


def test_docstrings_run() -> None:
    assert doctest.testmod(darboux).failed == 0


def printed_by(example: str) -> List[str]:
    command = [sys.executable, PACKAGE / "examples" / example]
    return subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True).stdout.splitlines()


def test_the_examples_print_what_those_in_c_do() -> None:
    left, right = "-1 0 0 -1", "1 0 0 1"
    corners = [(0, left), (1, left), (4, left), (3, left), (1, right), (2, right), (5, right), (4, right)]
    assert printed_by("tangents.py") == [f"vertex {vertex}: {tangent}" for vertex, tangent in corners]
    vertices = [("-1 0 0", left), ("0 0 0", left), ("1 0 0", right), ("-1 1 0", left), ("0 1 0", left), ("1 1 0", right)]
    added = [("0 0 0", right), ("0 1 0", right)]
    assert printed_by("vertices.py") == ["6 vertices became 8"] + [
        f"{position}: tangent {tangent}" for position, tangent in vertices + added
    ]


def test_everything_public_is_documented() -> None:
    for module in (darboux, darboux.encode):
        for name in module.__all__:
            thing = getattr(module, name)
            if inspect.isroutine(thing) or inspect.isclass(thing):
                assert thing.__doc__, name
    members = [member for member in vars(darboux.Document).items() if not member[0].startswith("_")]
    assert len(members) > 5
    assert all(value.__doc__ for _, value in members)
