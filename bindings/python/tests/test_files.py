"""Documents, the command line and the adapters to other packages."""

import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import IO, Any, Callable, List, Tuple

import darboux
import numpy as np
import pytest
from conftest import ROOT, grid

MODEL = ROOT / "assets/NormalTangentTest/NormalTangentTest.glb"


def test_process_writes_what_the_command_writes(tmp_path: Path) -> None:
    steps: List[Tuple[int, int]] = []
    by_library, by_command = tmp_path / "library.glb", tmp_path / "command.glb"
    summary = darboux.process(MODEL, by_library, progress=lambda *step: steps.append(step))
    assert summary["totals"]["written"] == 1
    assert summary["files_written"] == [by_library]
    assert steps == [(7774, 7774)]
    command = [sys.executable, "-m", "darboux", "tangents", str(MODEL), "-o", str(by_command)]
    subprocess.run(command, check=True, capture_output=True)
    assert by_library.read_bytes() == by_command.read_bytes()


@pytest.mark.parametrize("model", [MODEL, ROOT / "assets/Fox/Fox.glb"])
@pytest.mark.parametrize("normals", ["keep", "flat", "smooth", "crease=30"])
@pytest.mark.parametrize("overwrite", [False, True])
def test_normals_mean_what_they_mean_to_the_command(tmp_path: Path, model: Path, normals: str, overwrite: bool) -> None:
    by_library, by_command = tmp_path / "library.glb", tmp_path / "command.glb"
    darboux.process(model, by_library, normals=normals, overwrite=overwrite)
    command = [sys.executable, "-m", "darboux", "tangents", str(model), "-o", str(by_command), "--normals", normals]
    subprocess.run(command + ["--overwrite"] * overwrite, check=True, capture_output=True)
    assert by_library.read_bytes() == by_command.read_bytes()


@pytest.mark.parametrize("normals", ["sharp", "crease", "crease=", "crease=x"])
def test_other_normals_are_refused(normals: str) -> None:
    with pytest.raises(ValueError, match="it must be 'keep', 'flat', 'smooth' or 'crease=DEGREES'"):
        darboux.process(MODEL, normals=normals)


def test_the_documents_arrays_give_the_same_tangents(tmp_path: Path) -> None:
    document = darboux.load(MODEL)
    before = document.arrays(0, 0)
    assert not document.is_changed
    document.add_tangents()
    assert document.is_changed
    after = document.arrays(0, 0)
    tangents = darboux.generate_tangents(*(before[name] for name in ("POSITION", "NORMAL", "TEXCOORD_0", "indices")))
    split = darboux.split_vertices(before["indices"], tangents, len(before["POSITION"]))
    ours = darboux.convert("gltf", "gltf", tangents=split.tangent_of_vertex, generated=True).tangents
    assert np.array_equal(ours, after["TANGENT"])
    assert np.array_equal(split.indices, after["indices"])
    assert np.array_equal(before["POSITION"][split.source_of_vertex], after["POSITION"])
    path = tmp_path / "model.gltf"
    written = darboux.save(document, path)
    assert path in written and len(written) > 1
    assert np.array_equal(darboux.load(path).arrays()["TANGENT"], after["TANGENT"])
    assert darboux.loads(darboux.dumps(document)).primitive_counts == [1]


def test_documents_normals_conventions_and_inspection() -> None:
    document = darboux.load(MODEL)
    assert document.inspect()[0]["triangles"] == 7774
    assert document.add_normals(shading="flat", overwrite=True)["written"] == 1
    assert document.convert("unity", "gltf")["faces_reversed"]


