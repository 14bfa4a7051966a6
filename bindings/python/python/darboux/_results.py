"""The named tuples that functions return. V: vertices before splitting, W: after splitting, C: corners."""

from typing import Any, Dict, Iterable, List, NamedTuple, Optional, Tuple

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float32]
Numbers = npt.NDArray[np.uint32]


class Frames(NamedTuple):
    """The whole frame of every corner."""

    tangent: Floats
    """(C, 4): the direction of increasing u, unit length, and the sign w, -1 where the UV map mirrors."""
    bitangent: Floats
    """(C, 3): the direction of increasing v, unit length, perpendicular to the normal but not always to the tangent."""
    magnitude: Floats
    """(C, 2): world units per unit of u and per unit of v."""


class Report(NamedTuple):
    """The counts of a run. Quads count as the two triangles that they are split into."""

    triangles: int
    """Triangles, quad halves included."""
    unsupported_faces: int
    """Faces with other than 3 or 4 corners; their tangents come from their normals only."""
    degenerate_triangles: int
    """Triangles with two equal positions."""
    uv_degenerate_triangles: int
    """Triangles, not degenerate, whose UVs span no area."""
    non_finite_corners: int
    """Corners with a NaN or an infinity in position, normal or UV."""
    repaired_corners: int
    """Corners whose reference tangent is absent or unusable. Replaced, but for mode='reference'."""
    mixed_sign_faces: int
    """Faces whose corners carry both signs; mode='corrected' gave them one."""
    mirrored_edges: int
    """Edges between two triangles of opposite UV orientation."""
    split_vertices: int
    """Vertices that need more than one tangent: what split_vertices splits."""
    merged_vertices: int
    """Vertices at which both UV orientations share one tangent: seams that method='lengyel-per-vertex' breaks."""


class VertexSplit(NamedTuple):
    """An indexed mesh's vertices after splitting. The old ones come first, in their old places."""

    tangent_of_vertex: Floats
    """(W, 4): unit xyz and sign w; (1, 0, 0, 1) for vertices that no corner uses."""
    indices: Numbers
    """The new vertex of each corner, in the shape of the old indices."""
    source_of_vertex: Numbers
    """(W,): the old vertex that each new one copies."""


class NormalSplit(NamedTuple):
    """An indexed mesh's vertices after splitting by normals. The old ones come first, in their old places."""

    normal_of_vertex: Floats
    """(W, 3): unit normals; (0, 0, 1) for vertices that no corner uses."""
    indices: Numbers
    """The new vertex of each corner, in the shape of the old indices."""
    source_of_vertex: Numbers
    """(W,): the old vertex that each new one copies."""


class NormalReport(NamedTuple):
    """What generate_normals met on the way."""

    faces: int
    """Faces, degenerate ones included."""
    degenerate_faces: int
    """Faces without an area, or with values that are not finite. They add nothing."""
    repaired_corners: int
    """Corners whose faces' normals cancel or are missing."""
    creased_edges: int
    """Edges between two faces at which smooth shading stops for their angle."""


class TangentDifference(NamedTuple):
    """How two sets of tangents of one mesh differ. Angles in degrees, between the xyz of a corner in both."""

    corners: int
    """The number of corners."""
    identical: int
    """Corners whose four floats are the same bits."""
    sign_flips: int
    """Corners whose signs differ."""
    without_angle: int
    """Corners where a tangent is zero or not finite. They are in none of the numbers below."""
    mean: float
    """The mean angle."""
    min: float
    """The smallest angle."""
    median: float
    """The angle that half of the corners do not exceed."""
    p95: float
    """The angle that 95 corners in 100 do not exceed."""
    max: float
    """The largest angle."""
    histogram: npt.NDArray[np.int64]
    """Corners up to 0, 0.001, 0.01, 0.1, 1, 5, 15, 45, 90 and 180 degrees."""
    worst: List[Tuple[int, float]]
    """The corners with the largest angles and these, the largest first."""


class UvFidelity(NamedTuple):
    """How well tangents follow the UVs: angles in degrees between the interpolated tangent and dP/du, over the surface."""

    mean: float
    """The mean angle, weighted by area."""
    root_mean_square: float
    """The root of the mean square of the angle."""
    area: float
    """The area that was measured."""
    unmeasured_triangles: int
    """Triangles that were not: without area, or without a dP/du."""


class Evidence(NamedTuple):
    """A number that supports a finding."""

    what: str
    """What was measured."""
    value: float
    """The value."""
    unit: str
    """The unit: 'degrees', 'corners', 'texels', '%' and so on; empty for ratios."""


