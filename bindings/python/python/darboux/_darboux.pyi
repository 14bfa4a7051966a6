import os
from pathlib import Path
from typing import Any, Callable, Dict, Iterable, List, Literal, Mapping, Optional, Sequence, Tuple, Union, final, overload

import numpy as np
import numpy.typing as npt

from ._choices import (
    AssumedMap,
    Bitangent,
    IdSource,
    MapConvention,
    MapKind,
    Method,
    Mode,
    NormalWeight,
    OcclusionFalloff,
    OcclusionWeights,
    PartMatch,
    Shading,
    SmoothingSeams,
    TangentEncoding,
)
from ._results import (
    AutoCage,
    BakedMaps,
    Converted,
    ConvertedSpace,
    Findings,
    Frames,
    MapJudgement,
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

_Floats = npt.NDArray[np.float32]
_Path = Union[str, "os.PathLike[str]"]
_Progress = Callable[[int, int], object]

__all__ = [
    "CONVENTIONS",
    "DistributedBatch",
    "DistributedJob",
    "Document",
    "MODEL_ENDINGS",
    "Plan",
    "__version__",
    "auto_cage",
    "bake",
    "bake_models",
    "check",
    "convert",
    "convert_space",
    "convert_texels",
    "dumps",
    "failed_task",
    "fix",
    "frame_from_quaternion",
    "frame_to_quaternion",
    "generate_normals",
    "generate_tangents",
    "judge_normal_map",
    "load",
    "loads",
    "measure_tangents",
    "measure_uv_fidelity",
    "normal_from_octahedral",
    "normal_to_octahedral",
    "recognise_recipe",
    "run",
    "run_task",
    "save",
    "skin_frames",
    "split_normals",
    "split_vertices",
    "tangent_from_diamond",
    "tangent_from_octahedral",
    "tangent_from_snorm10",
    "tangent_from_snorm16",
    "tangent_from_snorm8",
    "tangent_to_diamond",
    "tangent_to_octahedral",
    "tangent_to_snorm10",
    "tangent_to_snorm16",
    "tangent_to_snorm8",
    "transform_frames",
    "udim_tiles",
    "verify",
]
MODEL_ENDINGS: str
__version__: str
CONVENTIONS: Tuple[str, ...]

@overload
def generate_tangents(
    positions: npt.ArrayLike,
    normals: npt.ArrayLike,
    uvs: npt.ArrayLike,
    indices: Optional[npt.ArrayLike] = None,
    *,
    faces: Optional[npt.ArrayLike] = None,
    method: Method = "mikktspace",
    mode: Mode = "repaired",
    threshold: float = 180.0,
    full: Literal[False] = False,
    threads: Optional[int] = None,
    out: Optional[_Floats] = None,
    return_report: Literal[False] = False,
) -> _Floats: ...
@overload
def generate_tangents(
    positions: npt.ArrayLike,
    normals: npt.ArrayLike,
    uvs: npt.ArrayLike,
    indices: Optional[npt.ArrayLike] = None,
    *,
    faces: Optional[npt.ArrayLike] = None,
    method: Method = "mikktspace",
    mode: Mode = "repaired",
    threshold: float = 180.0,
    full: Literal[False] = False,
    threads: Optional[int] = None,
    out: Optional[_Floats] = None,
    return_report: Literal[True],
) -> Tuple[_Floats, Report]: ...
@overload
def generate_tangents(
    positions: npt.ArrayLike,
    normals: npt.ArrayLike,
    uvs: npt.ArrayLike,
    indices: Optional[npt.ArrayLike] = None,
    *,
    faces: Optional[npt.ArrayLike] = None,
    method: Method = "mikktspace",
    mode: Mode = "repaired",
    threshold: float = 180.0,
    full: Literal[True],
    threads: Optional[int] = None,
    out: None = None,
    return_report: Literal[False] = False,
) -> Frames: ...
@overload
def generate_tangents(
    positions: npt.ArrayLike,
    normals: npt.ArrayLike,
    uvs: npt.ArrayLike,
    indices: Optional[npt.ArrayLike] = None,
    *,
    faces: Optional[npt.ArrayLike] = None,
    method: Method = "mikktspace",
    mode: Mode = "repaired",
    threshold: float = 180.0,
    full: Literal[True],
    threads: Optional[int] = None,
    out: None = None,
    return_report: Literal[True],
) -> Tuple[Frames, Report]: ...
def split_vertices(indices: npt.ArrayLike, tangents: npt.ArrayLike, vertex_count: int) -> VertexSplit: ...
def split_normals(indices: npt.ArrayLike, normals: npt.ArrayLike, vertex_count: int) -> NormalSplit: ...
@overload
def generate_normals(
    positions: npt.ArrayLike,
    indices: Optional[npt.ArrayLike] = None,
    *,
    faces: Optional[npt.ArrayLike] = None,
    shading: Shading = "smooth",
    weight: NormalWeight = "angle",
    crease: float = 180.0,
    seams: SmoothingSeams = "ignored",
    return_report: Literal[False] = False,
) -> _Floats: ...
@overload
def generate_normals(
    positions: npt.ArrayLike,
    indices: Optional[npt.ArrayLike] = None,
    *,
    faces: Optional[npt.ArrayLike] = None,
    shading: Shading = "smooth",
    weight: NormalWeight = "angle",
    crease: float = 180.0,
    seams: SmoothingSeams = "ignored",
    return_report: Literal[True],
) -> Tuple[_Floats, NormalReport]: ...
def measure_tangents(a: npt.ArrayLike, b: npt.ArrayLike) -> TangentDifference: ...
def measure_uv_fidelity(
    positions: npt.ArrayLike,
    uvs: npt.ArrayLike,
    indices: Optional[npt.ArrayLike],
    tangents: npt.ArrayLike,
    *,
    faces: Optional[npt.ArrayLike] = None,
) -> UvFidelity: ...
def convert(
    source: str,
    target: str,
    *,
    positions: Optional[npt.ArrayLike] = None,
    normals: Optional[npt.ArrayLike] = None,
    uvs: Optional[npt.ArrayLike] = None,
    indices: Optional[npt.ArrayLike] = None,
    tangents: Optional[npt.ArrayLike] = None,
    faces: Optional[npt.ArrayLike] = None,
    generated: bool = False,
) -> Converted: ...
def convert_texels(texels: npt.ArrayLike, source: str, target: str) -> npt.NDArray[Any]: ...
def transform_frames(matrix: npt.ArrayLike, normals: npt.ArrayLike, tangents: npt.ArrayLike) -> TransformedFrames: ...
def skin_frames(
    bones: npt.ArrayLike,
    joints: npt.ArrayLike,
    weights: npt.ArrayLike,
    normals: npt.ArrayLike,
    tangents: npt.ArrayLike,
) -> Tuple[_Floats, _Floats]: ...
@final
class Plan:
    def __new__(
        cls,
        positions: npt.ArrayLike,
        normals: npt.ArrayLike,
        uvs: npt.ArrayLike,
        indices: Optional[npt.ArrayLike] = None,
        *,
        faces: Optional[npt.ArrayLike] = None,
        method: Method = "mikktspace",
        mode: Mode = "repaired",
        threshold: float = 180.0,
        threads: Optional[int] = None,
    ) -> "Plan": ...
    @property
    def base(self) -> _Floats: ...
    @property
    def report(self) -> Report: ...
    def evaluate(
        self,
        positions: npt.ArrayLike,
        normals: npt.ArrayLike,
        *,
        threads: Optional[int] = None,
        out: Optional[_Floats] = None,
    ) -> _Floats: ...
    def count_regrouped(self, positions: npt.ArrayLike, normals: npt.ArrayLike) -> int: ...
@final
class Document:
    @property
    def is_changed(self) -> bool: ...
    @property
    def warnings(self) -> List[str]: ...
    @property
    def primitive_counts(self) -> List[int]: ...
    def arrays(self, mesh: int = 0, primitive: int = 0) -> Dict[str, npt.NDArray[Any]]: ...
    def inspect(self) -> List[Dict[str, Any]]: ...
    def add_tangents(
        self,
        *,
        method: Method = "mikktspace",
        mode: Mode = "repaired",
        threshold: float = 180.0,
        encoding: TangentEncoding = "f32x4",
        overwrite: bool = False,
        only_needed: bool = False,
        strict: bool = False,
        apply_texture_transform: bool = False,
        progress: Optional[_Progress] = None,
    ) -> Dict[str, Any]: ...
    def add_normals(
        self,
        *,
        shading: Shading = "smooth",
        weight: NormalWeight = "angle",
        crease: float = 180.0,
        seams: SmoothingSeams = "ignored",
        overwrite: bool = False,
        progress: Optional[_Progress] = None,
    ) -> Dict[str, Any]: ...
    def convert(self, source: str, target: str, *, progress: Optional[_Progress] = None) -> Dict[str, Any]: ...

def load(path: _Path, *, allow_outside: bool = False, memory_limit: Optional[int] = None) -> Document: ...
def loads(
    data: bytes, *, name: str = "<bytes>", base: Optional[_Path] = None, memory_limit: Optional[int] = None
) -> Document: ...
def dumps(document: Document) -> bytes: ...
def save(document: Document, path: _Path, *, force: bool = False) -> List[Path]: ...
@final
class DistributedJob:
    def __new__(cls, job: _Path, options: List[str]) -> "DistributedJob": ...
    @property
    def tasks(self) -> List[str]: ...
    def record(self, result: str) -> None: ...
    def close(self) -> None: ...

@final
class DistributedBatch:
    def __new__(cls, inputs: Sequence[_Path], folder: _Path, options: Sequence[str]) -> "DistributedBatch": ...
    @property
    def tasks(self) -> List[str]: ...
    @property
    def failed(self) -> List[str]: ...
    def record(self, result: str) -> None: ...
    def close(self) -> None: ...

def run_task(task: str, threads: int) -> str: ...
def failed_task(task: str, reason: str) -> str: ...
def run(arguments: Sequence[str]) -> int: ...
def tangent_to_snorm8(tangents: npt.ArrayLike) -> npt.NDArray[np.int8]: ...
def tangent_from_snorm8(codes: npt.NDArray[np.int8]) -> _Floats: ...
def tangent_to_snorm16(tangents: npt.ArrayLike) -> npt.NDArray[np.int16]: ...
def tangent_from_snorm16(codes: npt.NDArray[np.int16]) -> _Floats: ...
def tangent_to_snorm10(tangents: npt.ArrayLike) -> npt.NDArray[np.uint32]: ...
def tangent_from_snorm10(codes: npt.NDArray[np.uint32]) -> _Floats: ...
def tangent_to_octahedral(tangents: npt.ArrayLike) -> npt.NDArray[np.int16]: ...
def tangent_from_octahedral(codes: npt.NDArray[np.int16]) -> _Floats: ...
def normal_to_octahedral(normals: npt.ArrayLike) -> npt.NDArray[np.int16]: ...
def normal_from_octahedral(codes: npt.NDArray[np.int16]) -> _Floats: ...
def tangent_to_diamond(normals: npt.ArrayLike, tangents: npt.ArrayLike) -> npt.NDArray[np.uint16]: ...
def tangent_from_diamond(normals: npt.ArrayLike, codes: npt.NDArray[np.uint16]) -> _Floats: ...
def frame_to_quaternion(normals: npt.ArrayLike, tangents: npt.ArrayLike) -> npt.NDArray[np.int16]: ...
def frame_from_quaternion(codes: npt.NDArray[np.int16]) -> Tuple[_Floats, _Floats]: ...

def bake(
    positions: npt.ArrayLike,
    normals: npt.ArrayLike,
    uvs: npt.ArrayLike,
    indices: Optional[npt.ArrayLike],
    tangents: npt.ArrayLike,
    high_positions: npt.ArrayLike,
    high_indices: Optional[npt.ArrayLike] = None,
    high_normals: Optional[npt.ArrayLike] = None,
    *,
    size: Tuple[int, int],
    distance: Tuple[float, float],
    cage: Union[npt.ArrayLike, float, None] = None,
    maps: Sequence[MapKind] = ...,
    samples: int = 1,
    source: str = "gltf",
    target: str = "gltf",
    bitangent: Bitangent = "pixel",
    padding: Optional[int] = None,
    back_faces: bool = False,
    ao_rays: int = 64,
    ao_distance: float = ...,
    ao_falloff: OcclusionFalloff = "none",
    ao_weights: OcclusionWeights = "cosine",
    thickness_distance: float = ...,
    curvature_radius: float = 4.0,
    curvature_unit: Literal["texels", "distance"] = "texels",
    world_direction: Tuple[float, float, float] = ...,
    skew: Union[float, npt.ArrayLike, None] = None,
    udim: Optional[int] = None,
    high_colors: Optional[npt.ArrayLike] = None,
    high_uvs: Optional[npt.ArrayLike] = None,
    high_textures: Optional[Mapping[str, npt.NDArray[np.uint8]]] = None,
    threads: Optional[int] = None,
) -> BakedMaps: ...
def bake_models(
    low: Union[_Path, bytes, bytearray],
    high: Union[_Path, bytes, bytearray, Iterable[Union[_Path, bytes, bytearray]]],
    *,
    size: Tuple[int, int] = ...,
    cage_offset: Optional[float] = None,
    auto_cage: Optional[float] = None,
    cage: Union[_Path, bytes, bytearray, None] = None,
    skew: Union[float, npt.NDArray[np.uint8], None] = None,
    distance: Optional[Tuple[float, float]] = None,
    maps: Sequence[MapKind] = ...,
    samples: int = 1,
    target: str = "gltf",
    bitangent: Bitangent = "pixel",
    padding: Optional[int] = None,
    back_faces: bool = False,
    ao_rays: int = 64,
    ao_distance: float = ...,
    ao_falloff: OcclusionFalloff = "none",
    ao_weights: OcclusionWeights = "cosine",
    thickness_distance: float = ...,
    curvature_radius: float = 4.0,
    curvature_unit: Literal["texels", "distance"] = "texels",
    world_direction: Tuple[float, float, float] = ...,
    udim: Optional[int] = None,
    material: Optional[int] = None,
    uv_set: Optional[int] = None,
    match: PartMatch = "nearest",
    high_maps: bool = True,
    ao_own_part: bool = False,
    id_from: IdSource = "material",
    texture: Optional[str] = None,
    allow_outside: bool = False,
    memory_limit: Optional[int] = None,
    progress: Optional[_Progress] = None,
    threads: Optional[int] = None,
) -> BakedMaps: ...
def verify(
    positions: npt.ArrayLike,
    normals: npt.ArrayLike,
    uvs: npt.ArrayLike,
    indices: Optional[npt.ArrayLike],
    tangents: npt.ArrayLike,
    high_positions: npt.ArrayLike,
    high_indices: Optional[npt.ArrayLike] = None,
    high_normals: Optional[npt.ArrayLike] = None,
    *,
    baked: BakedMaps,
    written: Optional[npt.ArrayLike] = None,
    distance: Tuple[float, float],
    cage: Union[npt.ArrayLike, float, None] = None,
    source: str = "gltf",
    target: str = "gltf",
    bitangent: Bitangent = "pixel",
    back_faces: bool = False,
    skew: Union[float, npt.ArrayLike, None] = None,
    udim: Optional[int] = None,
    threads: Optional[int] = None,
) -> Verification: ...
def convert_space(
    positions: npt.ArrayLike,
    normals: npt.ArrayLike,
    uvs: npt.ArrayLike,
    indices: Optional[npt.ArrayLike],
    tangents: npt.ArrayLike,
    texels: npt.ArrayLike,
    *,
    to: Literal["tangent", "object"],
    mesh: str = "gltf",
    source: str = "gltf",
    target: str = "gltf",
    bitangent: Bitangent = "pixel",
    padding: Optional[int] = None,
    udim: Optional[int] = None,
    threads: Optional[int] = None,
) -> ConvertedSpace: ...
def auto_cage(
    positions: npt.ArrayLike,
    normals: npt.ArrayLike,
    uvs: npt.ArrayLike,
    indices: Optional[npt.ArrayLike],
    tangents: npt.ArrayLike,
    high_positions: npt.ArrayLike,
    high_indices: Optional[npt.ArrayLike] = None,
    high_normals: Optional[npt.ArrayLike] = None,
    *,
    reach: float,
    share: float = 0.001,
    threads: Optional[int] = None,
) -> AutoCage: ...
def udim_tiles(
    positions: npt.ArrayLike,
    normals: npt.ArrayLike,
    uvs: npt.ArrayLike,
    indices: Optional[npt.ArrayLike] = None,
    *,
    source: str = "gltf",
) -> List[int]: ...
def check(
    source: Union[_Path, Document],
    *,
    convention: MapConvention = "opengl",
    maps: bool = True,
    assume: Optional[AssumedMap] = None,
    allow_outside: bool = False,
    memory_limit: Optional[int] = None,
) -> Findings: ...
def fix(
    document: Document,
    *,
    convention: MapConvention = "opengl",
    maps: bool = True,
    assume: Optional[AssumedMap] = None,
    method: Method = "mikktspace",
    only: Optional[Iterable[str]] = None,
) -> Findings: ...
def judge_normal_map(texels: npt.ArrayLike) -> MapJudgement: ...
def recognise_recipe(
    positions: npt.ArrayLike,
    normals: npt.ArrayLike,
    uvs: npt.ArrayLike,
    indices: Optional[npt.ArrayLike],
    tangents: npt.ArrayLike,
    *,
    faces: Optional[npt.ArrayLike] = None,
) -> List[RecipeMatch]: ...
