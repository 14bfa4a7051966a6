"""Runs the adapters that this machine can install, judges them, and keeps a summary of each in results/.

WORK gets what is installed and written; WORK/cases is made if it is missing. An adapter is a folder of adapters/ with adapter.json and one of:
run.mjs and package.json (npm), run.py and requirements.txt (venv and pip), Cargo.toml (cargo), Makefile (make). It runs as
`ADAPTER [ARGUMENTS] CASES RESULTS`. In adapter.json, "debian" lists packages of Debian that must be installed, "needs" environment variables that must be set, and "wrong" the wrong build of wrong.py.
"""

import argparse
import contextlib
import datetime
import json
import os
import platform
import shutil
import signal
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
    with open(log, "ab") as stream:
        finish(command, log, stdout=stream, stderr=stream, **options)


def output(command, log):
    """What a program prints."""
    with open(log, "ab") as errors:
        return finish(command, log, stdout=subprocess.PIPE, stderr=errors)


def finish(command, log, **options):
    """Runs a program to its end. After the time limit it is ended with all programs that it started."""
    try:
        program = subprocess.Popen(list(map(str, command)), stdin=subprocess.DEVNULL, start_new_session=True, **options)
    except FileNotFoundError:
        raise Unavailable(f"{command[0]} is missing") from None
    try:
        printed, _ = program.communicate(timeout=LIMIT)
    except subprocess.TimeoutExpired:
        raise Unavailable(f"{Path(command[0]).name} took more than {LIMIT} seconds") from None
    finally:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(program.pid, signal.SIGKILL)
        program.wait()
    if program.returncode:
        lines = Path(log).read_text(encoding="utf-8", errors="replace").strip().splitlines()
        raise Unavailable(f"{Path(str(command[0])).name} failed ({program.returncode}): {lines[-1][:200] if lines else ''}")
    return printed


def install(folder, work, log):
    """Copies an adapter to the work folder and installs what it needs; gives the command that starts it."""
    target = work / "adapters" / folder.name
    shutil.copytree(folder, target, dirs_exist_ok=True)
    check_debian(json.loads((folder / "adapter.json").read_text(encoding="utf-8")), log)
    if (folder / "package.json").exists() and not (target / "node_modules").exists():
        call(["npm", "install", "--no-audit", "--no-fund", "--loglevel=error"], log, cwd=target)
    if (folder / "requirements.txt").exists() and not (target / "venv/installed").exists():
        call([sys.executable, "-m", "venv", "--clear", target / "venv"], log)
        call([target / "venv/bin/python", "-m", "pip", "install", "--quiet", "--disable-pip-version-check", "-r", target / "requirements.txt"], log)
        (target / "venv/installed").touch()
    return start(target, work, log)


def start(target, work, log):
    """Builds an installed adapter where it must be built, and gives the command that starts it."""
    if (target / "Cargo.toml").exists():
        # One folder for the adapters and another for their wrong copies, whose programs have the same names.
        built = work / f"cargo-{target.parent.name}"
        call(["cargo", "build", "--quiet", "--release", "--manifest-path", target / "Cargo.toml", "--target-dir", built], log)
        return [built / "release" / target.name]
    if (target / "Makefile").exists():
        call(["make", "--silent", "-C", target], log)
        return [target / "adapter"]
    if (target / "package.json").exists():
        return ["node", target / "run.mjs"]
    return [target / "venv/bin/python" if (target / "venv").exists() else sys.executable, target / "run.py"]


def check_debian(adapter, log):
    """Packages of Debian are installed by the user; their version must be the one that the adapter names."""
    for package in adapter.get("debian", []):
        try:
            version = output(["dpkg-query", "--show", "--showformat=${Version}", package], log).decode()
        except Unavailable:
            version = ""
        if not version.startswith(adapter["version"]):
            raise Unavailable(f"it needs version {adapter['version']} of Debian's package {package}: apt-get install {package}")


