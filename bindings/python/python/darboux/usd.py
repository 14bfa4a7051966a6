"""Tangents for USD: meshes, prims, stages and files (usda, usdc, usdz), with the package usd-core.

Tangents are written as `primvars:tangents` (vector3f[], unit length) and `primvars:tangentSigns` (float[], 1 or -1, so that
bitangent = sign * cross(normal, tangent)), both faceVarying. USD's UVs run up, as Blender's, so that fresh tangents are written as they are.

No specification says which tangents a USD normal map means; Storm computes MikkTSpace's. Faces of five and more corners are cut into the fan
around their first corner, as Hydra cuts them.
"""

import os
import shutil
import tempfile
import zipfile
from pathlib import Path
from typing import Any, Callable, Dict, Iterator, List, NamedTuple, Optional, Tuple, Union

import numpy as np
import numpy.typing as npt
from pxr import Sdf, Usd, UsdGeom, UsdShade, UsdUtils

from . import _polygons
from ._darboux import generate_normals
from ._polygons import PolygonTangents
from ._results import Floats

TANGENTS, SIGNS = "tangents", "tangentSigns"
"""The names of the primvars."""

ENDINGS = [".usd", ".usda", ".usdc", ".usdz"]

MOST_CORNERS = 1 << 28
"""The most corners of a mesh at all its times together. Samples that are equal take no room in a file, but 16 bytes per corner here."""

Array = npt.NDArray[Any]


class UsdMesh(NamedTuple):
    """What became of one mesh."""

    path: str
    """The path of its prim."""
    corners: int
    """How many corners got tangents."""
    cut_faces: int
    """Faces of five and more corners, which were cut."""
    skipped_because: Optional[str]
    """Why it got no tangents; None where it did."""


class _Skipped(ValueError):
    """Why a mesh gets no tangents; a clause whose subject is the mesh."""


def corner_tangents(
    mesh: Any, uv_set: Optional[str] = None, time: Optional[float] = None, **options: Any
) -> PolygonTangents:
    """Compute the tangent of every corner of a mesh, in the order of its faceVertexIndices.

    Parameters
    ----------
    mesh : pxr.UsdGeom.Mesh
        Meshes without normals have those of their faces, as USD says.
    uv_set : str, optional
        The name of a primvar of UVs. Without, the one that the normal map of the mesh's material reads; then "st"; then the first one.
    time : float, optional
        A time code; without, the default value, or the first sample of points without one.
    **options
        As for generate_tangents: method, mode, threshold, threads.

    Raises
    ------
    ValueError
        The mesh has no faces or no UVs, arrays of wrong lengths, or is a subdivision surface: tangents of its cage are not those of the
        smooth surface. Set its subdivisionScheme to "none" if it is drawn as a polygon mesh.
    """
    mesh = UsdGeom.Mesh(mesh)
    try:
        code = Usd.TimeCode(time) if time is not None else _times(mesh)[0]
        return _compute(mesh, uv_set, code, options)
    except _Skipped as reason:
        raise ValueError(f"the mesh {mesh.GetPath()} {reason}") from None


def add_tangents(target: Any, uv_set: Optional[str] = None, **options: Any) -> List[UsdMesh]:
    """Write tangents to a mesh, or to all meshes below a prim or of a stage, at each time at which points have a value.

    Opinions go to the stage's edit target. Nothing is saved; `process` reads and writes files.

    Parameters
    ----------
    target : pxr.Usd.Stage, pxr.Usd.Prim or pxr.UsdGeom.Mesh
    uv_set, **options
        As for corner_tangents.

    Returns
    -------
    list of UsdMesh
        One for each mesh, in the order of the stage. Meshes that cannot have tangents are skipped, with the reason.
    """
    return [_add(mesh, uv_set, options) for mesh in _meshes(target)]


