"""Writes the expected values of every case from a folder of results of mikktspace.c, and of Darboux's modes `repaired` and `corrected`; `cargo xtask conformance --regenerate` runs it.
"""

import argparse
import hashlib
import json
import sys
from pathlib import Path

import casefile
from generate import SAMPLES


def expected(case, result):
    """The expected values: all of a small case, hash and sample of a large one."""
    keys = (*casefile.OUTPUTS, *casefile.MODES)
    rows = {key: [[casefile.f32(float(x)) for x in row] for row in result[key]] for key in keys}
    if case["class"] != "large":
        return without_equal_modes(rows)
    digest = hashlib.sha256(casefile.words(rows["tangents"])).hexdigest()
    corners = list(range(0, len(rows["tangents"]), max(1, len(rows["tangents"]) // SAMPLES)))
    sampled = {key: [rows[key][at] for at in corners] for key in ("tangents", *casefile.MODES)}
    return {"sha256": digest, "sample": {"corners": corners, **without_equal_modes(sampled)}}


def without_equal_modes(rows):
    """The rows without the modes that give what mikktspace.c gives."""
    words = {key: [list(map(casefile.word, row)) for row in rows[key]] for key in ("tangents", *casefile.MODES)}
    return {key: rows[key] for key in rows if key in casefile.OUTPUTS or words[key] != words["tangents"]}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", metavar="RESULTS", type=Path, help="the folder with what mikktspace.c gives")
    parser.add_argument("--check", action="store_true", help="change nothing; fail if something would change")
    given = parser.parse_args()
    changed = []
    for path in sorted(casefile.CASES.glob("*.json")):
        case, before = casefile.read(path), path.read_text(encoding="utf-8")
        result = json.loads((given.results / path.name).read_text(encoding="utf-8"))
        case["expected"] = expected(case, result)
        if case["class"] == "large":
            case["corners"] = len(result["tangents"])
        casefile.write(path, case)
        if path.read_text(encoding="utf-8") != before:
            changed.append(case["name"])
            if given.check:
                path.write_text(before, encoding="utf-8")
    if given.check and changed:
        sys.exit(f"these cases are not what mikktspace.c gives: {', '.join(changed)}")
    print(f"{len(changed)} cases changed")


if __name__ == "__main__":
    main()
