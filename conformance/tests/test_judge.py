"""What judge.py accepts and refuses: python3 -m unittest discover conformance/tests"""

import contextlib
import io
import json
import os
import math
import subprocess
import sys
import tempfile
import unittest
import xml.etree.ElementTree as ElementTree
from pathlib import Path

FOLDER = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(FOLDER))

import casefile  # noqa: E402
import judge  # noqa: E402
from twin import Mesh, Twin  # noqa: E402

CASES = [case for case in casefile.read_all() if case["class"] != "large"]


def written(rows):
    """Rows as a result file has them."""
    return [[x if math.isfinite(x) else json.loads(casefile.text(x)) for x in row] for row in rows]


class Judged(unittest.TestCase):
    """A folder with the results of the reference; what a test changes is put back."""

    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = Path(temporary.name)
        cls.right = {case["name"]: json.dumps({"tangents": written(case["expected"]["tangents"])}) for case in CASES}
        for path in casefile.CASES.glob("large-*.json"):
            cls.right[path.stem] = json.dumps({"sha256": json.loads(path.read_text(encoding="utf-8"))["expected"]["sha256"]})
        cls.changed = set(cls.right)

    def setUp(self):
        for name in set(self.changed):
            self.path(name).write_text(self.right[name], encoding="utf-8")
        self.changed.clear()

    def path(self, name):
        """The file of a result that the test will change."""
        self.changed.add(name)
        return self.folder / f"{name}.json"

    def write(self, name, result):
        self.path(name).write_text(result if isinstance(result, str) else json.dumps(result), encoding="utf-8")

    def judge(self, *options, level="bits"):
        out, err = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
            code = judge.main([str(self.folder), "--level", level, *options])
        return code, out.getvalue(), err.getvalue()

    def assert_refused(self, name, result, words):
        self.write(name, result)
        code, out, err = self.judge()
        self.assertEqual((code, out), (2, ""), err)
        self.assertEqual(err.count("\n"), 1, err)
        self.assertIn(words, err)
        self.assertIn(name, err)


class Refused(Judged):
    def test_missing(self):
        self.path("cube").unlink()
        code, _, err = self.judge()
        self.assertEqual((code, err.count("\n")), (2, 1))
        self.assertIn("cube.json is missing", err)

    @unittest.skipUnless(hasattr(os, "mkfifo"), "skipped: named pipes are Unix's")
    def test_named_pipe(self):
        self.path("cube").unlink()
        os.mkfifo(self.path("cube"))
        # Writing the result again would wait for a reader.
        self.addCleanup(self.path("cube").unlink)
        code, _, err = self.judge()
        self.assertEqual((code, err.count("\n")), (2, 1))
        self.assertIn("cube.json is not a regular file", err)

    def test_no_folder(self):
        err = io.StringIO()
        with contextlib.redirect_stderr(err):
            self.assertEqual(judge.main([str(self.folder / "none"), "--level", "bits"]), 2)
        self.assertIn("is not a folder", err.getvalue())

    def test_truncated(self):
        self.assert_refused("cube", '{"tangents": [[1, 0, 0', "is not JSON")

    def test_empty_file(self):
        self.assert_refused("cube", "", "is not JSON")

    def test_bare_nan(self):
        self.assert_refused("triangle", '{"tangents": [[NaN, 0, 0, 1], [1, 0, 0, 1], [1, 0, 0, 1]]}', 'write it as the string "nan"')

    def test_not_text(self):
        self.path("cube").write_bytes(b"\xff\xfe{}")
        code, _, err = self.judge()
        self.assertEqual((code, "is not UTF-8" in err), (2, True), err)

    def test_wrong_lengths(self):
        self.assert_refused("triangle", {"tangents": [[1, 0, 0, 1]] * 4}, "4 tangents for 3 corners")
        self.assert_refused("triangle", {"tangents": [[1, 0, 0]] * 3}, "not a list of four numbers")
        self.assert_refused("triangle", {"tangents": [[1, 0, 0, 1]] * 3, "indices": [0, 1]}, "indices is not a list of 3")

    def test_wrong_values(self):
        self.assert_refused("triangle", {"tangents": [[1, 0, 0, "one"]] * 3}, "not a number")
        self.assert_refused("triangle", {"tangents": [[1, 0, 0, True]] * 3}, "not a number")
        self.assert_refused("triangle", {"tangents": [[10**400, 0, 0, 1]] * 3}, "no floating-point number")
        self.assert_refused("triangle", {"tangents": [[1, 0, 0, 1]] * 3, "indices": [0, 1, 3]}, "not the number of one of 3 tangents")
        self.assert_refused("triangle", {"tangents": 7}, "not a list")
        self.assert_refused("triangle", {}, "neither")
        self.assert_refused("triangle", [], "not a JSON object")
        self.assert_refused("triangle", {"sha256": "00"}, "only cases of class large")

    def test_huge(self):
        self.assert_refused("triangle", " " * 2_000_000, "more than the")

    def test_deep(self):
        self.assert_refused("triangle", "[" * 100_000, "nested too deeply")

    def test_long_integer(self):
        self.assert_refused("triangle", '{"tangents": [[' + "9" * 100_000 + ", 0, 0, 1]]}", "is not JSON")

    def test_everything_skipped(self):
        for name in self.right:
            self.write(name, {"skipped": "no quads"})
        code, _, err = self.judge()
        self.assertEqual((code, "nothing to judge" in err), (2, True), err)


