#!/usr/bin/env python3
"""Judges tangents against mikktspace.c. Needs Python 3.8 and nothing else.

    python3 judge.py FOLDER --level bits|angle|seams [--only CLASS] [--usable] [--json] [--junit FILE] [--cases FOLDER]

FOLDER has one result NAME.json per case. Exit code: 0 passed, 1 failed, 2 a result cannot be used. FORMAT.md describes the files.
"""

import argparse
import ctypes
import hashlib
import json
import math
import stat
import struct
import sys
from pathlib import Path
from xml.sax.saxutils import escape, quoteattr

CLASSES = ("core", "seams", "quads", "thresholds", "degenerate", "hostile", "large")
LEVELS = ("bits", "angle", "seams")
MODES = ("repaired", "corrected")
DEGREES = 0.1
SPECIAL = {"nan": math.nan, "inf": math.inf, "-inf": -math.inf}
# A number written in full takes some 20 characters; results beyond this many bytes per corner hold something else.
BYTES, BYTES_PER_CORNER = 1_000_000, 1000


class Unusable(Exception):
    """A result or case that cannot be judged; the message is one sentence."""


# Reading


def read_json(path, limit=None):
    try:
        status = path.stat()
        if not stat.S_ISREG(status.st_mode):
            raise Unusable(f"{path} is not a regular file.")
        if limit is not None and status.st_size > limit:
            raise Unusable(f"{path} has {status.st_size:,} bytes, more than the {limit:,} that its case can need.")
        return json.loads(path.read_text(encoding="utf-8"), parse_constant=refuse_constant, parse_int=integer)
    except FileNotFoundError:
        raise Unusable(f'{path} is missing; write {{"skipped": "why"}} for a case that you cannot run.') from None
    except OSError as error:
        raise Unusable(f"{path} cannot be read: {error.strerror}.") from None
    except UnicodeDecodeError:
        raise Unusable(f"{path} is not UTF-8.") from None
    except RecursionError:
        raise Unusable(f"{path} is nested too deeply.") from None
    except ValueError as error:
        raise Unusable(f"{path} is not JSON: {error}.") from None


def refuse_constant(name):
    raise ValueError(f'{name} is not JSON, write it as the string "nan", "inf" or "-inf"')


def integer(text):
    """-0 is a floating-point zero, as C's printf writes it."""
    return -0.0 if text == "-0" else int(text)


def number(value, where):
    """A number of a file, rounded to single precision."""
    if isinstance(value, str) and value in SPECIAL:
        return SPECIAL[value]
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        raise Unusable(f'{where} is {short(value)}, not a number, "nan", "inf" or "-inf".')
    try:
        return ctypes.c_float(value).value
    except OverflowError:
        raise Unusable(f"{where} is an integer that no floating-point number holds.") from None


def short(value):
    text = json.dumps(value)
    return text if len(text) <= 40 else text[:40] + "..."


def row(values, where):
    if not isinstance(values, list) or len(values) != 4:
        raise Unusable(f"{where} is {short(values)}, not a list of four numbers x, y, z and w.")
    return tuple(number(value, f"{where}[{at}]") for at, value in enumerate(values))


def read_case(path):
    """A case with the numbers that judging needs."""
    case = read_json(path)
    try:
        case["corners"] = case.get("corners", len(case.get("indices", [])))
        expected = case["expected"]
        rows = expected.get("sample", expected)
        for key in ("tangents", *MODES):
            if key in rows:
                rows[key] = [row(values, f"{path}: {key}") for values in rows[key]]
        case["name"], case["class"], case["failure"], case["shows"]
    except (KeyError, TypeError, AttributeError):
        raise Unusable(f"{path} is not a case; FORMAT.md says what a case has.") from None
    return case


