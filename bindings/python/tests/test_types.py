"""Stubs say what is there; docstrings run; everything public has one."""

import doctest
import inspect
import re
import subprocess
import sys
from pathlib import Path
from typing import Any, Dict, Iterator, List, Tuple

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


def documented() -> Iterator[Tuple[str, Any]]:
    """Every public function, class and method."""
    for module in (darboux, darboux.encode):
        for name in module.__all__:
            thing = getattr(module, name)
            yield f"{module.__name__}.{name}", thing
            if inspect.isclass(thing):
                members = [member for member in vars(thing) if not member.startswith("_")]
                yield from ((f"{name}.{member}", getattr(thing, member)) for member in members)


def section(docstring: str, title: str) -> List[str]:
    """The lines of a section of a numpydoc docstring, up to the next blank line before a title."""
    lines = docstring.splitlines()
    starts = [at for at in range(1, len(lines)) if set(lines[at]) == {"-"}]
    bounds = zip(starts, [start - 1 for start in starts[1:]] + [len(lines)])
    return [line for first, last in bounds if lines[first - 1] == title for line in lines[first + 1 : last] if line]


def test_every_parameter_has_a_heading_of_its_own() -> None:
    heading = re.compile(r"(?P<names>(\*\*)?[a-z]\w*(, [a-z]\w*)*)( : [^:]+)?")
    wrong: Dict[str, List[str]] = {}
    tested = 0
    for name, thing in documented():
        lines = section(inspect.getdoc(thing) or "", "Parameters")
        if not callable(thing) or not lines:
            continue
        tested += 1
        headings = [heading.fullmatch(line) for line in lines if not line.startswith("    ")]
        told = [told.lstrip("*") for found in headings if found for told in found["names"].split(", ")]
        taken = [taken.lstrip("*") for taken in inspect.signature(thing).parameters if taken != "self"]
        problems = [line for line in lines if "  " in line.strip() or not (line.startswith("    ") or heading.fullmatch(line))]
        problems += [f"has no heading: {missing}" for missing in taken if missing not in told]
        problems += [f"is no parameter: {extra}" for extra in told if extra not in taken]
        if problems:
            wrong[name] = problems
    assert not wrong, "\n".join(f"{name}: {problem}" for name, problems in wrong.items() for problem in problems)
    assert tested >= 30