def process(
    path: Union[str, "os.PathLike[str]"],
    output: Union[str, "os.PathLike[str]", None] = None,
    uv_set: Optional[str] = None,
    *,
    force: bool = False,
    **options: Any,
) -> List[UsdMesh]:
    """Read a USD file and write a copy of its root layer with tangents; usdz packages are written whole.

    Parameters
    ----------
    path : path-like
        .usd, .usda, .usdc or .usdz.
    output : path-like, optional
        Without, model.usda becomes model.tangents.usda beside it. Relative paths of other layers and textures are kept valid.
    force : bool
        Replace an output that exists.
    uv_set, **options
        As for corner_tangents.

    Raises
    ------
    FileExistsError, FileNotFoundError
        The output exists; there is no input.
    ValueError
        USD cannot read or write the file; a usdz is read but another kind is to be written, or the other way round; a usdz has members that leave
        its folder, or refers to files outside; the output has another ending than USD's. After an error nothing is left.
    """
    path = Path(path)
    output = path.with_name(f"{path.stem}.tangents{path.suffix}") if output is None else Path(output)
    if path.exists() and not path.is_file():
        raise ValueError(f"{path}: is not a regular file; save its content as one")
    if not path.is_file():
        raise FileNotFoundError(f"{path}: there is no such file; check its name and folder")
    if not output.parent.is_dir():
        raise FileNotFoundError(f"{output}: its folder does not exist; make it, or choose another output")
    if output.exists() and not output.is_file():
        raise ValueError(f"{output}: exists and is not a regular file; choose another output")
    if output.exists() and not force:
        raise FileExistsError(f"{output}: the file exists; choose another output, or force=True")
    if output.suffix.lower() not in ENDINGS:
        raise ValueError(f"{output}: USD is written to {', '.join(ENDINGS)}; give the output one of these endings")
    if (path.suffix.lower() == ".usdz") != (output.suffix.lower() == ".usdz"):
        raise ValueError(f"{output}: a usdz is written from a usdz only; give the output the ending of the input")
    # Complete or absent: the result is made in a folder beside the output and renamed.
    with tempfile.TemporaryDirectory(prefix=".darboux-", dir=output.parent) as folder:
        made = Path(folder) / output.name
        if path.suffix.lower() == ".usdz":
            summary = _process_package(path, made, Path(folder) / "package", uv_set, options)
        else:
            stage = _open(path, path)
            summary = add_tangents(stage, uv_set, **options)
            layer = Sdf.Layer.CreateAnonymous(".usda")
            layer.TransferContent(stage.GetRootLayer())
            _move_paths(layer, path.parent, output.parent)
            _written(lambda: layer.Export(str(made)), output)
        os.replace(made, output)
    return summary


def _process_package(package: Path, made: Path, folder: Path, uv_set: Optional[str], options: Any) -> List[UsdMesh]:
    try:
        with zipfile.ZipFile(package) as archive:
            members = archive.infolist()
            # Members of a usdz are stored, so that the unpacked files are no larger than the package.
            if any(member.compress_type != zipfile.ZIP_STORED for member in members):
                raise ValueError(f"{package}: has compressed members, which a usdz must not have; make it again with usdzip")
            if sum(member.file_size for member in members) > package.stat().st_size:
                raise ValueError(f"{package}: has members over the same bytes; make it again with usdzip")
            for member in members:
                if not _stays_inside(member.filename):
                    raise ValueError(f"{package}: has a member that leaves its folder, {member.filename[:200]!r}; make it again with usdzip")
            archive.extractall(folder)
    except (zipfile.BadZipFile, RuntimeError):
        raise ValueError(f"{package}: is not a usdz package, which is a zip archive without a password; export it again") from None
    except OSError as error:
        raise ValueError(f"{package}: cannot be unpacked: {error.strerror or error}; make it again with usdzip") from None
    first = next((member.filename for member in members if not member.is_dir()), None)
    if first is None:
        raise ValueError(f"{package}: is an empty package; export it again")
    stage = _open(folder / first, package)
    summary = add_tangents(stage, uv_set, **options)
    _written(lambda: stage.GetRootLayer().Save(), package)
    del stage
    _written(lambda: UsdUtils.CreateNewUsdzPackage(Sdf.AssetPath(str(folder / first)), str(made), first), package)
    with zipfile.ZipFile(made) as archive:
        # USD also packs files of this machine that a package from elsewhere names.
        others = set(archive.namelist()) - {member.filename for member in members}
    if others:
        raise ValueError(f"{package}: refers to files outside the package, such as {min(others)[:200]!r}; remove these references")
    shutil.rmtree(folder)
    return summary


def _stays_inside(name: str) -> bool:
    """Whether the name of a member of a package is a path below the package, on every system."""
    parts = name.rstrip("/").split("/")
    return not any(part in ("", ".", "..") or "\\" in part or ":" in part or "\0" in part for part in parts)


def _written(write: Callable[[], bool], shown: Path) -> None:
    """Calls a function of USD that writes a file, and returns or raises where it cannot."""
    try:
        is_written, reason = write(), ""
    except Exception as error:  # pxr.Tf.ErrorException
        is_written, reason = False, f": {str(error).strip().splitlines()[-1].strip()}"
    if not is_written:
        raise ValueError(f"{shown}: USD cannot write it{reason}")


def _open(file: Path, shown: Path) -> Any:
    try:
        stage = Usd.Stage.Open(str(file))
    except Exception as error:  # pxr.Tf.ErrorException
        reason = str(error).strip().splitlines()[-1].strip()
        raise ValueError(f"{shown}: USD cannot read it: {reason}") from None
    return stage


