"""generate_tangents and split_vertices: the bits of Rust, from arrays of any type and layout."""

import itertools
from typing import Any, Callable, Dict, List, get_args

import darboux
import numpy as np
import pytest
from darboux._choices import Method
from conftest import Mesh, CorpusCase, bits, floats, grid


def test_corpus_has_the_bits_of_rust(corpus: List[CorpusCase]) -> None:
    assert len({corpus_case.answer["name"] for corpus_case in corpus}) > 30
    for case in corpus:
        arguments = case.mesh.arrays
        found, report = darboux.generate_tangents(*arguments, faces=case.faces, return_report=True, **case.options)
        tangents = case.floats("tangents", 4)
        assert bits(found) == bits(tangents), case.answer["name"]
        assert report.repaired_corners == case.answer["repaired"]
        frames = darboux.generate_tangents(*arguments, faces=case.faces, full=True, **case.options)
        assert bits(frames.tangent) == bits(case.floats("frames", 4))
        assert bits(frames.bitangent) == bits(case.floats("bitangents", 3))
        assert bits(frames.magnitude) == bits(case.floats("magnitudes", 2))
        split = darboux.split_vertices(case.mesh.indices, tangents, len(case.mesh.positions))
        assert split.indices.tolist() == case.answer["split_indices"]
        assert split.source_of_vertex.tolist() == case.answer["split_sources"]
        assert bits(split.tangent_of_vertex) == bits(case.floats("split_tangents", 4))


def test_methods_and_plans_have_the_bits_of_rust(corpus: List[CorpusCase]) -> None:
    for case in corpus:
        arguments = case.mesh.arrays
        for method, words in case.answer["methods"].items():
            found = darboux.generate_tangents(*arguments, faces=case.faces, method=method)
            assert bits(found) == bits(floats(words, 4)), (case.answer["name"], method)
        plan = darboux.Plan(*arguments, faces=case.faces, **case.options)
        assert bits(plan.base) == bits(case.floats("tangents", 4))
        planned = plan.evaluate(case.floats("moved", 3), case.mesh.normals)
        assert bits(planned) == bits(case.floats("planned", 4)), case.answer["name"]


def interleaved(mesh: Mesh) -> Dict[str, np.ndarray]:
    vertices = np.full((len(mesh.positions), 9), np.nan, dtype=np.float32)
    vertices[:, 0:3], vertices[:, 3:6], vertices[:, 7:9] = mesh.positions, mesh.normals, mesh.uvs
    return {"positions": vertices[:, 0:3], "normals": vertices[:, 3:6], "uvs": vertices[:, 7:9]}


def structured(mesh: Mesh) -> Dict[str, np.ndarray]:
    # One byte moves everything from where floats are aligned.
    fields = [("flags", "u1"), ("p", "f4", 3), ("n", "f4", 3), ("t", "f4", 2)]
    vertices = np.zeros(len(mesh.positions), dtype=fields)
    vertices["p"], vertices["n"], vertices["t"] = mesh.positions, mesh.normals, mesh.uvs
    return {"positions": vertices["p"], "normals": vertices["n"], "uvs": vertices["t"]}


def changed(change: Callable[[np.ndarray], np.ndarray]) -> Callable[[Mesh], Dict[str, np.ndarray]]:
    return lambda mesh: {name: change(getattr(mesh, name)) for name in ("positions", "normals", "uvs")}


LAYOUTS = {
    "interleaved": interleaved,
    "structured": structured,
    "Fortran order": changed(np.asfortranarray),
    "every second row": changed(lambda rows: np.repeat(rows, 2, axis=0)[::2]),
    "rows backwards": changed(lambda rows: rows[::-1].copy()[::-1]),
    "columns backwards": changed(lambda rows: rows[:, ::-1].copy()[:, ::-1]),
    "offset": changed(lambda rows: np.concatenate([np.zeros_like(rows[:5]), rows])[5:]),
    "read-only": changed(lambda rows: np.frombuffer(rows.tobytes(), dtype=np.float32).reshape(rows.shape)),
    "other byte order": changed(lambda rows: rows.astype(rows.dtype.newbyteorder())),
    "float64": changed(lambda rows: rows.astype(np.float64)),
    "longdouble": changed(lambda rows: rows.astype(np.longdouble)),
    "lists": changed(lambda rows: rows.tolist()),
    "subclass": changed(lambda rows: rows.view(np.recarray)),
}