class Result:
    """A result: tangents per corner, or a hash, or the reason why the case was skipped."""

    def __init__(self, path, corners):
        data = read_json(path, BYTES + BYTES_PER_CORNER * corners)
        if not isinstance(data, dict):
            raise Unusable(f"{path} is not a JSON object.")
        self.skipped = data.get("skipped")
        self.seconds = data.get("seconds")
        self.sha256 = data.get("sha256")
        self.tangents = None
        if self.seconds is not None:
            self.seconds = number(self.seconds, f"{path}: seconds")
        if self.skipped is not None:
            self.skipped = str(self.skipped)
        elif "tangents" in data:
            self.tangents = self.per_corner(path, data, corners)
        elif not isinstance(self.sha256, str):
            raise Unusable(f'{path} has neither "tangents" nor "sha256" nor "skipped".')

    def per_corner(self, path, data, corners):
        rows = data["tangents"]
        if not isinstance(rows, list):
            raise Unusable(f"{path}: tangents is {short(rows)}, not a list.")
        indices = data.get("indices")
        if indices is None:
            if len(rows) != corners:
                raise Unusable(f"{path} has {len(rows):,} tangents for {corners:,} corners.")
            return [row(values, f"{path}: tangents[{at}]") for at, values in enumerate(rows)]
        if not isinstance(indices, list) or len(indices) != corners:
            raise Unusable(f"{path}: indices is not a list of {corners:,} vertex numbers, one per corner.")
        of_vertex = [row(values, f"{path}: tangents[{at}]") for at, values in enumerate(rows)]
        for at, index in enumerate(indices):
            if isinstance(index, bool) or not isinstance(index, int) or not 0 <= index < len(rows):
                raise Unusable(f"{path}: indices[{at}] is {short(index)}, not the number of one of {len(rows):,} tangents.")
        return [of_vertex[index] for index in indices]


# Measuring


def bits(tangent):
    """Bits of a tangent; every NaN is the same."""
    return b"".join(b"\0\0\xc0\x7f" if x != x else struct.pack("<f", x) for x in tangent)


def length(v):
    return math.sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])


def is_unit(tangent):
    """False for zero, not finite, or another length than 1."""
    return all(map(math.isfinite, tangent[:3])) and abs(length(tangent) - 1.0) < 1e-3


def degrees(a, b):
    """The angle between two directions."""
    cross = (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])
    return math.degrees(math.atan2(length(cross), a[0] * b[0] + a[1] * b[1] + a[2] * b[2]))


class Measures:
    """What is counted over the corners of a case, or of several."""

    def __init__(self):
        self.corners = self.equal = self.angled = 0
        self.largest_angle = self.angle_sum = self.seconds = 0.0
        self.wrong_signs = self.wrong_angles = self.non_finite = self.zero = self.missing_splits = 0
        # Zero or not finite, also where the reference is so.
        self.unusable = 0

    def add(self, other):
        for key, value in vars(other).items():
            mine = getattr(self, key)
            setattr(self, key, max(mine, value) if key == "largest_angle" else mine + value)

    def as_dict(self):
        keys = ("corners", "equal", "wrong_angles", "wrong_signs", "non_finite", "zero", "missing_splits")
        mean = self.angle_sum / self.angled if self.angled else 0.0
        angles = {"largest_angle": round(self.largest_angle, 6), "mean_angle": round(mean, 8)}
        return {**{key: getattr(self, key) for key in keys}, **angles, "seconds": self.seconds}

    def corner(self, found, expected, others):
        """Counts one corner. `others`: what modes that repair the reference's defects give there."""
        self.corners += 1
        self.equal += bits(found) == bits(expected)
        self.unusable += not (any(found[:3]) and all(map(math.isfinite, found)))
        if any(bits(found) == bits(other) for other in (expected, *others)):
            self.zero += not any(found[:3])
            return
        if not all(map(math.isfinite, found)):
            self.non_finite += 1
            return
        self.zero += not any(found[:3])
        self.wrong_signs += found[3] not in [other[3] for other in (expected, *others)]
        usable = [other for other in (expected, *others) if is_unit(other)]
        if not is_unit(expected):
            self.wrong_angles += not is_unit(found)
            return
        angle = min(degrees(found, other) for other in usable) if any(found[:3]) else 180.0
        self.angled, self.angle_sum = self.angled + 1, self.angle_sum + angle
        self.largest_angle = max(self.largest_angle, angle)
        self.wrong_angles += not angle <= DEGREES

    def passes(self, level, usable):
        if usable and self.unusable:
            return False
        if level == "bits":
            return self.equal == self.corners
        signs = not (self.wrong_signs or self.non_finite or self.missing_splits)
        return signs and (level == "seams" or not self.wrong_angles)


def missing_splits(case, tangents):
    """The number of vertices with both signs in the reference that have one sign in the result."""
    if "indices" not in case:
        return 0
    signs, corner = {}, 0
    for size in case["faces"]:
        for at in range(corner, corner + size):
            if size in (3, 4):
                vertex = case["indices"][at]
                key = json.dumps([case[name][vertex] for name in ("positions", "normals", "uvs")])
                signs.setdefault(key, []).append((case["expected"]["tangents"][at][3], tangents[at][3]))
        corner += size
    return sum(len({a for a, _ in pairs}) == 2 and len({b for _, b in pairs}) == 1 for pairs in signs.values())