def _move_paths(layer: Any, source: Path, destination: Path) -> None:
    """Keeps relative asset paths valid in another folder."""
    if source.resolve() == destination.resolve():
        return

    def moved(path: str) -> str:
        # Absolute paths, URIs, and search paths that are not files in the folder stay.
        is_relative = path and not os.path.isabs(path) and "://" not in path and (source / path).exists()
        return os.path.relpath(source.resolve() / path, destination.resolve()).replace(os.sep, "/") if is_relative else path

    UsdUtils.ModifyAssetPaths(layer, moved)


def _meshes(target: Any) -> Iterator[Any]:
    if isinstance(target, UsdGeom.Mesh):
        yield target
        return
    if isinstance(target, Usd.Stage):
        target = target.GetPseudoRoot()
    for prim in Usd.PrimRange(target, Usd.TraverseInstanceProxies(Usd.PrimDefaultPredicate)):
        if prim.IsA(UsdGeom.Mesh):
            yield UsdGeom.Mesh(prim)


def _add(mesh: Any, uv_set: Optional[str], options: Any) -> UsdMesh:
    path = str(mesh.GetPath())
    if mesh.GetPrim().IsInstanceProxy():
        return UsdMesh(path, 0, 0, "is part of an instance; add tangents to the file that it refers to")
    try:
        times, found, corners = _times(mesh), [], 0
        for time in times:
            found.append((time, _compute(mesh, uv_set, time, options)))
            corners = max(corners, len(found[-1][1].tangents))
            if corners * len(times) > MOST_CORNERS:
                raise _Skipped(f"has {len(times)} times of {corners} corners, more than {MOST_CORNERS} corners together; split it")
    except _Skipped as reason:
        return UsdMesh(path, 0, 0, str(reason))
    primvars = UsdGeom.PrimvarsAPI(mesh)
    columns: List[Tuple[str, Any, Callable[[Floats], Floats]]] = [
        (TANGENTS, Sdf.ValueTypeNames.Vector3fArray, lambda tangents: tangents[:, :3]),
        (SIGNS, Sdf.ValueTypeNames.FloatArray, lambda tangents: tangents[:, 3]),
    ]
    for name, kind, column in columns:
        primvar = primvars.CreatePrimvar(name, kind, UsdGeom.Tokens.faceVarying)
        if primvar.IsIndexed():
            primvar.BlockIndices()
        attribute = primvar.GetAttr()
        # Tangents that the mesh has may be of another type, such as float4[], and have samples at other times.
        attribute.Clear()
        attribute.SetTypeName(kind)
        primvar.SetElementSize(1)
        for time, result in found:
            attribute.Set(np.ascontiguousarray(column(result.tangents)), time)
    _, first = found[0]
    return UsdMesh(path, len(first.tangents), first.cut_faces, None)


def _times(mesh: Any) -> List[Any]:
    """The samples of points and normals, or the default time."""
    attributes = [mesh.GetPointsAttr(), mesh.GetNormalsAttr(), UsdGeom.PrimvarsAPI(mesh).GetPrimvar("normals").GetAttr()]
    samples = {time for attribute in attributes if attribute for time in attribute.GetTimeSamples()}
    return [Usd.TimeCode(time) for time in sorted(samples)] or [Usd.TimeCode.Default()]


def _compute(mesh: Any, uv_set: Optional[str], time: Any, options: Any) -> PolygonTangents:
    if mesh.GetSubdivisionSchemeAttr().Get() != UsdGeom.Tokens.none:
        raise _Skipped('is a subdivision surface; set its subdivisionScheme to "none" if it is drawn as a polygon mesh')
    points = np.array(mesh.GetPointsAttr().Get(time) or (), np.float32).reshape(-1, 3)
    sizes = np.array(mesh.GetFaceVertexCountsAttr().Get(time) or (), np.int64)
    vertices = np.array(mesh.GetFaceVertexIndicesAttr().Get(time) or (), np.int64)
    if not len(sizes):
        raise _Skipped("has no faces")
    if (sizes < 0).any() or sizes.sum() != len(vertices):
        raise _Skipped("has faceVertexCounts that do not add up to the number of its faceVertexIndices; export it again")
    if (vertices < 0).any() or (vertices >= len(points)).any():
        raise _Skipped("has faceVertexIndices that are no points; export it again")
    uvs = _per_corner(_uv_primvar(mesh, uv_set), time, sizes, vertices, len(points), 2)
    # A left-handed mesh winds clockwise around its normals: its faces are flipped, and its tangents put back in order.
    order = np.arange(len(vertices))
    if mesh.GetOrientationAttr().Get() == UsdGeom.Tokens.leftHanded:
        first = np.repeat(np.cumsum(sizes) - sizes, sizes)
        order = 2 * first + np.repeat(sizes, sizes) - 1 - order
    positions = points[vertices]
    normals = _normals(mesh, time, sizes, vertices, len(points))
    if normals is None:
        indices, counts = np.arange(len(vertices), dtype=np.uint32), sizes.astype(np.uint32)
        normals = generate_normals(positions[order], indices, faces=counts, shading="flat")
    else:
        normals = normals[order]
    found = _polygons.corner_tangents(positions[order], normals, uvs[order], sizes, _polygons.fans(sizes), **options)
    return found._replace(tangents=found.tangents[order])


