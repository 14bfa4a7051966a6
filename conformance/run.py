"""Runs the adapters that this machine can install, judges them, and keeps a summary of each in results/.

    python3 conformance/run.py WORK [NAME ...]

WORK is a folder for what is installed and written; WORK/cases is made if it is missing. NAME: adapters, all if none is given. An adapter
is a folder of adapters/ with adapter.json and one of: run.mjs and package.json (npm), run.py and requirements.txt (venv and pip),
Cargo.toml (cargo), Makefile (make). It runs as `ADAPTER [ARGUMENTS] CASES RESULTS`.
"""

import contextlib
import datetime
import json
import os
import platform
import shutil
import subprocess
import sys
from pathlib import Path

import casefile
import generate
import judge

HERE = Path(__file__).resolve().parent
TIMED = "large-terrain"
LIMIT = 900


class Unavailable(Exception):
    """Why an adapter cannot run here, in one sentence."""


def call(command, log, **options):
    """Runs a program and appends its output to a file; its failure is the reason why the adapter is unavailable."""
    with open(log, "ab") as output:
        try:
            done = subprocess.run(list(map(str, command)), stdin=subprocess.DEVNULL, stdout=output, stderr=output, timeout=LIMIT, check=False, **options)
        except FileNotFoundError:
            raise Unavailable(f"{command[0]} is missing") from None
        except subprocess.TimeoutExpired:
            raise Unavailable(f"{Path(command[0]).name} took more than {LIMIT} seconds") from None
    if done.returncode:
        lines = Path(log).read_text(encoding="utf-8", errors="replace").strip().splitlines()
        raise Unavailable(f"{Path(str(command[0])).name} failed ({done.returncode}): {lines[-1][:200] if lines else ''}")


def install(folder, work, log):
    """Copies an adapter to the work folder and installs what it needs; gives the command that starts it."""
    target = work / "adapters" / folder.name
    shutil.copytree(folder, target, dirs_exist_ok=True)
    if (folder / "package.json").exists():
        if not (target / "node_modules").exists():
            call(["npm", "install", "--no-audit", "--no-fund", "--loglevel=error"], log, cwd=target)
        return ["node", target / "run.mjs"]
    if (folder / "requirements.txt").exists():
        python = target / "venv/bin/python"
        if not (target / "venv/installed").exists():
            call([sys.executable, "-m", "venv", "--clear", target / "venv"], log)
            call([python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "-r", target / "requirements.txt"], log)
            (target / "venv/installed").touch()
        return [python, target / "run.py"]
    if (folder / "Cargo.toml").exists():
        built = work / "cargo"
        call(["cargo", "build", "--quiet", "--release", "--manifest-path", target / "Cargo.toml", "--target-dir", built], log)
        return [built / "release" / folder.name]
    if (folder / "Makefile").exists():
        call(["make", "--silent", "-C", target], log)
        return [target / "adapter"]
    return [sys.executable, target / "run.py"]


def summarize(adapter, run, cases, results, machine):
    """What the table and the page need: verdicts by class and level, and the failing cases with their tangents."""
    verdicts = judge.judge(cases, results, "bits", False)
    classes = judge.by_class(verdicts)
    for name, own in classes.items():
        of_class = [verdict for verdict in verdicts if verdict["class"] == name and verdict["skipped"] is None]
        own["levels"] = {level: sum(level in verdict["levels"] for verdict in of_class) for level in judge.LEVELS}
    by_name = {case["name"]: case for case in cases}
    failing = [failure(verdict, by_name[verdict["name"]], results) for verdict in verdicts if verdict.get("passed") is False]
    skipped = sorted({verdict["skipped"] for verdict in verdicts if verdict["skipped"] is not None})
    summary = {key: run.get(key, adapter.get(key)) for key in ("id", "name", "package", "version", "claims", "kind", "ours")}
    summary |= {"date": datetime.date.today().isoformat(), "machine": machine, "skipped": skipped, "classes": classes, "failing": failing}
    timed = json.loads((results / f"{TIMED}.json").read_text(encoding="utf-8"))
    if isinstance(timed.get("seconds"), float) and adapter.get("timed", True):
        corners = next(case["corners"] for case in cases if case["name"] == TIMED)
        summary["ns_per_triangle"] = round(timed["seconds"] * 1e9 / (corners / 3), 1)
    return {key: value for key, value in summary.items() if value is not None}


