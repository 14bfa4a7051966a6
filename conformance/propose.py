"""Proposes cases: random meshes on which two implementations differ, shrunk to the smallest that still shows it.

The proposals are written to WORK/proposed with the values of the twin as expected; give them a name and sentences, and move them to cases/.
"""

import argparse
import json
import math
import random
import shutil
import sys
from pathlib import Path

import casefile
import run
from judge import Result, bits
from twin import Mesh, Twin

PALETTES = ((0.0, 1.0, -1.0, 0.5, -0.0, 2.0), (0.0, -0.0, 1.0, -1.0), tuple(k / 8 for k in range(-8, 9)))
NORMALS = ([0.0, 0.0, 1.0], [0.0, 0.0, 0.0], [1.0, 0.0, -0.0])
SIMPLE = (0.0, 1.0, 2.0, 0.5, -1.0)
PROPOSALS = 5


def draw(dice):
    """A mesh of a few triangles, whose numbers come from small sets so that ties and repeats are common."""
    spaces = [dice.choice(PALETTES) for _ in range(2)]
    positions = [[dice.choice(spaces[0]) for _ in range(3)] for _ in range(dice.randint(3, 8))]
    uvs = [[dice.choice(spaces[1]) for _ in range(2)] for _ in range(dice.randint(2, 8))]
    count, free = dice.randint(3, 10), dice.random() < 0.5
    case = {"threshold": 180.0, "positions": [], "normals": [], "uvs": []}
    for at in range(count):
        k = dice.randrange(len(positions)) if free else at % len(positions)
        case["positions"].append(list(positions[k]))
        case["normals"].append(list(dice.choice(NORMALS)))
        case["uvs"].append(list(uvs[dice.randrange(len(uvs)) if free else k % len(uvs)]))
    return with_faces(case, [[dice.randrange(count) for _ in range(3)] for _ in range(dice.randint(1, 12))])


def with_faces(case, faces):
    """The case with other faces and only the vertices that they use."""
    used = list(dict.fromkeys(index for face in faces for index in face))
    arrays = {key: [list(case[key][index]) for index in used] for key in casefile.INPUTS}
    return {**case, **arrays, "faces": [len(face) for face in faces], "indices": [used.index(index) for face in faces for index in face]}


def smaller(case):
    """Every case with a face less, with two vertices merged, or with a simpler number."""
    faces = [case["indices"][at : at + 3] for at in range(0, len(case["indices"]), 3)]
    for at in range(len(faces)):
        yield with_faces(case, faces[:at] + faces[at + 1 :])
    for b in range(len(case["positions"])):
        for a in range(b):
            yield with_faces(case, [[a if index == b else index for index in face] for face in faces])
    for key in casefile.INPUTS:
        for vertex, row in enumerate(case[key]):
            for axis, x in enumerate(row):
                simpler = SIMPLE[: SIMPLE.index(x)] if x in SIMPLE and not (x == 0.0 and math.copysign(1.0, x) < 0) else SIMPLE
                for number in simpler:
                    changed = {**case, key: [list(other) for other in case[key]]}
                    changed[key][vertex][axis] = number
                    yield changed


class Pair:
    """Two implementations, started once per batch of cases."""

    def __init__(self, work, names):
        self.work, self.log = work, work / "propose.log"
        self.commands = [self.command(name) for name in names]

    def command(self, name):
        for folder in sorted((run.HERE / "adapters").iterdir()):
            for entry in json.loads((folder / "adapter.json").read_text(encoding="utf-8"))["runs"]:
                if entry["id"] == name:
                    return [*run.install(folder, self.work, self.log), *entry["arguments"]]
        sys.exit(f"{name} is not the id of an adapter in conformance/adapters")

    def differing(self, batch):
        """The cases of a batch whose results differ, in order."""
        cases = self.work / "batch"
        shutil.rmtree(cases, ignore_errors=True)
        cases.mkdir()
        for at, case in enumerate(batch):
            about = {"name": f"c{at:05}", "class": "degenerate", "stage": "", "shows": "", "failure": ""}
            casefile.write(cases / f"c{at:05}.json", {**about, **case})
        results = [self.work / f"batch-{number}" for number in range(2)]
        for command, folder in zip(self.commands, results):
            shutil.rmtree(folder, ignore_errors=True)
            run.call([*command, cases, folder], self.log, cwd=self.work)
        for at, case in enumerate(batch):
            a, b = (Result(folder / f"c{at:05}.json", len(case["indices"])).tangents for folder in results)
            if a and b and list(map(bits, a)) != list(map(bits, b)):
                yield case


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("work", metavar="WORK", type=Path, help="the folder of run.py")
    parser.add_argument("first", metavar="A", help="the id of results, as darboux-reference or bevy_mikktspace")
    parser.add_argument("second", metavar="B", help="another id")
    parser.add_argument("meshes", metavar="MESHES", type=int, nargs="?", default=500, help="how many random meshes are tried; by default 500")
    parser.add_argument("seed", metavar="SEED", type=int, nargs="?", default=1, help="where the random numbers start; by default 1")
    return parser.parse_args()


def main():
    given = arguments()
    work, meshes, seed = given.work.resolve(), given.meshes, given.seed
    shutil.copytree(run.HERE / "readers", work / "readers", dirs_exist_ok=True)
    pair, dice = Pair(work, [given.first, given.second]), random.Random(seed)
    found = list(pair.differing([draw(dice) for _ in range(meshes)]))
    print(f"{len(found)} of {meshes} random meshes differ")
    out = work / "proposed"
    out.mkdir(exist_ok=True)
    for number, case in enumerate(found[:PROPOSALS]):
        while (next_case := next(pair.differing(list(smaller(case))), None)) is not None:
            case = next_case
        spaces = Twin(Mesh(case)).spaces()
        tangents = [[*s, 1.0 if preserves else -1.0] for s, _, _, preserves in spaces]
        expected = {"tangents": tangents, "bitangents": [list(t) for _, t, _, _ in spaces], "magnitudes": [list(m) for _, _, m, _ in spaces]}
        about = {"name": f"proposal-{number}", "class": "degenerate", "stage": "?", "shows": "?", "failure": "?"}
        path = out / f"{about['name']}.json"
        casefile.write(path, {**about, **case, "expected": expected})
        print(f"{path}: {len(case['faces'])} triangles, {len(case['positions'])} vertices")


if __name__ == "__main__":
    main()