def _normals(mesh: Any, time: Any, sizes: Array, vertices: Array, points: int) -> Optional[Array]:
    primvar = UsdGeom.PrimvarsAPI(mesh).GetPrimvar("normals")
    if primvar and primvar.HasValue():
        return _per_corner(primvar, time, sizes, vertices, points, 3)
    values = mesh.GetNormalsAttr().Get(time)
    if not values:
        return None
    return _expand("normals", np.array(values, np.float32), mesh.GetNormalsInterpolation(), sizes, vertices, points, 3)


def _uv_primvar(mesh: Any, uv_set: Optional[str]) -> Any:
    primvars = UsdGeom.PrimvarsAPI(mesh)
    if uv_set is not None:
        primvar = primvars.FindPrimvarWithInheritance(uv_set)
        if not (primvar and primvar.HasValue()):
            raise _Skipped(f"has no UV set named {uv_set!r}")
        return primvar
    named = [primvars.FindPrimvarWithInheritance(name) for name in (_uvs_of_normal_map(mesh), "st") if name]
    kinds = (Sdf.ValueTypeNames.TexCoord2fArray, Sdf.ValueTypeNames.TexCoord2dArray, Sdf.ValueTypeNames.TexCoord2hArray)
    others = [primvar for primvar in primvars.GetPrimvarsWithValues() if primvar.GetTypeName() in kinds]
    for primvar in named + others:
        if primvar and primvar.HasValue():
            return primvar
    raise _Skipped("has no UVs; unwrap it first")


def _uvs_of_normal_map(mesh: Any) -> Optional[str]:
    """The primvar that the normal map of a UsdPreviewSurface reads."""
    material = UsdShade.MaterialBindingAPI(mesh.GetPrim()).ComputeBoundMaterial()[0]
    shader: Any = material.ComputeSurfaceSource()[0] if material else None
    # Surface, texture, and a transform of UVs or none, then the reader of the primvar.
    for name in ["normal", "st", "in"]:
        shader = _source(shader, name) or (shader if name == "in" else None)
        if not shader:
            return None
    varname = shader.GetInput("varname")
    value = varname.Get() if varname else None
    if not value and varname and varname.HasConnectedSource():
        attributes = varname.GetValueProducingAttributes()
        value = attributes[0].Get() if attributes else None
    return str(value) if value else None


def _source(shader: Any, name: str) -> Any:
    entry = shader.GetInput(name) if shader else None
    if not (entry and entry.HasConnectedSource()):
        return None
    return UsdShade.Shader(entry.GetConnectedSource()[0].GetPrim())


def _per_corner(primvar: Any, time: Any, sizes: Array, vertices: Array, points: int, width: int) -> Array:
    values = primvar.ComputeFlattened(time)
    name, interpolation = primvar.GetPrimvarName(), primvar.GetInterpolation()
    return _expand(name, np.array(values or (), np.float32), interpolation, sizes, vertices, points, width)


def _expand(name: str, values: Array, interpolation: str, sizes: Array, vertices: Array, points: int, width: int) -> Array:
    """The value of each corner."""
    corners = len(vertices)
    tables: Dict[str, Tuple[int, Callable[[], Array]]] = {
        UsdGeom.Tokens.faceVarying: (corners, lambda: np.arange(corners)),
        UsdGeom.Tokens.vertex: (points, lambda: vertices),
        UsdGeom.Tokens.varying: (points, lambda: vertices),
        UsdGeom.Tokens.uniform: (len(sizes), lambda: np.repeat(np.arange(len(sizes)), sizes)),
        UsdGeom.Tokens.constant: (1, lambda: np.zeros(corners, np.int64)),
    }
    if interpolation not in tables:
        raise _Skipped(f"has {name} with the interpolation {interpolation!r}, which USD does not know; export it again")
    count, table = tables[interpolation]
    if values.size != count * width:
        raise _Skipped(f"has {len(values)} {name} where its {interpolation} interpolation needs {count}; export it again")
    expanded: Array = values.reshape(-1, width)[table()]
    return expanded
