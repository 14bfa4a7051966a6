"""Reads a case and writes a result, for adapters in Python. Copy it. Licence: CC0."""

import json
import math
import struct
import sys
import time
from pathlib import Path

REPETITIONS = 5


def read_case(path):
    """A case whose numbers are rounded to single precision."""
    case = json.loads(Path(path).read_text(encoding="utf-8"))
    rounded = struct.Struct("<f")
    for key in ("positions", "normals", "uvs"):
        case[key] = [[rounded.unpack(rounded.pack(float(x)))[0] for x in row] for row in case[key]]
    case["threshold"] = float(case["threshold"])
    return case


def write_result(path, tangents, seconds=None, indices=None):
    """Writes tangents, four numbers each: per corner, or per vertex with the new index of each corner."""
    result = {"tangents": [[x if math.isfinite(x) else str(x) for x in map(float, row)] for row in tangents]}
    if seconds is not None:
        result["seconds"] = seconds
    if indices is not None:
        result["indices"] = [int(index) for index in indices]
    Path(path).write_text(json.dumps(result), encoding="utf-8")


def run(compute):
    """Runs an adapter `CASES RESULTS`: calls compute(case) for every case, which gives tangents per corner, or a dictionary: "tangents",
    "indices" where these are per vertex, and "seconds" where compute measured the time itself.

    An exception of compute whose first argument starts with "skip: " skips the case.
    """
    cases, results = Path(sys.argv[1]), Path(sys.argv[2])
    results.mkdir(parents=True, exist_ok=True)
    for path in sorted(cases.glob("*.json")):
        case = read_case(path)
        try:
            found, seconds = timed(compute, case)
        except ValueError as error:
            if not str(error).startswith("skip: "):
                raise
            (results / path.name).write_text(json.dumps({"skipped": str(error)[6:]}), encoding="utf-8")
            continue
        write_result(results / path.name, found["tangents"], seconds, found.get("indices"))


def timed(compute, case):
    """The result as a dictionary, and the least processor time of several runs of a large case."""
    times = []
    for _ in range(REPETITIONS if case["class"] == "large" else 1):
        start = time.process_time()
        found = compute(case)
        times.append(time.process_time() - start)
        found = found if isinstance(found, dict) else {"tangents": found}
        times[-1] = found.pop("seconds", times[-1])
    return found, min(times)