class Verdicts(Judged):
    def test_the_reference_passes_every_level(self):
        for level in judge.LEVELS:
            self.assertEqual(self.judge(level=level)[0], 0, level)

    def test_a_result_per_vertex(self):
        case = next(case for case in CASES if case["name"] == "mirrored-pair")
        rows = [tuple(row) for row in case["expected"]["tangents"]]
        distinct = sorted(set(rows))
        self.write("mirrored-pair", {"indices": [distinct.index(row) for row in rows], "tangents": distinct})
        self.assertEqual(self.judge()[0], 0)

    def test_one_tangent_per_vertex_does_not_split(self):
        case = next(case for case in CASES if case["name"] == "mirrored-pair")
        of_vertex = dict(zip(case["indices"], case["expected"]["tangents"]))
        self.write("mirrored-pair", {"indices": case["indices"], "tangents": [of_vertex[v] for v in sorted(of_vertex)]})
        for level in judge.LEVELS:
            code, out, _ = self.judge("--only", "seams", level=level)
            self.assertEqual(code, 1)
        self.assertIn("vertices not split", out)
        self.assertIn(case["failure"], out)

    def test_a_last_bit_fails_bits_only(self):
        case = next(case for case in CASES if case["name"] == "bumpy-grid")
        rows = [[x * (1 + 2**-20) for x in row[:3]] + row[3:] for row in case["expected"]["tangents"]]
        self.write("bumpy-grid", {"tangents": rows})
        self.assertEqual([self.judge(level=level)[0] for level in judge.LEVELS], [1, 0, 0])

    def test_minus_zero_keeps_its_sign(self):
        case = next(case for case in CASES if case["name"] == "order-of-writes")
        text = self.right["order-of-writes"].replace("-0.0,", "-0,")
        self.assertNotEqual(text, self.right["order-of-writes"])
        self.write(case["name"], text)
        self.assertEqual(self.judge()[0], 0)

    def test_a_turned_tangent_fails_angle(self):
        case = next(case for case in CASES if case["name"] == "square")
        turned = [math.cos(0.01), math.sin(0.01), 0.0]
        self.write("square", {"tangents": [turned + row[3:] for row in case["expected"]["tangents"]]})
        self.assertEqual([self.judge(level=level)[0] for level in judge.LEVELS], [1, 1, 0])

    def test_a_wrong_sign_fails_every_level(self):
        case = next(case for case in CASES if case["name"] == "square")
        self.write("square", {"tangents": [row[:3] + [-row[3]] for row in case["expected"]["tangents"]]})
        self.assertEqual([self.judge(level=level)[0] for level in judge.LEVELS], [1, 1, 1])

    def test_nan_and_zero_fail(self):
        for bad in (["nan", 0, 0, 1], [0, 0, 0, 1]):
            self.write("square", {"tangents": [bad] * 6})
            self.assertEqual(self.judge(level="angle")[0], 1, bad)

    def test_usable_refuses_what_the_reference_leaves(self):
        self.assertEqual(self.judge("--only", "degenerate", "--usable")[0], 1)
        self.assertEqual(self.judge("--only", "core", "--usable")[0], 0)

    def test_a_large_case_by_values(self):
        path = casefile.CASES / "large-fan-threshold.json"
        case = json.loads(path.read_text(encoding="utf-8"))
        self.write(path.stem, {"tangents": [[1, 0, 0, 1]] * case["corners"]})
        self.assertEqual(self.judge("--only", "large")[0], 1)

    def test_skipped_cases_are_counted(self):
        self.write("quad-flat", {"skipped": "triangles only"})
        code, out, _ = self.judge()
        self.assertEqual((code, "1 skipped" in out), (0, True), out)

    def test_json_and_junit(self):
        self.write("cube", {"tangents": [[1, 0, 0, 1]] * 36})
        self.write("square", {"skipped": "<&>\x01"})
        file = self.folder.parent / f"{self.folder.name}.xml"
        self.addCleanup(lambda: file.unlink(missing_ok=True))
        code, out, _ = self.judge("--json", "--junit", str(file), "--only", "core")
        verdict = json.loads(out)
        self.assertEqual((code, verdict["passed"], verdict["classes"]["core"]["skipped"]), (1, False, 1))
        suite = ElementTree.parse(file).getroot().find("testsuite")
        self.assertEqual((suite.get("failures"), suite.get("skipped"), suite.get("name")), ("1", "1", "core"))

    def test_the_command(self):
        command = [sys.executable, str(FOLDER / "judge.py"), str(self.folder), "--level", "bits"]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("passed at level bits", done.stdout)


class Cases(unittest.TestCase):
    def test_every_case_is_in_its_canonical_form(self):
        for path in casefile.CASES.glob("*.json"):
            with self.subTest(path.name), tempfile.TemporaryDirectory() as folder:
                casefile.write(Path(folder) / path.name, casefile.read(path))
                self.assertEqual((Path(folder) / path.name).read_bytes(), path.read_bytes())

    def test_the_suite_is_large(self):
        classes = {case["class"] for case in CASES} | {"large"}
        self.assertEqual(classes, set(judge.CLASSES))
        self.assertGreaterEqual(len(list(casefile.CASES.glob("*.json"))), 120)
        for case in CASES:
            self.assertTrue(case["shows"].endswith(".") and case["failure"].endswith("."), case["name"])

    def test_the_twin_has_the_bits_of_the_reference(self):
        for case in CASES:
            corner, rows = 0, Twin(Mesh(case)).spaces()
            for size in case["faces"]:
                for at in range(corner, corner + size) if size in (3, 4) else ():
                    tangent, bitangent, magnitude, preserves = rows[at]
                    found = [*tangent, 1.0 if preserves else -1.0, *bitangent, *magnitude]
                    wanted = sum((case["expected"][key][at] for key in casefile.OUTPUTS), [])
                    self.assertEqual(list(map(casefile.word, found)), list(map(casefile.word, wanted)), (case["name"], at))
                corner += size


if __name__ == "__main__":
    unittest.main()
