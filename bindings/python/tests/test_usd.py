"""The adapter to USD, where usd-core is installed."""

import os
import shutil
import zipfile
from pathlib import Path
from typing import Any, Dict, List, Tuple

import darboux
import numpy as np
import pytest
from conftest import ROOT, bits

pytest.importorskip("pxr", reason="usd-core is not installed")
from pxr import Sdf, Usd, UsdGeom, Vt  # noqa: E402

import darboux.usd  # noqa: E402

SCENE = ROOT / "assets/blender"
Corner = Tuple[bytes, bytes, bytes]


def plane(stage: Any, path: str = "/Plane") -> Any:
    """A strip of a quad and a pentagon whose texture is mirrored at x = 0."""
    mesh = UsdGeom.Mesh.Define(stage, path)
    mesh.CreateSubdivisionSchemeAttr("none")
    points = [(-1, 0, 0), (0, 0, 0), (1, 0, 0), (1, 1, 0), (0.5, 2, 0), (0, 1, 0), (-1, 1, 0)]
    mesh.CreatePointsAttr(points)
    mesh.CreateFaceVertexCountsAttr([4, 5])
    mesh.CreateFaceVertexIndicesAttr([0, 1, 5, 6, 1, 2, 3, 4, 5])
    mesh.CreateNormalsAttr([(0, 0, 1)] * len(points))
    mesh.SetNormalsInterpolation("vertex")
    uvs = UsdGeom.PrimvarsAPI(mesh).CreatePrimvar("st", Sdf.ValueTypeNames.TexCoord2fArray, "vertex")
    uvs.Set([(abs(x), y) for x, y, _ in points])
    return mesh


def written(mesh: Any) -> np.ndarray:
    primvars = UsdGeom.PrimvarsAPI(mesh)
    directions, signs = (primvars.GetPrimvar(name) for name in ("tangents", "tangentSigns"))
    assert directions.GetInterpolation() == signs.GetInterpolation() == "faceVarying"
    return np.hstack([np.array(directions.ComputeFlattened()), np.array(signs.ComputeFlattened())[:, None]])


def test_a_mesh_gets_primvars() -> None:
    stage = Usd.Stage.CreateInMemory()
    mesh = plane(stage)
    [made] = darboux.usd.add_tangents(mesh)
    assert made == ("/Plane", 9, 1, None)
    assert written(mesh).tolist() == [[-1, 0, 0, -1]] * 4 + [[1, 0, 0, 1]] * 5


def test_left_handed_meshes_get_the_tangents_of_the_same_surface() -> None:
    stage = Usd.Stage.CreateInMemory()
    mesh = plane(stage)
    expected = darboux.usd.corner_tangents(mesh).tangents
    mesh.CreateOrientationAttr("leftHanded")
    mesh.GetFaceVertexIndicesAttr().Set([6, 5, 1, 0, 5, 4, 3, 2, 1])
    found = darboux.usd.corner_tangents(mesh).tangents
    assert found[:4].tolist() == expected[:4][::-1].tolist() and found[4:].tolist() == expected[4:].tolist()


def test_values_by_face_by_vertex_and_indexed() -> None:
    stage = Usd.Stage.CreateInMemory()
    mesh = plane(stage)
    expected = darboux.usd.corner_tangents(mesh).tangents.tolist()
    mesh.GetNormalsAttr().Set([(0, 0, 1)] * 2)
    mesh.SetNormalsInterpolation("uniform")
    assert darboux.usd.corner_tangents(mesh).tangents.tolist() == expected
    mesh.GetNormalsAttr().Clear()
    assert darboux.usd.corner_tangents(mesh).tangents.tolist() == expected
    uvs = UsdGeom.PrimvarsAPI(mesh).GetPrimvar("st")
    uvs.SetIndices(Vt.IntArray([1, 0, 1, 2, 3, 4, 2]))
    uvs.Set([(0, 0), (1, 0), (1, 1), (0.5, 2), (0, 1)])
    assert darboux.usd.corner_tangents(mesh).tangents.tolist() == expected


