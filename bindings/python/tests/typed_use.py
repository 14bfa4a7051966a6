"""Not run: checked, as the type checkers of users do."""

from pathlib import Path
from typing import List

import darboux
import numpy as np
import numpy.typing as npt

positions = np.zeros((3, 3))
tangents: npt.NDArray[np.float32] = darboux.generate_tangents(positions, positions, positions[:, :2], [0, 1, 2])
frames: darboux.Frames = darboux.generate_tangents(positions, positions, positions[:, :2], full=True)
with_report = darboux.generate_tangents(positions, positions, positions[:, :2], method="area", return_report=True)
degenerate: int = with_report[1].degenerate_triangles
split: darboux.VertexSplit = darboux.split_vertices([0, 1, 2], tangents, 3)
codes: npt.NDArray[np.int16] = darboux.encode.tangent_to_snorm16(split.tangent_of_vertex)
plan = darboux.Plan(positions, positions, positions[:, :2], faces=3)
moved: npt.NDArray[np.float32] = plan.evaluate(positions, positions)
document: darboux.Document = darboux.load(Path("model.glb"))
files: List[Path] = darboux.save(document, "out.glb", force=True)
found: List[darboux.Finding] = darboux.check("model.glb", maps=False)
repaired: List[darboux.Finding] = darboux.fix(darboux.load("model.glb"), only=["tangent-zero"])
verdict: str = darboux.judge_normal_map(np.zeros((4, 4, 3), np.uint8)).verdict
recipe: str = darboux.recognise_recipe(positions, positions, positions[:, :2], [0, 1, 2], tangents)[0].method
maps: darboux.BakedMaps = darboux.bake(
    positions, positions, positions[:, :2], [0, 1, 2], tangents, positions, size=(4, 4), distance=(1, 1), maps=["normal"]
)
missed: int = maps.report.missed_texels
of_models: darboux.BakedMaps = darboux.bake_models(Path("low.glb"), ["high.glb", b"glTF"], maps=["id"], match="name")
what: List[darboux.LegendEntry] = of_models.legends["id"]
