"""A stranger's way: the folder is copied elsewhere, and the adapters of README.md and FORMAT.md run there as they are printed."""

import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

FOLDER = Path(__file__).resolve().parents[1]
CASES = ("square", "mirrored-pair", "quad-flat", "nan-everywhere", "empty")

# A tangent function as tutorials have it: per vertex, no split at mirrored seams.
SMALL_FUNCTION = """
    tangents = [[0.0, 0.0, 0.0] for _ in case["positions"]]
    for at in range(0, len(case["indices"]), 3):
        corners = case["indices"][at : at + 3]
        p, q, r = (case["positions"][i] for i in corners)
        (a, b), (c, d), (e, f) = (case["uvs"][i] for i in corners)
        area = (c - a) * (f - b) - (e - a) * (d - b)
        for i in corners:
            for k in range(3):
                tangents[i][k] += ((q[k] - p[k]) * (f - b) - (r[k] - p[k]) * (d - b)) / area if area else 0.0
    lengths = [sum(x * x for x in t) ** 0.5 or 1.0 for t in tangents]
    return {"tangents": [[x / size for x in t] + [1.0] for t, size in zip(tangents, lengths)], "indices": case["indices"]}
"""


def blocks(page, language):
    """The code blocks of a page."""
    text = (FOLDER / page).read_text(encoding="utf-8")
    found = re.findall(rf"^( *)```{language}\n(.*?)^ *```", text, re.M | re.S)
    return ["\n".join(line[len(indent) :] for line in code.split("\n")) for indent, code in found]


class Elsewhere(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.root = Path(temporary.name)
        for name in ("judge.py", "generate.py", "casefile.py", "cases", "readers"):
            source, target = FOLDER / name, cls.root / "conformance" / name
            target.parent.mkdir(exist_ok=True)
            shutil.copytree(source, target) if source.is_dir() else shutil.copy(source, target)
        for path in (cls.root / "conformance/cases").glob("*.json"):
            if path.stem not in CASES:
                path.unlink()
        cls.call(sys.executable, "conformance/generate.py", "cases", "--all")

    @classmethod
    def call(cls, *command):
        done = subprocess.run(command, cwd=cls.root, capture_output=True, text=True, check=False)
        if done.returncode:
            raise AssertionError(done.stderr)

    def verdict(self, level="seams"):
        command = [sys.executable, "conformance/judge.py", "results", "--level", level]
        done = subprocess.run(command, cwd=self.root, capture_output=True, text=True, check=False)
        self.assertEqual(done.stderr, "")
        return done.returncode, done.stdout

    def adapter(self, name, code, *start):
        shutil.rmtree(self.root / "results", ignore_errors=True)
        (self.root / name).write_text(code, encoding="utf-8")
        self.call(*start, name, "cases", "results")

    def test_a_small_function_in_python(self):
        (code,) = blocks("README.md", "python")
        line = next(line for line in code.split("\n") if "your function here" in line)
        code = code.replace(line, SMALL_FUNCTION)
        self.adapter("adapter.py", code, sys.executable)
        code, out = self.verdict()
        self.assertEqual(code, 1)
        self.assertIn("mirrored-pair (seams). One possible cause: The two halves share the tangents of the edge.", out)
        self.assertNotIn("square (core)", out)
        self.assertIn("1 skipped", out)

    def test_the_example_in_python(self):
        (code,) = blocks("FORMAT.md", "python")
        self.adapter("adapter.py", code, sys.executable)
        self.assertEqual(self.verdict()[0], 1)

    @unittest.skipUnless(shutil.which("node"), "needs node")
    def test_the_example_in_javascript(self):
        (code,) = blocks("FORMAT.md", "js")
        self.adapter("adapter.mjs", code, "node")
        self.assertEqual(self.verdict()[0], 1)

    @unittest.skipUnless(shutil.which("cc"), "needs a C compiler")
    def test_the_example_in_c_and_cpp(self):
        (code,) = blocks("FORMAT.md", "c")
        for compiler, name in (("cc", "adapter.c"), ("c++", "adapter.cpp")):
            with self.subTest(compiler):
                if not shutil.which(compiler):
                    self.skipTest(f"needs {compiler}")
                shutil.rmtree(self.root / "results", ignore_errors=True)
                (self.root / name).write_text(code, encoding="utf-8")
                self.call(compiler, "-Wall", "-Wextra", "-Werror", name, "-lm", "-o", "adapter")
                self.call("./adapter", "cases", "results")
                code_of_judge, out = self.verdict()
                self.assertEqual(code_of_judge, 1)
                self.assertIn("1 skipped", out)


if __name__ == "__main__":
    unittest.main()
