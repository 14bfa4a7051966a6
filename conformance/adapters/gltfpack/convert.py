import os
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "readers"))
import case as reader
from gltf import check, read_glb, tangents_per_corner, write_glb

FOLDER = Path(tempfile.mkdtemp())
reader.REPETITIONS = 1


def compute(case):
    check(case)
    write_glb(FOLDER / "in.glb", case)
    command = ["node", os.environ["GLTFPACK"], "-i", FOLDER / "in.glb", "-o", FOLDER / "out.glb", "-noq", "-gt", "-kv", "-km"]
    (FOLDER / "out.glb").unlink(missing_ok=True)
    subprocess.run(command, check=False, stdout=subprocess.DEVNULL)
    corners = read_glb(FOLDER / "out.glb") if (FOLDER / "out.glb").exists() else []
    return tangents_per_corner(case, corners)


reader.run(compute)