def check_variables(adapter):
    """Adapters of Darboux find its interfaces by environment variables."""
    for variable in adapter.get("needs", []):
        if variable not in os.environ:
            raise Unavailable(f"the environment variable {variable} is not set; cargo xtask conformance sets it")


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


def run_adapter(folder, work, cases, machine):
    adapter = json.loads((folder / "adapter.json").read_text(encoding="utf-8"))
    log = work / f"{folder.name}.log"
    log.unlink(missing_ok=True)
    check_variables(adapter)
    command = install(folder, work, log)
    for run in adapter["runs"]:
        results = compute(command, run, work, log)
        summary = summarize(adapter, run, cases, results, machine)
        file = summary_file(adapter, run)
        if file.exists():
            summary["wrong"] = json.loads(file.read_text(encoding="utf-8")).get("wrong")
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(dumps(summary), encoding="utf-8")
        totals = {level: sum(own["levels"][level] for own in summary["classes"].values()) for level in judge.LEVELS}
        judged = sum(own["cases"] - own["skipped"] for own in summary["classes"].values())
        print(f"{run['name']} {summary['version']}: of {judged} cases " + ", ".join(f"{n} at {level}" for level, n in totals.items()) + f"; {summary.get('ns_per_triangle', '-')} ns per triangle", flush=True)


def prepare(work):
    """Writes what adapters read: the cases, and the readers that they compile or import."""
    if not (work / "cases").is_dir():
        generate.write_folder(work / "cases", True)
    shutil.copytree(HERE / "readers", work / "readers", dirs_exist_ok=True)


def compute(command, run, work, log):
    """The folder with the results of a run of an adapter."""
    results = work / "results" / run["id"]
    shutil.rmtree(results, ignore_errors=True)
    results.parent.mkdir(exist_ok=True)
    call([*command, *run["arguments"], work / "cases", results], log, cwd=work)
    return results


def summary_file(adapter, run):
    return HERE / "results" / run["id"] / f"{run.get('version', adapter.get('version'))}.json"


def dumps(summary):
    """JSON with one failing case per line."""
    failing = ",\n".join("  " + json.dumps(row) for row in summary["failing"])
    head = json.dumps({key: value for key, value in summary.items() if key != "failing"}, indent=1, ensure_ascii=False)
    return head[:-2] + ',\n "failing": [' + (f"\n{failing}\n " if failing else "") + "]\n}\n"


def this_machine():
    """The processor and the system."""
    return f"{processor()}, {platform.system()}"


def processor():
    with contextlib.suppress(OSError):
        for line in Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                return line.split(":")[1].strip()
    return platform.machine()


def adapters(names):
    """The folders of adapters, of all if no name is given."""
    folders = {path.parent.name: path.parent for path in sorted((HERE / "adapters").glob("*/adapter.json"))}
    for name in names:
        if name not in folders:
            sys.exit(f"{name} is not a folder in conformance/adapters: {', '.join(folders)}")
    return [folders[name] for name in names or folders]


def arguments(text):
    """The folder WORK and the names of the command line; `text` is its help."""
    parser = argparse.ArgumentParser(description=text, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("work", metavar="WORK", type=Path, help="a folder, which is made if it is missing")
    parser.add_argument("names", metavar="NAME", nargs="*", help="folders of adapters/; all if none is given")
    given = parser.parse_args()
    given.work.mkdir(parents=True, exist_ok=True)
    return given.work.resolve(), given.names


def main():
    work, names = arguments(__doc__)
    prepare(work)
    cases = judge.select(HERE / "cases", None)
    machine = this_machine()
    unavailable = {}
    for folder in adapters(names):
        try:
            run_adapter(folder, work, cases, machine)
        except (Unavailable, judge.Unusable) as reason:
            unavailable[folder.name] = str(reason)
            print(f"skipped: {folder.name}: {reason}", flush=True)
    return 1 if names and unavailable else 0


if __name__ == "__main__":
    sys.exit(main())