class Change(NamedTuple):
    """What a repair did to the tangents of a primitive."""

    kind: str
    """'corrected_tangents': some were corrected, and the others kept; 'recomputed_tangents': all were computed again."""
    count: Optional[int] = None  # type: ignore[assignment]
    """The number of vertices whose tangents were corrected; None where all were computed again."""


class Finding(NamedTuple):
    """One thing that is wrong with a file, with the fields of `darboux check --json`. docs/check.md explains every code."""

    code: str
    """The kind, such as 'tangent-sign-flipped'. Codes are stable."""
    severity: str
    """'error': a picture is wrong; 'warning': it may be; 'info'; 'not-checked': a map in a format that is not read."""
    mesh: Optional[int]
    """The index of the mesh; None where the finding concerns none, as do the other indices."""
    mesh_name: Optional[str]
    """The name of the mesh."""
    primitive: Optional[int]
    """The index of the primitive in the mesh."""
    same_as: int
    """The number of further primitives with the same data."""
    material: Optional[int]
    """The index of the material."""
    image: Optional[int]
    """The index of the image."""
    count: int  # type: ignore[assignment]
    """The number of vertices, corners, triangles or texels that show it, as the text says. (It hides the method of tuples.)"""
    first: List[int]
    """The indices of the first ones."""
    first_are: str
    """What `first` numbers, where it has elements: 'triangles' or 'vertices'."""
    evidence: List[Evidence]
    """The numbers that support it."""
    text: str
    """What is wrong, in one sentence."""
    looks_like: str
    """What it looks like on screen."""
    cure: str
    """The cure."""
    fixable: bool
    """Whether fix and `darboux check --fix` repair it."""
    left_because: Optional[str]
    """Why they leave it, as a clause; None where they repair it."""
    source: Optional[str] = None
    """Where the primitive is in a file of another format, such as 'Armature/Body in your FBX'; None for glTF."""
    repaired: Optional[bool] = None
    """Whether fix repaired it; None from check."""
    change: Optional[Change] = None
    """What fix did to the tangents of the primitive; None for other findings, and where only signs were negated."""


class Findings(List[Finding]):
    """The findings of a file, and words about all of it."""

    diagnosis: str
    """What happened to the file, what it looks like and what to do, in one to three sentences."""
    importer_note: Optional[str]
    """What importers of another format make of the mistakes; None for glTF, and without mistakes."""
    warnings: List[str]
    """What a model of another format lost as it was read, such as textures that are missing; empty for glTF."""

    def __init__(
        self,
        findings: Iterable[Finding] = (),
        diagnosis: str = "",
        importer_note: Optional[str] = None,
        warnings: Iterable[str] = (),
    ) -> None:
        super().__init__(findings)
        self.diagnosis, self.importer_note, self.warnings = diagnosis, importer_note, list(warnings)


def findings_of(findings: List[Dict[str, Any]], **words: Any) -> Findings:
    """Findings from the fields of `darboux check --json`."""

    def finding(evidence: List[Dict[str, Any]], change: Optional[Dict[str, Any]] = None, **fields: Any) -> Finding:
        numbers = [Evidence(**number) for number in evidence]
        return Finding(**fields, evidence=numbers, change=Change(**change) if change else None)

    return Findings((finding(**fields) for fields in findings), **words)


class MapTiles(NamedTuple):
    """The tiles of a normal map and how each votes, at the size of the map whose mean is the correlation of the MapJudgement."""

    side: int
    """The texels of the map along a side of a tile."""
    columns: int
    """The tiles of a row. Tile i begins side * (i % columns) texels from the left and side * (i // columns) from the top."""
    correlations: List[Optional[float]]
    """From -1 (DirectX) to 1 (OpenGL), the top row first; None where a tile has no vote: one value, or mostly background or borders."""


class MapJudgement(NamedTuple):
    """The verdict on a normal map. Counts leave out black, white and middle grey texels."""

    verdict: str
    """'opengl' (green up), 'directx' (green down), 'no_gradient', 'flat' or 'cannot_tell'."""
    confidence: float
    """For 'opengl' and 'directx' an estimate of the probability that the verdict is right, 0.5 to 0.999."""
    correlation: float
    """The correlation of the mixed derivatives, from -1 (DirectX) to 1 (OpenGL)."""
    z_score: float
    """The correlation in units of its standard error."""
    log_energy_ratio: float
    """Negative where red and green are exchanged."""
    texels: int
    """All texels."""
    background: int
    """Black, white and middle grey texels, and those with z = 0 whose x and y are beyond the unit circle."""
    not_unit: int
    """Texels whose length is not in [0.9, 1.1]."""
    negative_z: int
    """Texels with z below -1/100."""
    grey: int
    """Texels whose three channels are nearly equal."""
    not_normal: int
    """Texels that cannot be normals."""
    tiles: MapTiles
    """The tiles and their votes."""


