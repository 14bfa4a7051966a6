"""Proves of every adapter that the suite can fail it: the adapter runs on wrong inputs, and as a wrong build with one operation changed.

Results that run.py left in WORK are used, others are computed. Counts are kept in the summaries in results/, and page.py makes
WRONG.md of them. Exit code 1 if no case of an adapter notices exchanged u and v, or its wrong build.

A wrong input changes a case before the adapter, or the result after it, as a mistake of an integration would. The wrong build of an adapter
is the member "wrong" of its run in adapter.json: "old" becomes "new" in a "file" of the adapter, of its node_modules, or of a Rust crate
("crate:NAME/PATH"). Each runs on the class of cases that must notice it. A case notices it if it passes a level less, or if more of its
corners have a wrong sign or a wrong angle, than with the right adapter.
"""

import json
import math
import os
import shutil
import sys
from pathlib import Path

import casefile
import judge
import run

CHANGES = []


def change(name, noticed_by, sentence):
    """Registers a wrong input."""

    def register(cls):
        cls.name, cls.noticed_by, cls.sentence = name, noticed_by, sentence
        CHANGES.append(cls)
        return cls

    return register


class Change:
    @staticmethod
    def of_case(case):
        return case

    @staticmethod
    def of_result(case, tangents):
        return tangents


@change("uvs-exchanged", "core", "u and v are exchanged.")
class UvsExchanged(Change):
    @staticmethod
    def of_case(case):
        return {**case, "uvs": [[v, u] for u, v in case["uvs"]]}


@change("sign-always-positive", "seams", "The sign is always +1.")
class SignAlwaysPositive(Change):
    @staticmethod
    def of_result(case, tangents):
        return [row[:3] + (1.0,) for row in tangents]


@change("last-corner-wins", "seams", "Results per corner are written through the index list; the last corner of a vertex wins.")
class LastCornerWins(Change):
    @staticmethod
    def of_result(case, tangents):
        of_vertex = dict(zip(case["indices"], tangents))
        return [of_vertex[vertex] for vertex in case["indices"]]


@change("quads-cut-before", "quads", "Quads are cut from corner 0 to 2 before.")
class QuadsCutBefore(Change):
    @staticmethod
    def of_case(case):
        faces, indices = [], []
        for corners in corners_of_faces(case):
            parts = [corners] if len(corners) != 4 else [corners[:3], [corners[0], *corners[2:]]]
            faces += map(len, parts)
            indices += [case["indices"][corner] for part in parts for corner in part]
        return {**case, "faces": faces, "indices": indices}

    @staticmethod
    def of_result(case, tangents):
        rows, at = [], 0
        for size in case["faces"]:
            rows += tangents[at : at + min(size, 3)] + tangents[at + 5 : at + 6] if size == 4 else tangents[at : at + size]
            at += 6 if size == 4 else size
        return rows


@change("threshold-ignored", "thresholds", "The angular threshold is 180 degrees.")
class ThresholdIgnored(Change):
    @staticmethod
    def of_case(case):
        return {**case, "threshold": 180.0}


@change("degenerates-removed", "degenerate", "Triangles with two equal positions are removed before, and their corners get (1, 0, 0).")
class DegeneratesRemoved(Change):
    @staticmethod
    def keeps(case, corners):
        positions = [tuple(case["positions"][case["indices"][corner]]) for corner in corners]
        return len(corners) != 3 or len(set(positions)) == 3

    @classmethod
    def of_case(cls, case):
        kept = [corners for corners in corners_of_faces(case) if cls.keeps(case, corners)]
        return {**case, "faces": list(map(len, kept)), "indices": [case["indices"][corner] for corners in kept for corner in corners]}

    @classmethod
    def of_result(cls, case, tangents):
        rows, at = [], 0
        for corners in corners_of_faces(case):
            if cls.keeps(case, corners):
                rows += tangents[at : at + len(corners)]
                at += len(corners)
            else:
                rows += [(1.0, 0.0, 0.0, -1.0)] * len(corners)
        return rows