@pytest.mark.parametrize("layout", LAYOUTS)
def test_layouts_have_the_same_bits(layout: str, sheet: Mesh) -> None:
    expected = bits(darboux.generate_tangents(*sheet.arrays))
    arrays = LAYOUTS[layout](sheet)
    for names in itertools.chain.from_iterable(itertools.combinations(arrays, n) for n in (1, 2, 3)):
        chosen = {name: arrays[name] if name in names else getattr(sheet, name) for name in arrays}
        assert bits(darboux.generate_tangents(**chosen, indices=sheet.indices)) == expected, names


@pytest.mark.parametrize("dtype", ["float16", "int8", "int32", "uint64", ">f2"])
def test_coarse_numbers_are_those_numbers(dtype: str, sheet: Mesh) -> None:
    coarse = [np.round(np.abs(getattr(sheet, name)) * 20).astype(dtype) for name in ("positions", "normals", "uvs")]
    expected = darboux.generate_tangents(*(rows.astype(np.float32) for rows in coarse), sheet.indices)
    assert bits(darboux.generate_tangents(*coarse, sheet.indices)) == bits(expected)


@pytest.mark.parametrize("dtype", ["uint8", "int8", "int16", "uint16", ">u2", "int32", "uint32", ">i4", "int64", "uint64"])
def test_indices_of_every_type_and_shape(dtype: str, sheet: Mesh) -> None:
    expected = bits(darboux.generate_tangents(*sheet.arrays))
    assert sheet.indices is not None
    assert len(sheet.positions) < 128
    indices = sheet.indices.astype(dtype)
    padded = np.zeros((len(indices), 5), dtype=dtype)
    padded[:, 1:4] = indices
    for given in (indices, indices.ravel(), np.asfortranarray(indices), padded[:, 1:4], indices.tolist()):
        assert bits(darboux.generate_tangents(*sheet.arrays[:3], given)) == expected


def test_a_mesh_without_indices(sheet: Mesh) -> None:
    corners = [array[sheet.indices.ravel()] for array in sheet.arrays[:3]]
    assert bits(darboux.generate_tangents(*corners)) == bits(darboux.generate_tangents(*sheet.arrays))


def test_ways_to_say_quads() -> None:
    mesh = grid(4, 4)
    quads = mesh.indices.reshape(-1, 6)[:, [0, 1, 2, 5]]
    arrays = mesh.arrays[:3]
    expected = bits(darboux.generate_tangents(*arrays, quads))
    assert bits(darboux.generate_tangents(*arrays, quads.ravel(), faces=4)) == expected
    assert bits(darboux.generate_tangents(*arrays, quads, faces=[4] * 16)) == expected
    mixed = np.concatenate([quads[0], mesh.indices[2:].ravel()])
    tangents, report = darboux.generate_tangents(*arrays, mixed, faces=[4] + [3] * 30, return_report=True)
    assert len(tangents) == len(mixed)
    assert report.triangles == 32


def test_out_is_written_in_place(sheet: Mesh) -> None:
    expected = darboux.generate_tangents(*sheet.arrays)
    out = np.empty_like(expected)
    assert darboux.generate_tangents(*sheet.arrays, out=out) is out
    assert bits(out) == bits(expected)
    # Between the mesh's own elements.
    corners = np.zeros((len(expected), 12), dtype=np.float32)
    for at, array in ((0, sheet.positions), (3, sheet.normals), (6, sheet.uvs)):
        corners[:, at : at + array.shape[1]] = array[sheet.indices.ravel()]
    place = corners[:, 8:12]
    darboux.generate_tangents(corners[:, 0:3], corners[:, 3:6], corners[:, 6:8], out=place)
    assert bits(place) == bits(expected)
    assert bits(corners[:, 0:3]) == bits(sheet.positions[sheet.indices.ravel()])