def test_bad_files(tmp_path: Path) -> None:
    with pytest.raises(FileNotFoundError, match="nothing.glb: cannot be read"):
        darboux.load(tmp_path / "nothing.glb")
    broken = tmp_path / "broken.glb"
    broken.write_bytes(MODEL.read_bytes()[:5000])
    with pytest.raises(ValueError, match="broken.glb: "):
        darboux.load(broken)
    document = darboux.load(MODEL)
    for mesh in (1, -1, 1 << 62):
        with pytest.raises(IndexError, match=rf"meshes\[{mesh}\].primitives\[0\] does not exist"):
            document.arrays(mesh)
    with pytest.raises(ValueError, match="encoding is 'octahedral'; it must be one of 'f32x4'"):
        document.add_tangents(encoding="octahedral")  # type: ignore[arg-type]
    with pytest.raises(TypeError, match="progress must be callable, not int"):
        document.add_tangents(progress=3)  # type: ignore[arg-type]
    with pytest.raises(ValueError, match="broken.glb"):
        darboux.save(document, broken)
    assert len(broken.read_bytes()) == 5000


def test_an_error_of_the_progress_callback_comes_through(tmp_path: Path) -> None:
    calls: List[int] = []

    def fail(done: int, total: int) -> None:
        calls.append(done)
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        darboux.process(MODEL, tmp_path / "out.glb", progress=fail)
    assert len(calls) == 1
    assert list(tmp_path.iterdir()) == []


def refuses(*arguments: object) -> None:
    raise RuntimeError("enough")


EDITS: List[Callable[[Any], object]] = [
    lambda document: document.add_tangents(progress=refuses),
    lambda document: document.add_normals(overwrite=True, progress=refuses),
    lambda document: document.convert("unity", "gltf", progress=refuses),
]


@pytest.mark.parametrize("edit", EDITS)
def test_a_stopped_edit_leaves_nothing_to_save(edit: Callable[[Any], object], tmp_path: Path) -> None:
    document = darboux.load(MODEL)
    with pytest.raises(RuntimeError, match="enough"):
        edit(document)
    uses: List[Callable[[], object]] = [
        lambda: darboux.save(document, tmp_path / "out.glb"),
        lambda: darboux.dumps(document),
        lambda: document.arrays(),
        lambda: document.inspect(),
        lambda: document.add_tangents(),
        lambda: document.add_normals(),
        lambda: document.convert("unity", "gltf"),
    ]
    for use in uses:
        with pytest.raises(RuntimeError, match="the document is half done: .*; load it again"):
            use()
    assert list(tmp_path.iterdir()) == []


def test_options_that_are_none_leave_the_document_as_it_is() -> None:
    document = darboux.load(MODEL)
    before = darboux.dumps(document)
    with pytest.raises(TypeError, match="progress must be callable"):
        document.add_tangents(progress=3)  # type: ignore[arg-type]
    assert darboux.dumps(document) == before


INTERRUPTED = """
import signal, sys, darboux
def interrupt(done, total):
    # Unlike os.kill, this returns once the signal is taken, however slow the machine.
    signal.raise_signal(signal.SIGINT)
try:
    darboux.process(sys.argv[1], sys.argv[2], progress=interrupt)
except KeyboardInterrupt:
    print("interrupted")
"""


def test_ctrl_c_leaves_no_file(tmp_path: Path) -> None:
    out = tmp_path / "out.glb"
    ran = subprocess.run([sys.executable, "-c", INTERRUPTED, str(MODEL), str(out)], check=True, capture_output=True)
    assert ran.stdout.split() == [b"interrupted"]
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(sys.platform == "win32", reason="signals of Unix")
def test_ctrl_c_ends_the_command(tmp_path: Path) -> None:
    # The command waits for a standard input that never ends.
    command = [sys.executable, "-m", "darboux", "tangents", "-", "-o", str(tmp_path / "out.glb")]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        started(process)
        process.send_signal(signal.SIGINT)
        assert process.wait() in (130, -signal.SIGINT)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(sys.platform == "win32", reason="signals of Unix")
def test_the_command_leaves_ctrl_c_ignored() -> None:
    ignoring = "import os, signal, sys; signal.signal(signal.SIGINT, signal.SIG_IGN); os.execv(sys.executable, sys.argv[1:])"
    command = [sys.executable, "-c", ignoring, sys.executable, "-m", "darboux", "tangents", "-"]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE) as process:
        pipe = started(process)
        process.send_signal(signal.SIGINT)
        pipe.close()
        # It reads on, and refuses the one byte.
        assert process.wait() == 1