@change("non-finite-replaced", "hostile", "Numbers that are not finite are replaced by zero.")
class NonFiniteReplaced(Change):
    @staticmethod
    def of_case(case):
        return {**case, **{key: [[x if math.isfinite(x) else 0.0 for x in row] for row in case[key]] for key in casefile.INPUTS}}


def corners_of_faces(case):
    """The corners of each face."""
    first = 0
    for size in case["faces"]:
        yield list(range(first, first + size))
        first += size


class Adapter:
    """An adapter with one of its runs, and what it gives for the right cases."""

    def __init__(self, folder, entry, work, command):
        self.folder, self.entry, self.work = folder, entry, work
        self.log = work / f"{folder.name}-wrong.log"
        self.right = work / "results" / entry["id"]
        if not self.right.is_dir():
            run.compute(command, entry, work, self.log)
        cases = [case for case in judge.select(run.HERE / "cases", None) if case["class"] != "large"]
        self.cases = {case["name"]: case for case in cases}
        self.verdicts = {verdict["name"]: verdict for verdict in judge.judge(cases, self.right, "bits", False)}

    def of_class(self, name):
        """The cases of a class that the adapter does not skip."""
        return [key for key, case in self.cases.items() if case["class"] == name and self.verdicts[key]["skipped"] is None]

    def compute(self, command, cases):
        """The tangents per corner that a command gives for changed cases, by name; None for cases that it skips.

        A changed case can end the command. Such a case gets tangents that are not numbers.
        """
        try:
            target = self.run_on(command, cases)
        except run.Unavailable:
            return {name: self.compute_alone(command, name, case) for name, case in cases.items()}
        return {name: judge.Result(target / f"{name}.json", len(case["indices"])).tangents for name, case in cases.items()}

    def compute_alone(self, command, name, case):
        try:
            target = self.run_on(command, {name: case})
        except run.Unavailable:
            return [(math.nan,) * 4] * len(case["indices"])
        return judge.Result(target / f"{name}.json", len(case["indices"])).tangents

    def run_on(self, command, cases):
        """The folder with the results of a command for some cases."""
        source, target = (self.work / "wrong" / self.entry["id"] / name for name in ("cases", "results"))
        for place in (source, target):
            shutil.rmtree(place, ignore_errors=True)
        source.mkdir(parents=True)
        for name, case in cases.items():
            casefile.write(source / f"{name}.json", case)
        run.call([*command, *self.entry["arguments"], source, target], self.log, cwd=self.work)
        return target

    def noticed(self, found):
        """The number of cases whose verdict is worse than that of the right adapter."""
        return sum(is_worse(self.verdicts[name], judge.measure(self.cases[name], Given(rows))) for name, rows in found.items() if rows is not None)

    def count_inputs(self, command):
        """Per wrong input: the number of cases that notice it, of how many."""
        counts = {}
        for change in CHANGES:
            originals = {name: readable(name) for name in self.of_class(change.noticed_by)}
            if not originals:
                continue
            found = self.compute(command, {name: change.of_case(case) for name, case in originals.items()})
            rows = {name: None if rows is None else change.of_result(originals[name], rows) for name, rows in found.items()}
            counts[change.name] = [self.noticed(rows), len(originals)]
        return counts

    def count_build(self):
        """The number of cases that notice the wrong build, of how many, with its class and sentence; None without a wrong build."""
        wrong = self.entry.get("wrong")
        if wrong is None:
            return None
        names = self.of_class(wrong["class"])
        found = self.compute(build(self.folder, wrong, self.work, self.log), {name: readable(name) for name in names})
        return {"what": wrong["what"], "class": wrong["class"], "noticed": self.noticed(found), "cases": len(names)}


class Given:
    """A result that is no file."""

    def __init__(self, tangents):
        self.tangents, self.seconds, self.sha256 = tangents, None, None


