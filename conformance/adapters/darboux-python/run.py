import os
import subprocess
import sys
from pathlib import Path

if "DARBOUX_STARTED" not in os.environ:
    # The interpreter that has the package runs this file again.
    environment = {**os.environ, "DARBOUX_STARTED": "1"}
    sys.exit(subprocess.run([os.environ["DARBOUX_PYTHON"], *sys.argv], env=environment, check=False).returncode)

sys.path.insert(0, str(Path(__file__).parents[2] / "readers"))
import darboux
import numpy as np
from case import run


def compute(case):
    if not case["faces"]:
        return []
    if not np.isfinite(case["threshold"]):
        raise ValueError("skip: the package refuses thresholds that are not finite")
    arrays = [np.array(case[key], dtype=np.float32) for key in ("positions", "normals", "uvs")]
    indices, faces = (np.array(case[key], dtype=np.uint32) for key in ("indices", "faces"))
    return darboux.generate_tangents(*arrays, indices, faces=faces, mode="reference", threshold=case["threshold"], threads=1)


run(compute)
