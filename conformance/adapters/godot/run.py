import struct
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "readers"))
import case as reader

FOLDER = Path(tempfile.mkdtemp())
LIMIT = 20
reader.REPETITIONS = 1


def check(case):
    if set(case["faces"]) - {3}:
        raise ValueError("skip: triangles only")
    if case["threshold"] != 180.0:
        raise ValueError("skip: no angular threshold")
    if not case["faces"]:
        raise ValueError("skip: no meshes without triangles")


def write_mesh(folder, case):
    folder.mkdir(exist_ok=True)
    rows = [[*case["positions"][i], *case["normals"][i], *case["uvs"][i]] for i in case["indices"]]
    (folder / f"{case['name']}.mesh").write_bytes(b"".join(struct.pack("<8f", *row) for row in rows))


def is_finite(case):
    return all(x - x == 0.0 for key in ("positions", "normals", "uvs") for row in case[key] for x in row)


def godot(folder, limit):
    """Computes the meshes of a folder. What it did not come to has no result."""
    try:
        subprocess.run(["godot3-server", "--path", Path(__file__).parent, "--script", "run.gd", folder], check=True, timeout=limit)
    except (subprocess.TimeoutExpired, subprocess.CalledProcessError) as error:
        print(folder.name, error, file=sys.stderr)


def compute(case):
    check(case)
    folder = FOLDER / ("finite" if is_finite(case) else case["name"])
    if folder.name == case["name"]:
        # Some of these do not end, so each has a process of its own.
        write_mesh(folder, case)
        godot(folder, LIMIT)
    file = folder / f"{case['name']}.tangents"
    if not file.exists():
        return [(float("nan"),) * 4] * len(case["indices"])
    # Godot's v points down, so its sign is the negated one.
    return [(x, y, z, -w) for x, y, z, w in struct.iter_unpack("<4f", file.read_bytes())]


for path in Path(sys.argv[1]).glob("*.json"):
    case = reader.read_case(path)
    try:
        check(case)
    except ValueError:
        continue
    if is_finite(case):
        write_mesh(FOLDER / "finite", case)
if (FOLDER / "finite").exists():
    godot(FOLDER / "finite", None)
reader.run(compute)