def readable(name):
    """A case without its expected values, which a changed case does not have."""
    case = casefile.read(casefile.CASES / f"{name}.json")
    return {key: value for key, value in case.items() if key != "expected"}


def is_worse(right, measures):
    before = right["measures"]
    lost = any(not measures.passes(level, False) for level in right["levels"])
    return lost or measures.wrong_signs > before.wrong_signs or measures.wrong_angles > before.wrong_angles


def build(folder, wrong, work, log):
    """Copies what run.py has installed for an adapter, changes one operation, and gives the command that starts the copy."""
    right, copy = work / "adapters" / folder.name, work / "adapters-wrong" / folder.name
    shutil.rmtree(copy, ignore_errors=True)
    shutil.copytree(right, copy, symlinks=True, ignore=shutil.ignore_patterns("venv", "adapter"))
    if (right / "venv").exists():
        (copy / "venv").symlink_to(right / "venv")
    path = wrong["file"]
    if path.startswith("crate:"):
        name, _, path = path[len("crate:") :].partition("/")
        path = copy_crate(copy, name, log) / path
        # As for crates of the registry: lints that are younger than a crate do not stop its build.
        os.environ["RUSTFLAGS"] = "--cap-lints=allow"
    else:
        path = copy / path
    text = path.read_text(encoding="utf-8")
    if text.count(wrong["old"]) != 1:
        raise run.Unavailable(f"{path} has {text.count(wrong['old'])} times what the wrong build changes, not once")
    path.write_text(text.replace(wrong["old"], wrong["new"]), encoding="utf-8")
    # cargo compares times: what an earlier copy had changed must look new.
    for source in copy.rglob("*.rs"):
        source.touch()
    return run.start(copy, work, log)


def copy_crate(copy, name, log):
    """A copy of a crate that the adapter is built with instead of the one of the registry."""
    listed = run.output(["cargo", "metadata", "--format-version", "1", "--manifest-path", copy / "Cargo.toml"], log)
    (package,) = (package for package in json.loads(listed)["packages"] if package["name"] == name)
    crate = copy / name
    shutil.copytree(Path(package["manifest_path"]).parent, crate)
    manifest = copy / "Cargo.toml"
    manifest.write_text(manifest.read_text(encoding="utf-8") + f'\n[patch.crates-io]\n{name} = {{ path = "{name}" }}\n', encoding="utf-8")
    return crate


def prove(folder, work):
    """Runs an adapter wrongly and keeps the counts in its summary. Gives the ids of the runs that never fail."""
    adapter = json.loads((folder / "adapter.json").read_text(encoding="utf-8"))
    command = run.install(folder, work, work / f"{folder.name}-wrong.log")
    blind = []
    for entry in adapter["runs"]:
        proof = Adapter(folder, entry, work, command)
        inputs, wrong = proof.count_inputs(command), proof.count_build()
        file = run.summary_file(adapter, entry)
        summary = json.loads(file.read_text(encoding="utf-8"))
        summary["wrong"] = {"inputs": inputs, "build": wrong}
        file.write_text(run.dumps(summary), encoding="utf-8")
        noticed = ", ".join(f"{name} {count[0]}/{count[1]}" for name, count in inputs.items())
        print(f"{entry['id']}: {noticed}" + (f"; wrong build {wrong['noticed']}/{wrong['cases']}" if wrong else ""), flush=True)
        if not inputs["uvs-exchanged"][0] or (wrong and not wrong["noticed"]):
            blind.append(entry["id"])
    return blind


def main():
    work, names = run.arguments(__doc__)
    run.prepare(work)
    blind = []
    for folder in run.adapters(names):
        try:
            blind += prove(folder, work)
        except (run.Unavailable, judge.Unusable) as reason:
            print(f"skipped: {folder.name}: {reason}", flush=True)
            blind += [folder.name] if names else []
    if blind:
        print(f"not noticed or not run: {', '.join(blind)}", file=sys.stderr)
    return 1 if blind else 0


if __name__ == "__main__":
    sys.exit(main())
