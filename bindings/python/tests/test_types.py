"""Stubs say what is there; docstrings run; everything public has one."""

import doctest
import inspect
import re
import subprocess
import sys
from pathlib import Path

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


def test_the_manuals_examples_run() -> None:
    text = (PACKAGE.parents[1] / "docs/python.md").read_text()
    blocks = re.findall(r"```python\n(.*?)```", text, re.DOTALL)
    run = [block for block in blocks if "assert" in block]
    assert len(run) == 2
    exec("".join(run), {})


def test_everything_public_is_documented() -> None:
    for module in (darboux, darboux.encode):
        for name in module.__all__:
            thing = getattr(module, name)
            if inspect.isroutine(thing) or inspect.isclass(thing):
                assert thing.__doc__, name
    members = [member for member in vars(darboux.Document).items() if not member[0].startswith("_")]
    assert len(members) > 5
    assert all(value.__doc__ for _, value in members)