def test_tangents_of_another_type_are_replaced() -> None:
    stage = Usd.Stage.CreateInMemory()
    mesh = plane(stage)
    kind = Sdf.ValueTypeNames.Float4Array
    old = UsdGeom.PrimvarsAPI(mesh).CreatePrimvar("tangents", kind, "vertex")
    old.Set([(1, 0, 0, 1)] * 7)
    old.GetAttr().Set([(0, 1, 0, -1)] * 7, 5.0)
    darboux.usd.add_tangents(mesh)
    assert written(mesh).tolist() == [[-1, 0, 0, -1]] * 4 + [[1, 0, 0, 1]] * 5
    new = UsdGeom.PrimvarsAPI(mesh).GetPrimvar("tangents")
    assert new.GetTypeName() == Sdf.ValueTypeNames.Vector3fArray and not new.GetAttr().GetTimeSamples()


def test_moving_meshes_get_a_sample_for_each_of_their_points() -> None:
    stage = Usd.Stage.CreateInMemory()
    mesh = plane(stage)
    points = np.array(mesh.GetPointsAttr().Get())
    mesh.GetPointsAttr().Clear()
    mesh.GetPointsAttr().Set(points, 1)
    mesh.GetPointsAttr().Set(points * [-1, -1, 1], 5)
    darboux.usd.add_tangents(mesh)
    primvar = UsdGeom.PrimvarsAPI(mesh).GetPrimvar("tangents")
    assert primvar.GetAttr().GetTimeSamples() == [1, 5]
    assert primvar.Get(1)[8] == (1, 0, 0) and primvar.Get(5)[8] == (-1, 0, 0)


def test_what_cannot_have_tangents_is_skipped_with_the_reason() -> None:
    stage = Usd.Stage.CreateInMemory()
    plane(stage, "/Good")
    plane(stage, "/Smooth").GetSubdivisionSchemeAttr().Set("catmullClark")
    plane(stage, "/Bare").GetPrim().RemoveProperty("primvars:st")
    plane(stage, "/Torn").GetFaceVertexIndicesAttr().Set([0, 1, 5, 6, 1, 2, 3, 4, 7])
    plane(stage, "/Short").GetNormalsAttr().Set([(0, 0, 1)])
    plane(stage, "/Counts").GetFaceVertexCountsAttr().Set([4, 4])
    made = {mesh.path: mesh.skipped_because for mesh in darboux.usd.add_tangents(stage)}
    assert made.pop("/Good") is None
    expected = {
        "/Smooth": "is a subdivision surface",
        "/Bare": "has no UVs",
        "/Torn": "faceVertexIndices that are no points",
        "/Short": "has 1 normals where its vertex interpolation needs 7",
        "/Counts": "do not add up",
    }
    assert all(expected[path] in reason for path, reason in made.items()) and len(made) == len(expected)
    with pytest.raises(ValueError, match="the mesh /Bare has no UVs; unwrap it first"):
        darboux.usd.corner_tangents(UsdGeom.Mesh.Get(stage, "/Bare"))
    with pytest.raises(ValueError, match="no UV set named 'map1'"):
        darboux.usd.corner_tangents(UsdGeom.Mesh.Get(stage, "/Good"), "map1")


def test_instances_are_skipped() -> None:
    stage = Usd.Stage.CreateInMemory()
    plane(stage, "/Source/Plane")
    copy = stage.DefinePrim("/Copy")
    copy.GetReferences().AddInternalReference("/Source")
    copy.SetInstanceable(True)
    made = {mesh.path: mesh.skipped_because for mesh in darboux.usd.add_tangents(stage)}
    assert made["/Source/Plane"] is None
    assert made["/Copy/Plane"] == "is part of an instance; add tangents to the file that it refers to"