def failure(verdict, case, results):
    """A failing case; the tangents of a small one are kept where they are wrong at level angle, for the picture."""
    row = {"name": verdict["name"], "levels": verdict["levels"], "measures": verdict["measures"].as_dict()}
    del row["measures"]["seconds"]
    if "angle" not in verdict["levels"] and case["class"] != "large" and case["corners"] <= 150:
        tangents = judge.Result(results / f"{case['name']}.json", case["corners"]).tangents
        row["tangents"] = [[round(x, 3) if abs(x) < 10 else 0.0 for x in tangent] for tangent in tangents]
    return row


def wrong_cases(work, cases):
    """Copies of some cases with u and v exchanged: the same adapter on them must fail when judged by the right ones."""
    folder = work / "wrong"
    folder.mkdir(parents=True, exist_ok=True)
    for case in cases:
        if case["class"] in ("core", "seams"):
            wrong = casefile.read(work / "cases" / f"{case['name']}.json")
            wrong["uvs"] = [[v, u] for u, v in wrong["uvs"]]
            casefile.write(folder / f"{case['name']}.json", wrong)
    return folder


def run_adapter(folder, work, cases, machine):
    adapter = json.loads((folder / "adapter.json").read_text(encoding="utf-8"))
    log = work / f"{folder.name}.log"
    log.unlink(missing_ok=True)
    for variable in adapter.get("needs", []):
        if variable not in os.environ:
            raise Unavailable(f"the environment variable {variable} is not set; cargo xtask conformance sets it")
    command = install(folder, work, log)
    for run in adapter["runs"]:
        results, wrong = work / "results" / run["id"], work / "results-wrong" / run["id"]
        for place, source in ((results, work / "cases"), (wrong, wrong_cases(work, cases))):
            shutil.rmtree(place, ignore_errors=True)
            call([*command, *run["arguments"], source, place], log, cwd=work)
        summary = summarize(adapter, run, cases, results, machine)
        basic = [case for case in cases if case["class"] in ("core", "seams")]
        summary["fails_when_wrong"] = sum("seams" not in verdict.get("levels", []) for verdict in judge.judge(basic, wrong, "seams", False))
        if not summary["fails_when_wrong"]:
            raise Unavailable("the judge does not notice exchanged UVs: the adapter does not read its cases")
        file = HERE / "results" / run["id"] / f"{summary['version']}.json"
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(dumps(summary), encoding="utf-8")
        totals = {level: sum(own["levels"][level] for own in summary["classes"].values()) for level in judge.LEVELS}
        judged = sum(own["cases"] - own["skipped"] for own in summary["classes"].values())
        print(f"{run['name']} {summary['version']}: of {judged} cases " + ", ".join(f"{n} at {level}" for level, n in totals.items()) + f"; {summary.get('ns_per_triangle', '-')} ns per triangle", flush=True)


def dumps(summary):
    """JSON with one failing case per line."""
    failing = ",\n".join("  " + json.dumps(row) for row in summary["failing"])
    head = json.dumps({key: value for key, value in summary.items() if key != "failing"}, indent=1, ensure_ascii=False)
    return head[:-2] + ',\n "failing": [' + (f"\n{failing}\n " if failing else "") + "]\n}\n"


def processor():
    with contextlib.suppress(OSError):
        for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                return line.split(":")[1].strip()
    return platform.machine()


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    work, names = Path(sys.argv[1]).resolve(), sys.argv[2:]
    if not (work / "cases").is_dir():
        generate.write_folder(work / "cases", True)
    shutil.copytree(HERE / "readers", work / "readers", dirs_exist_ok=True)
    cases = judge.select(HERE / "cases", None)
    machine = f"{processor()}, {platform.system()}"
    unavailable = {}
    for folder in sorted((HERE / "adapters").iterdir()):
        if (folder / "adapter.json").exists() and (not names or folder.name in names):
            try:
                run_adapter(folder, work, cases, machine)
            except (Unavailable, judge.Unusable) as reason:
                unavailable[folder.name] = str(reason)
                print(f"skipped: {folder.name}: {reason}", flush=True)
    return 1 if names and unavailable else 0


if __name__ == "__main__":
    sys.exit(main())