def started(process: "subprocess.Popen[bytes]") -> IO[bytes]:
    """The standard input of a command that reads it, once that has taken a byte: its handlers stand then."""
    assert process.stdin is not None
    process.stdin.write(b"g")
    process.stdin.flush()
    while bytes_waiting(process.stdin.fileno()) > 0:
        assert process.poll() is None
        time.sleep(0.01)
    return process.stdin


def bytes_waiting(pipe: int) -> int:
    """How many bytes nobody has read yet."""
    import fcntl
    import termios

    return int.from_bytes(fcntl.ioctl(pipe, termios.FIONREAD, b"\0\0\0\0"), sys.byteorder)


def test_exit_codes() -> None:
    def code(*arguments: str) -> int:
        return subprocess.run([sys.executable, "-m", "darboux", *arguments], capture_output=True).returncode

    assert code("--help") == 0
    assert code("inspect", "nothing.glb") == 1
    assert code("nonsense") == 2


def mirrored_trimesh() -> Any:
    trimesh = pytest.importorskip("trimesh")
    pytest.importorskip("PIL")
    mesh = grid(8, 8)
    # Nothing of trimesh's may merge or reorder the vertices.
    made = trimesh.Trimesh(mesh.positions, mesh.indices, vertex_normals=mesh.normals, process=False)
    made.visual = trimesh.visual.TextureVisuals(uv=mesh.uvs.astype(np.float64))
    return made


def test_trimesh(tmp_path: Path) -> None:
    """What trimesh writes with our tangents is what our own command makes of what trimesh writes without."""
    mesh = mirrored_trimesh()
    import darboux.trimesh

    without, tangents = tmp_path / "without.glb", tmp_path / "with.glb"
    mesh.export(without, include_normals=True)
    count = len(mesh.vertices)
    split = darboux.trimesh.add_tangents(mesh)
    assert len(mesh.vertices) == len(split.source_of_vertex) > count
    mesh.export(tangents, include_normals=True, tree_postprocessor=darboux.trimesh.name_tangents)
    ours = darboux.load(without)
    ours.add_tangents()
    expected, found = ours.arrays(), darboux.load(tangents).arrays()
    difference = darboux.measure_tangents(expected["TANGENT"][expected["indices"]], found["TANGENT"][found["indices"]])
    assert difference.sign_flips == 0
    # trimesh's normals and 1 - v went through other rounding.
    assert difference.max < 0.01
    assert {-1.0, 1.0} == set(found["TANGENT"][:, 3].tolist())


def test_trimesh_without_uvs() -> None:
    trimesh = pytest.importorskip("trimesh")
    import darboux.trimesh

    with pytest.raises(ValueError, match="the mesh has no UVs"):
        darboux.trimesh.add_tangents(trimesh.creation.box())


def test_pygltflib() -> None:
    pygltflib = pytest.importorskip("pygltflib")
    import darboux.pygltflib

    gltf = pygltflib.GLTF2().load(str(MODEL))
    made = darboux.pygltflib.add_tangents(gltf)
    assert gltf.meshes[0].primitives[0].attributes.TANGENT is None
    assert made.accessors[made.meshes[0].primitives[0].attributes.TANGENT].type == "VEC4"
    document = darboux.load(MODEL)
    document.add_tangents()
    again = darboux.loads(b"".join(made.save_to_bytes()))
    assert np.array_equal(again.arrays()["TANGENT"], document.arrays()["TANGENT"])


@pytest.mark.parametrize("name", ["scene.fbx", "scene.obj", "scene.ply", "scene.stl"])
def test_other_formats_are_read(name: str) -> None:
    path = ROOT / "assets/blender" / name
    document = darboux.load(path)
    assert len(document.arrays(0, 0)["POSITION"]) >= 20
    assert darboux.dumps(darboux.loads(path.read_bytes(), base=path.parent)) == darboux.dumps(document)
