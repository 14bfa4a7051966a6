"""Draws one real model with the tangents of every adapter, beside those of mikktspace.c.

    python3 conformance/model.py WORK MODEL.glb [NAME ...]

The model is the one that model.json names; its file is not in this repository. WORK gets what is installed and written, the names are folders of adapters/ (all if none is given), and the environment variable DARBOUX
names the command `darboux` with the feature gpu, which draws. Writes results/model.json, and in results/model one picture per different result.
"""

import datetime
import hashlib
import json
import os
import shutil
import statistics
import subprocess
import sys
from pathlib import Path

import judge
import run
from casefile import write
from readers import gltf

HERE = run.HERE
NUMBERS, PICTURES = HERE / "results/model.json", HERE / "results/model"
REFERENCE = "mikktspace-c"
NAME = "model"


def case_of(model):
    """The meshes as a case. Vertices with the same position, normal and UV become one, as in a file that was written without tangents."""
    about = json.loads((HERE / "model.json").read_text(encoding="utf-8"))
    found = hashlib.sha256(Path(model).read_bytes()).hexdigest()
    if found != about["sha256"]:
        sys.exit(f"{model} is not the model of model.json: its SHA-256 is {found}")
    numbers, indices = {}, []
    for position, normal, uv, _ in gltf.read_glb(model, about["meshes"]):
        indices.append(numbers.setdefault((position, normal, uv), len(numbers)))
    columns = [list(map(list, column)) for column in zip(*numbers)]
    case = {"name": NAME, "class": "seams", "stage": "-", "shows": about["name"], "failure": "-", "threshold": 180.0}
    case |= dict(zip(("positions", "normals", "uvs"), columns))
    return about, {**case, "faces": [3] * (len(indices) // 3), "indices": indices}


def compute(names, work):
    """The results of all runs that this machine has, and why the others are missing."""
    runs, missing = [], []
    for folder in run.adapters(names):
        adapter = json.loads((folder / "adapter.json").read_text(encoding="utf-8"))
        for one in adapter["runs"]:
            about = {key: one.get(key, adapter.get(key)) for key in ("id", "name", "version", "claims", "ours")}
            about = {key: value for key, value in about.items() if value is not None}
            try:
                runs.append((about, result(folder, adapter, one, work)))
                print(f"{one['name']}: done", flush=True)
            except (run.Unavailable, judge.Unusable) as reason:
                missing.append({**about, "reason": str(reason)})
                print(f"skipped: {one['name']}: {reason}", flush=True)
    return runs, missing


def result(folder, adapter, one, work):
    """The tangents of one run per corner."""
    log = work / f"{folder.name}.log"
    run.check_variables(adapter)
    results = run.compute(run.install(folder, work, log), one, work, log)
    found = judge.Result(results / f"{NAME}.json", corners(work))
    if found.skipped is not None:
        raise run.Unavailable(found.skipped)
    return found.tangents


def corners(work):
    return len(json.loads((work / f"cases/{NAME}.json").read_text(encoding="utf-8"))["indices"])


def measured(case, tangents, reference):
    """The numbers of a result."""
    case = {**case, "expected": {"tangents": reference}}
    measures = judge.Measures()
    for found, expected in zip(tangents, reference):
        measures.corner(found, expected, [])
    measures.missing_splits = judge.missing_splits(case, tangents)
    angles = [judge.degrees(found, expected) for found, expected in zip(tangents, reference) if judge.is_unit(found) and judge.is_unit(expected)]
    numbers = measures.as_dict()
    del numbers["seconds"]
    level = next((level for level in judge.LEVELS if measures.passes(level, False)), "fails")
    return {**numbers, "median_angle": round(statistics.median(angles), 10) if angles else None, "level": level}


def draw(case, tangents, work, camera):
    """The name of the picture of a result, in work/pictures. Results that look alike to the last bit of a pixel share one."""
    model, picture = work / "drawn.glb", work / "drawn.png"
    gltf.write_glb(model, case, tangents)
    command = [os.environ["DARBOUX"], "render", model, "-o", picture, "--force", "--no-legend", "--view", "bumps", "--tangents", "file", "--size", "300x260", "--camera", camera]
    subprocess.run(list(map(str, command)), check=True, stdout=subprocess.DEVNULL)
    name = hashlib.sha256(picture.read_bytes()).hexdigest()[:12] + ".png"
    shutil.copyfile(picture, work / "pictures" / name)
    return name


def main():
    if len(sys.argv) < 3 or "DARBOUX" not in os.environ:
        sys.exit(__doc__)
    work, model, names = Path(sys.argv[1]).resolve(), sys.argv[2], sys.argv[3:]
    about, case = case_of(model)
    (work / "cases").mkdir(parents=True, exist_ok=True)
    write(work / f"cases/{NAME}.json", case)
    run.prepare(work)
    runs, missing = compute(names, work)
    reference = next((tangents for one, tangents in runs if one["id"] == REFERENCE), None)
    if reference is None:
        sys.exit("mikktspace.c gave no result: name the adapter crates, too")
    shutil.rmtree(work / "pictures", ignore_errors=True)
    (work / "pictures").mkdir()
    rows = [{**one, **measured(case, tangents, reference), "picture": draw(case, tangents, work, about["camera"])} for one, tangents in runs]
    on_seam = judge.missing_splits({**case, "expected": {"tangents": reference}}, [(*t[:3], 1.0) for t in reference])
    counts = {"triangles": len(case["faces"]), "vertices": len(case["positions"]), "on_seam": on_seam}
    shutil.rmtree(PICTURES, ignore_errors=True)
    shutil.copytree(work / "pictures", PICTURES)
    written = {"model": {**about, **counts}, "date": datetime.date.today().isoformat(), "machine": run.this_machine(), "runs": rows, "missing": missing}
    NUMBERS.write_text(json.dumps(written, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