def test_out_may_be_what_is_read(sheet: Mesh) -> None:
    """Also where it is packed: positions of a mesh without indices, in the memory that becomes their tangents."""
    positions, normals, uvs = (array[sheet.indices.ravel()] for array in sheet.arrays[:3])
    expected = bits(darboux.generate_tangents(positions, normals, uvs))
    memory = np.zeros((len(positions), 4), dtype=np.float32)
    memory[:, :3] = positions
    assert darboux.generate_tangents(memory[:, :3], normals, uvs, out=memory) is memory
    assert bits(memory) == expected
    plan = darboux.Plan(positions, normals, uvs)
    memory[:, :3] = positions
    assert plan.evaluate(memory[:, :3], normals, out=memory, threads=2) is memory
    assert bits(memory) == expected
    strided = np.zeros((len(positions), 8), dtype=np.float32)
    assert plan.evaluate(positions, normals, out=strided[:, 2:6]).base is strided
    assert bits(strided[:, 2:6]) == expected


def test_inputs_stay_as_they_are(sheet: Mesh) -> None:
    before = [array.tobytes() for array in sheet.arrays]
    darboux.generate_tangents(*sheet.arrays, full=True)
    assert [array.tobytes() for array in sheet.arrays] == before


def test_values_that_are_not_finite_are_counted(sheet: Mesh) -> None:
    positions = sheet.positions.astype(np.float64)
    positions[3] = [np.nan, np.inf, 1e300]
    with np.errstate(all="raise"):
        tangents, report = darboux.generate_tangents(positions, *sheet.arrays[1:], return_report=True)
    assert report.non_finite_corners == np.count_nonzero(sheet.indices == 3)
    assert np.isfinite(tangents).all()
    assert np.allclose(np.linalg.norm(tangents[:, :3], axis=1), 1)


def test_methods_differ_and_are_unit(sheet: Mesh) -> None:
    methods = get_args(Method)
    found = [darboux.generate_tangents(*sheet.arrays, method=method) for method in methods]
    assert len({tangents.tobytes() for tangents in found}) == len(methods)
    for tangents in found:
        assert np.allclose(np.linalg.norm(tangents[:, :3], axis=1), 1, atol=1e-6)


def test_threads_do_not_show() -> None:
    mesh = grid(200, 150)
    expected = darboux.generate_tangents(*mesh.arrays, threads=1).tobytes()
    for threads in (None, 2, 3):
        assert darboux.generate_tangents(*mesh.arrays, threads=threads).tobytes() == expected


def test_nothing_gives_nothing() -> None:
    empty: Any = np.zeros((0, 3))
    assert darboux.generate_tangents(empty, empty, np.zeros((0, 2)), []).shape == (0, 4)
    assert darboux.generate_tangents(empty, empty, np.zeros((0, 2))).shape == (0, 4)
    assert darboux.split_vertices([], np.zeros((0, 4)), 0).indices.shape == (0,)


def test_splitting_keeps_the_shape_of_indices(sheet: Mesh) -> None:
    tangents = darboux.generate_tangents(*sheet.arrays)
    split = darboux.split_vertices(sheet.indices, tangents, len(sheet.positions))
    assert split.indices.shape == sheet.indices.shape
    assert len(split.source_of_vertex) > len(sheet.positions)
    assert bits(split.tangent_of_vertex[split.indices.ravel()]) == bits(tangents)
    assert np.array_equal(split.source_of_vertex[split.indices], sheet.indices)