def judgement_of(tiles: Dict[str, Any], **fields: Any) -> MapJudgement:
    """A judgement from its fields."""
    return MapJudgement(**fields, tiles=MapTiles(**tiles))


class RecipeMatch(NamedTuple):
    """How well a way of computing tangents explains given ones."""

    method: str
    """As the parameter of generate_tangents."""
    mode: Optional[str]
    """The mode of 'mikktspace'."""
    flips_v: bool
    """Whether they were computed with 1 - v."""
    from_quads: bool
    """Whether they were computed before quads were cut into triangles, as Unity does; which were quads is an estimate."""
    writing: str
    """'corners': every corner has its own; 'last-corner' or 'first-corner' of each vertex decides."""
    bits: int
    """Bits per component: 32 (floats), 16 or 8."""
    corners: int
    """All corners."""
    identical: int
    """Corners with equal bits after rounding."""
    close: int
    """Corners within 0.1 degrees (1 degree for 8 bits) and with equal signs."""
    sign_flips: int
    """Corners whose signs differ."""
    worst: float
    """The largest angle in degrees."""


class Converted(NamedTuple):
    """Vertex data in another convention; None for what was not given."""

    positions: Optional[Floats]
    """(V, 3)."""
    normals: Optional[Floats]
    """(V, 3)."""
    uvs: Optional[Floats]
    """(V, 2)."""
    indices: Optional[Numbers]
    """In the shape of the old indices."""
    tangents: Optional[Floats]
    """(V, 4)."""
    inverts_red: bool
    """Whether red of normal maps leans the other way and must be inverted."""
    inverts_green: bool
    """Whether green does."""


class TransformedFrames(NamedTuple):
    """Normals and tangents under a matrix."""

    normals: Floats
    """(V, 3): unit length."""
    tangents: Floats
    """(V, 4): unit xyz, perpendicular to the normals, and the sign w."""
    orientation: float
    """-1 where the matrix mirrors, which also reverses the winding of faces; else 1."""


class BakeReport(NamedTuple):
    """The counts of a bake. A texel counts where at least one of its samples does."""

    charted_texels: int
    """Texels that triangles of the low mesh cover."""
    missed_texels: int
    """Of these, those without any hit. They are filled from around."""
    back_facing_texels: int
    """Of the missed texels, those whose rays met triangles from behind."""
    overlapping_texels: int
    """Texels that several triangles cover."""
    chart_area: int
    """The area of all charts in texels; greater than charted_texels where charts overlap or repeat."""
    inverted_texels: int
    """Texels at which the high mesh's normal points to the back of its triangle."""
    frameless_texels: int
    """Texels without a tangent frame."""
    below_horizon_texels: int
    """Texels whose normal points below the low mesh."""
    rays: int
    """Rays of samples."""
    degenerate_triangles: int
    """Triangles of the low mesh without an area in the image."""
    oversized_triangles: int
    """Triangles of the low mesh across more than 16 tiles of UVs. They are not baked."""
    non_finite_low_triangles: int
    """Triangles of the low mesh with positions or normals that are not finite. They are not baked."""
    non_finite_triangles: int
    """Triangles of the high mesh with positions that are not finite. No ray hits them."""


class ErrorStatistics(NamedTuple):
    """Statistics of angles in degrees; all are 0 where there are no points."""

    points: int
    """The number of points."""
    median: float
    """Half of the angles are smaller."""
    mean: float
    """The mean."""
    p95: float
    """95 % of the angles are smaller."""
    p99: float
    """99 % of the angles are smaller."""
    worst: float
    """The largest."""


