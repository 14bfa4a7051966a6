"""Tangent frames for normal mapping: MikkTSpace bit for bit, and the vertex splitting that its seams demand.

Arrays in, arrays out. Tangents come one per corner (a vertex of one face); split_vertices goes back to an indexed mesh:

>>> import darboux, numpy as np
>>> positions = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]])
>>> normals = np.array([[0, 0, 1]] * 4)
>>> uvs = positions[:, :2]
>>> indices = np.array([[0, 1, 2], [0, 2, 3]])
>>> tangents = darboux.generate_tangents(positions, normals, uvs, indices)
>>> split = darboux.split_vertices(indices, tangents, len(positions))
>>> split.tangent_of_vertex
array([[1., 0., 0., 1.],
       [1., 0., 0., 1.],
       [1., 0., 0., 1.],
       [1., 0., 0., 1.]], dtype=float32)
>>> positions = positions[split.source_of_vertex]
"""

from . import encode
from ._batch import bake_job, batch
from ._darboux import (
    CONVENTIONS,
    Document,
    Plan,
    __version__,
    auto_cage,
    bake,
    check,
    convert,
    convert_space,
    convert_texels,
    dumps,
    fix,
    generate_normals,
    generate_tangents,
    judge_normal_map,
    load,
    loads,
    measure_tangents,
    measure_uv_fidelity,
    recognise_recipe,
    save,
    skin_frames,
    split_normals,
    split_vertices,
    transform_frames,
    udim_tiles,
    verify,
)
from ._process import process
from ._results import (
    AutoCage,
    BakedMaps,
    BakeReport,
    Change,
    Converted,
    ConvertedSpace,
    ErrorStatistics,
    Evidence,
    Finding,
    Findings,
    Frames,
    MapJudgement,
    MapTiles,
    NormalReport,
    NormalSplit,
    RecipeMatch,
    Report,
    TangentDifference,
    TransformedFrames,
    UvFidelity,
    Verification,
    VertexSplit,
)

__all__ = [
    "CONVENTIONS",
    "AutoCage",
    "BakeReport",
    "BakedMaps",
    "Change",
    "Converted",
    "ConvertedSpace",
    "Document",
    "ErrorStatistics",
    "Evidence",
    "Finding",
    "Findings",
    "Frames",
    "MapJudgement",
    "MapTiles",
    "NormalReport",
    "NormalSplit",
    "Plan",
    "RecipeMatch",
    "Report",
    "TangentDifference",
    "TransformedFrames",
    "UvFidelity",
    "Verification",
    "VertexSplit",
    "__version__",
    "auto_cage",
    "bake",
    "bake_job",
    "batch",
    "check",
    "convert",
    "convert_space",
    "convert_texels",
    "dumps",
    "encode",
    "fix",
    "generate_normals",
    "generate_tangents",
    "judge_normal_map",
    "load",
    "loads",
    "measure_tangents",
    "measure_uv_fidelity",
    "process",
    "recognise_recipe",
    "save",
    "skin_frames",
    "split_normals",
    "split_vertices",
    "transform_frames",
    "udim_tiles",
    "verify",
]