def gltf_corners(name: str) -> Dict[Corner, List[List[int]]]:
    """The bits of the tangents that the glTF of the scene gets, by those of position, normal and UV with v up."""
    document = darboux.load(SCENE / name)
    document.add_tangents()
    corners: Dict[Corner, List[List[int]]] = {}
    for mesh in range(2):
        arrays = document.arrays(mesh, 0)
        uvs = arrays["TEXCOORD_0"] * np.float32([1, -1]) + np.float32([0, 1])
        for position, normal, uv, tangent in zip(arrays["POSITION"], arrays["NORMAL"], uvs, arrays["TANGENT"]):
            key = (position.tobytes(), (normal + 0).tobytes(), (uv + 0).tobytes())
            # At the mirrored seam there are two.
            corners.setdefault(key, []).append(bits(tangent))
    return corners


@pytest.mark.parametrize("ending", ["usda", "usdc", "usdz"])
def test_blenders_usd_and_its_gltf_have_the_same_bits(ending: str, tmp_path: Path) -> None:
    """Blender's exporters cut faces of five and more corners differently, so that vertices at such faces may differ."""
    shutil.copy(SCENE / f"scene.{ending}", tmp_path)
    shutil.copy(SCENE / "scene_normal.png", tmp_path)
    made = darboux.usd.process(tmp_path / f"scene.{ending}")
    assert [mesh.skipped_because for mesh in made] == [None] * 3
    assert sum(mesh.cut_faces for mesh in made) == 4
    with pytest.raises(FileExistsError):
        darboux.usd.process(tmp_path / f"scene.{ending}")
    output = tmp_path / f"scene.tangents.{ending}"
    stage = Usd.Stage.Open(str(output))
    expected = gltf_corners("scene.z-up.glb")
    compared = 0
    for path in ["/root/Block/Block", "/root/Armature/Body/Sheet"]:
        mesh = UsdGeom.Mesh.Get(stage, path)
        vertices, sizes = (np.array(values.Get()) for values in (mesh.GetFaceVertexIndicesAttr(), mesh.GetFaceVertexCountsAttr()))
        at_large_faces = np.isin(vertices, vertices[np.repeat(sizes, sizes) > 4])
        points, normals = np.array(mesh.GetPointsAttr().Get())[vertices], np.array(mesh.GetNormalsAttr().Get())
        uvs = np.array(UsdGeom.PrimvarsAPI(mesh).GetPrimvar("st").Get())
        tangents = written(mesh)
        for corner in np.flatnonzero(~at_large_faces):
            key = (points[corner].tobytes(), (normals[corner] + 0).tobytes(), (uvs[corner] + 0).tobytes())
            assert bits(tangents[corner]) in expected[key]
            compared += 1
    assert compared > 60


def test_outputs_in_other_folders_find_their_textures(tmp_path: Path) -> None:
    darboux.usd.process(SCENE / "scene.usda", tmp_path / "made.usda")
    stage = Usd.Stage.Open(str(tmp_path / "made.usda"))
    texture = stage.GetPrimAtPath("/root/_materials/Scales/Image_Texture").GetAttribute("inputs:file").Get()
    assert Path(texture.resolvedPath).resolve() == (SCENE / "scene_normal.png").resolve()


def test_bad_files_are_named(tmp_path: Path) -> None:
    bad = tmp_path / "bad.usda"
    bad.write_text("not usd")
    with pytest.raises(ValueError, match="bad.usda: USD cannot read it"):
        darboux.usd.process(bad)
    with pytest.raises(FileNotFoundError, match="there is no such file"):
        darboux.usd.process(tmp_path / "none.usda")
    with pytest.raises(ValueError, match="made.glb: USD is written to .usd, .usda, .usdc, .usdz"):
        darboux.usd.process(SCENE / "scene.usda", tmp_path / "made.glb")
    package = tmp_path / "bad.usdz"
    package.write_text("no zip")
    with pytest.raises(ValueError, match="is not a usdz package"):
        darboux.usd.process(package)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["bad.usda", "bad.usdz"]


def package(path: Path, members: Dict[str, bytes]) -> Path:
    with zipfile.ZipFile(path, "w", zipfile.ZIP_STORED) as archive:
        for name, content in members.items():
            archive.writestr(name, content)
    return path