def others(expected, at):
    """What the modes that repair the reference's defects give at a corner."""
    return [expected[mode][at] for mode in MODES if mode in expected]


def measure(case, result):
    measures = Measures()
    measures.seconds = result.seconds or 0.0
    expected = case["expected"]
    if "sha256" in expected:
        tangents = result.tangents
        found = result.sha256 or hashlib.sha256(b"".join(map(bits, tangents))).hexdigest()
        if found == expected["sha256"]:
            measures.corners = measures.equal = case["corners"]
            return measures
        if tangents is None:
            measures.corners = measures.wrong_angles = case["corners"]
            measures.largest_angle = 180.0
            return measures
        sample = expected["sample"]
        for at, corner in enumerate(sample["corners"]):
            measures.corner(tangents[corner], sample["tangents"][at], others(sample, at))
        if measures.equal == measures.corners:
            # The difference lies outside the sample.
            measures.corners += 1
        return measures
    if result.tangents is None:
        raise Unusable(f"The result of {case['name']} is a hash; only cases of class large may give one.")
    corner = 0
    for size in case["faces"]:
        for at in range(corner, corner + size):
            if size in (3, 4):
                measures.corner(result.tangents[at], expected["tangents"][at], others(expected, at))
        corner += size
    measures.missing_splits = missing_splits(case, result.tangents)
    return measures


# Judging


def judge(cases, folder, level, usable):
    """One verdict per case."""
    verdicts = []
    for case in cases:
        result = Result(folder / f"{case['name']}.json", case["corners"])
        verdict = {"name": case["name"], "class": case["class"], "skipped": result.skipped}
        if result.skipped is None:
            verdict["measures"] = measure(case, result)
            verdict["passed"] = verdict["measures"].passes(level, usable)
            verdict["levels"] = [name for name in LEVELS if verdict["measures"].passes(name, usable)]
            if not verdict["passed"]:
                verdict["failure"] = case["failure"]
        verdicts.append(verdict)
    if all(verdict["skipped"] is not None for verdict in verdicts):
        raise Unusable(f"{folder} skips every case; there is nothing to judge.")
    return verdicts


def by_class(verdicts):
    """Per class: numbers of cases, and the measures of its cases together."""
    classes = {}
    for name in CLASSES:
        own = [verdict for verdict in verdicts if verdict["class"] == name]
        if own:
            total = Measures()
            for verdict in own:
                if verdict["skipped"] is None:
                    total.add(verdict["measures"])
            counts = {"cases": len(own), "passed": sum(verdict.get("passed", False) for verdict in own)}
            counts["skipped"] = sum(verdict["skipped"] is not None for verdict in own)
            classes[name] = {**counts, **total.as_dict()}
    return classes


def print_failures(failed):
    """One possible cause per failing case. A case named like another failing one with a suffix varies it, and its sentence holds only where that one passes."""
    bases = [v for v in failed if not any(v["name"].startswith(other["name"] + "-") for other in failed)]
    for base in bases:
        variants = [v["name"] for v in failed if v["name"].startswith(base["name"] + "-")]
        print(f"{base['name']} ({base['class']}). One possible cause: {base['failure']}\n  {summary(base['measures'])}")
        if variants:
            print(f"  variants of it fail too, which says more only once it passes: {', '.join(variants)}")
        print()


def print_table(verdicts, level):
    failed = [verdict for verdict in verdicts if verdict.get("passed") is False]
    print_failures(failed)
    columns = ("class", "cases", "passed", "skipped", "corners", "equal bits", "wrong angle", "largest", "mean", "wrong sign", "not finite", "zero", "no split", "seconds")
    lines = [columns]
    for name, c in by_class(verdicts).items():
        share = f"{100.0 * c['equal'] / c['corners']:.2f} %" if c["corners"] else "-"
        lines.append(
            (name, c["cases"], c["passed"], c["skipped"], c["corners"], share, c["wrong_angles"], f"{c['largest_angle']:.3f}", f"{c['mean_angle']:.4f}")
            + (c["wrong_signs"], c["non_finite"], c["zero"], c["missing_splits"], f"{c['seconds']:.3f}")
        )
    widths = [max(len(str(line[i])) for line in lines) for i in range(len(columns))]
    for line in lines:
        print("  ".join(str(cell).ljust(w) if i == 0 else str(cell).rjust(w) for i, (cell, w) in enumerate(zip(line, widths))))
    judged = sum(verdict["skipped"] is None for verdict in verdicts)
    skipped = f", {len(verdicts) - judged} skipped" if judged < len(verdicts) else ""
    print(f"\n{'FAILED' if failed else 'passed'} at level {level}: {judged - len(failed)} of {judged} cases pass{skipped}")