class Verification(NamedTuple):
    """The angles between what a renderer shows and the normals of the high mesh."""

    all: ErrorStatistics
    """Of all points."""
    rounding: ErrorStatistics
    """Between the written map and the map before its components were rounded."""
    inside: ErrorStatistics
    """Where the filter reads texels with hits of their own: resolution and rounding."""
    border: ErrorStatistics
    """Where it also reads texels outside the chart."""
    missed: ErrorStatistics
    """Where it also reads texels whose rays missed."""
    overlap: ErrorStatistics
    """Where another triangle owns the texels."""
    other_bitangent: ErrorStatistics
    """What a renderer with the other bitangent would show, at all points."""
    other_green: ErrorStatistics
    """What a renderer with the other green would show."""
    normalised_frame: ErrorStatistics
    """What a renderer would show that normalises normal and tangent per pixel."""
    points_without_hit: int
    """Points whose ray hits nothing; they are not compared."""
    points_without_frame: int
    """Points without a tangent frame; they are not compared."""
    heat: Floats
    """(H, W): the largest error around each texel, NaN where no point lies; at most 2048 rows and columns."""


class ConvertedSpace(NamedTuple):
    """A normal map in another space."""

    texels: Floats
    """(H, W, 3): unit normals from -1 to 1, the top row first."""
    charted_texels: int
    """Texels that charts cover."""
    overlapping_texels: int
    """Texels that several triangles cover; the first triangle's frame counts."""
    invalid_texels: int
    """Texels without a frame, or whose vector has no direction."""


class AutoCage(NamedTuple):
    """A cage that was made."""

    positions: Floats
    """(V, 3): the vertices of the low mesh, moved."""
    least: float
    """The smallest distance, in units of the positions."""
    most: float
    """The largest distance."""
    inwards: float
    """How far inside the low mesh rays have to end."""


class LegendEntry(NamedTuple):
    """A colour of a map, and what it stands for."""

    id: int
    """The number of the material, mesh, part or chart."""
    name: Optional[str]
    """Its name; None where it has none."""
    color: Tuple[int, int, int]
    """Red, green and blue from 0 to 255."""
    texels: int
    """The number of texels."""


class BakedMaps(NamedTuple):
    """The images of a bake, the top row first; None for what was not chosen. H: rows, W: texels per row."""

    normal: Optional[Floats]
    """(H, W, 3): unit normals in tangent space, from -1 to 1."""
    object_normal: Optional[Floats]
    """(H, W, 3): unit normals along the axes of the target's convention."""
    height: Optional[Floats]
    """(H, W): the distance from the low mesh along the ray, positive outside."""
    ao: Optional[Floats]
    """(H, W): from 0, closed, to 1, open."""
    position: Optional[Floats]
    """(H, W, 3): positions along the axes of the target's convention."""
    states: npt.NDArray[np.uint8]
    """(H, W): 0 outside the charts, 1 baked, 2 beside a chart and baked on its continuation, 3 missed, 4 missed, but hit from behind."""
    report: BakeReport
    """The counts."""
    bent_normal: Optional[Floats] = None
    """(H, W, 3): unit vectors in tangent space: the mean of the open directions."""
    object_bent_normal: Optional[Floats] = None
    """(H, W, 3): the same along the axes of the target's convention."""
    thickness: Optional[Floats] = None
    """(H, W): the mean distance to the other side."""
    curvature: Optional[Floats] = None
    """(H, W): the mean curvature times the radius in which it is measured, convex above 0."""
    id: Optional[Floats] = None
    """(H, W, 3): one colour for each material, mesh or part; a high mesh of arrays has one."""
    vertex_color: Optional[Floats] = None
    """(H, W, 4): red, green, blue and alpha of the vertices."""
    base_color: Optional[Floats] = None
    """(H, W, 3): linear light."""
    opacity: Optional[Floats] = None
    """(H, W): from 0, transparent, to 1."""
    roughness: Optional[Floats] = None
    """(H, W): from 0 to 1."""
    metalness: Optional[Floats] = None
    """(H, W): from 0 to 1."""
    emission: Optional[Floats] = None
    """(H, W, 3): linear light."""
    texture: Optional[Floats] = None
    """(H, W, 4): the texture 'texture', as it is."""
    world_direction: Optional[Floats] = None
    """(H, W, 3): unit vectors in tangent space."""
    uv_islands: Optional[Floats] = None
    """(H, W, 3): one colour for each UV chart of the low mesh."""
    wireframe: Optional[Floats] = None
    """(H, W): 1 along the edges of the low mesh's triangles, 0 elsewhere."""
    legends: Dict[str, List[LegendEntry]] = {}
    """By the names of the maps 'id' and 'uv-islands', if they were chosen: what their colours stand for."""
    distance: Tuple[float, float] = (0.0, 0.0)
    """How far outside rays began and how far inside they ended, in units of the positions."""
    warnings: List[str] = []
    """What bake_models left out, one sentence each; empty for bake."""