def test_packages_stay_in_their_folder(tmp_path: Path) -> None:
    stage = Usd.Stage.CreateNew(str(tmp_path / "victim.usda"))
    plane(stage)
    stage.GetRootLayer().Save()
    before = (tmp_path / "victim.usda").read_bytes()
    folder = tmp_path / "folder"
    folder.mkdir()
    for name in ("../victim.usda", "../../victim.usda", "/victim.usda", "a/../../../victim.usda", "..\\victim.usda", "C:victim.usda"):
        bad = package(folder / "bad.usdz", {name: before})
        with pytest.raises(ValueError, match="leaves its folder"):
            darboux.usd.process(bad)
    assert (tmp_path / "victim.usda").read_bytes() == before
    assert [path.name for path in folder.iterdir()] == ["bad.usdz"]


def test_packages_cannot_take_files_of_this_machine(tmp_path: Path) -> None:
    secret = tmp_path / "secret.png"
    secret.write_bytes(b"secret")
    stage = Usd.Stage.CreateNew(str(tmp_path / "root.usda"))
    mesh = plane(stage)
    mesh.GetPrim().CreateAttribute("file", Sdf.ValueTypeNames.Asset).Set(Sdf.AssetPath(str(secret)))
    stage.GetRootLayer().Save()
    folder = tmp_path / "folder"
    folder.mkdir()
    bad = package(folder / "bad.usdz", {"root.usda": (tmp_path / "root.usda").read_bytes()})
    with pytest.raises(ValueError, match="refers to files outside the package"):
        darboux.usd.process(bad)
    assert [path.name for path in folder.iterdir()] == ["bad.usdz"]


def test_members_over_the_same_bytes_are_refused(tmp_path: Path) -> None:
    good = package(tmp_path / "bomb.usdz", {"root.usda": b"#usda 1.0\n" + b" " * 5000})
    content = bytearray(good.read_bytes())
    entry = content.rindex(b"PK\x01\x02")
    end = content.rindex(b"PK\x05\x06")
    many = bytes(content[entry:end]) * 100
    tail = bytearray(content[end:])
    tail[8:10] = tail[10:12] = (100).to_bytes(2, "little")
    tail[12:16] = len(many).to_bytes(4, "little")
    good.write_bytes(bytes(content[:entry]) + many + bytes(tail))
    with pytest.raises(ValueError, match="members over the same bytes"):
        darboux.usd.process(good)


def test_what_is_no_file_is_refused_at_once(tmp_path: Path) -> None:
    pipe = tmp_path / "pipe.usda"
    os.mkfifo(pipe)
    with pytest.raises(ValueError, match="is not a regular file"):
        darboux.usd.process(pipe)
    with pytest.raises(FileNotFoundError, match="its folder does not exist"):
        darboux.usd.process(SCENE / "scene.usda", tmp_path / "none/out.usda")
    with pytest.raises(ValueError, match="exists and is not a regular file"):
        darboux.usd.process(SCENE / "scene.usda", pipe, force=True)
    assert [path.name for path in tmp_path.iterdir()] == ["pipe.usda"]


def test_an_unknown_interpolation_and_endless_samples_are_skipped(monkeypatch: pytest.MonkeyPatch) -> None:
    stage = Usd.Stage.CreateInMemory()
    mesh = plane(stage)
    UsdGeom.PrimvarsAPI(mesh).GetPrimvar("st").GetAttr().SetMetadata("interpolation", "nearest")
    (report,) = darboux.usd.add_tangents(mesh)
    assert report.skipped_because is not None and "'nearest', which USD does not know" in report.skipped_because
    moving = plane(stage, "/Moving")
    for time in range(3):
        moving.GetPointsAttr().Set(moving.GetPointsAttr().Get(), time)
    monkeypatch.setattr(darboux.usd, "MOST_CORNERS", 20)
    (report,) = darboux.usd.add_tangents(moving)
    assert report.skipped_because is not None and "3 times of 9 corners" in report.skipped_because