def summary(measures):
    m = measures.as_dict()
    parts = [f"{m['corners'] - m['equal']} of {m['corners']} corners differ"]
    names = {"wrong_angles": f"by more than {DEGREES} degrees", "wrong_signs": "wrong signs", "non_finite": "not finite", "zero": "zero", "missing_splits": "vertices not split"}
    parts += [f"{m[key]} {name}" for key, name in names.items() if m[key]]
    return ", ".join(parts) + f", largest angle {m['largest_angle']:.4g} degrees"


def write_junit(path, verdicts, level):
    suites = []
    for name in by_class(verdicts):
        own = [verdict for verdict in verdicts if verdict["class"] == name]
        cases = []
        for verdict in own:
            body = ""
            if verdict["skipped"] is not None:
                body = f"<skipped message={quoteattr(printable(verdict['skipped']))}/>"
            elif not verdict["passed"]:
                cause = quoteattr(f"One possible cause: {verdict['failure']}")
                body = f"<failure message={cause}>{escape(summary(verdict['measures']))}</failure>"
            seconds = verdict["measures"].seconds if verdict["skipped"] is None else 0.0
            cases.append(f'    <testcase classname={quoteattr(name)} name={quoteattr(verdict["name"])} time="{seconds:.6f}">{body}</testcase>')
        failures = sum(verdict.get("passed") is False for verdict in own)
        skipped = sum(verdict["skipped"] is not None for verdict in own)
        suites.append(f'  <testsuite name="{name}" tests="{len(own)}" failures="{failures}" skipped="{skipped}">\n' + "\n".join(cases) + "\n  </testsuite>")
    text = f'<?xml version="1.0" encoding="UTF-8"?>\n<testsuites name="MikkTSpace conformance, level {level}">\n' + "\n".join(suites) + "\n</testsuites>\n"
    try:
        Path(path).write_text(text, encoding="utf-8")
    except OSError as error:
        raise Unusable(f"{path} cannot be written: {error.strerror}.") from None


def printable(text):
    """XML has no control characters."""
    return "".join(c if c.isprintable() else " " for c in text)


def select(folder, only):
    paths = sorted(folder.glob("*.json"), key=lambda path: path.stem)
    cases = [case for case in map(read_case, paths) if not only or case["class"] in only]
    if not cases:
        raise Unusable(f"{folder} has no cases" + (f" of class {' or '.join(only)}." if only else "."))
    return cases


def main(arguments=None):
    parser = argparse.ArgumentParser(description="Judges tangents against mikktspace.c.")
    parser.add_argument("folder", type=Path, help="folder with one result NAME.json per case")
    parser.add_argument("--level", choices=LEVELS, required=True, help=f"bits: every bit; angle: within {DEGREES} degrees, signs right; seams: signs right, mirrored seams split")
    parser.add_argument("--only", action="append", choices=CLASSES, help="judge one class; may be repeated")
    parser.add_argument("--usable", action="store_true", help="tangents that are zero or not finite fail, even where the reference has them")
    parser.add_argument("--json", action="store_true", help="print JSON instead of the table")
    parser.add_argument("--junit", metavar="FILE", help="also write JUnit XML")
    parser.add_argument("--cases", type=Path, default=Path(__file__).resolve().parent / "cases", help="folder of the cases")
    options = parser.parse_args(arguments)
    try:
        if not options.folder.is_dir():
            raise Unusable(f"{options.folder} is not a folder.")
        verdicts = judge(select(options.cases, options.only), options.folder, options.level, options.usable)
        if options.junit:
            write_junit(options.junit, verdicts, options.level)
    except Unusable as unusable:
        print(unusable, file=sys.stderr)
        return 2
    passed = all(verdict.get("passed", True) for verdict in verdicts)
    if options.json:
        rows = [{**verdict, "measures": verdict["measures"].as_dict() if "measures" in verdict else None} for verdict in verdicts]
        print(json.dumps({"level": options.level, "passed": passed, "classes": by_class(verdicts), "cases": rows}, indent=1))
    else:
        print_table(verdicts, options.level)
    return 0 if passed else 1


if __name__ == "__main__":
    try:
        sys.exit(main())
    except BrokenPipeError:  # the reader, such as head, has seen enough
        sys.stderr.close()
        sys.exit(1)
