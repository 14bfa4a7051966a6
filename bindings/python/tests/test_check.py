"""What is wrong with files, maps and tangents."""

import json
import os
import subprocess
import sys
from pathlib import Path
from typing import Any, Dict, List

import darboux
import numpy as np
import pytest

from conftest import ROOT, Mesh, grid

ASSETS = ROOT / "assets"


def bumps(side: int, up: float) -> np.ndarray:
    """A normal map of bumps; `up` is 1 for OpenGL and -1 for DirectX."""
    y, x = np.mgrid[0:side, 0:side] / 5.0
    normal = np.stack([-np.cos(x) * np.sin(y) / 5, up * np.sin(x) * np.cos(y) / 5, np.ones_like(x)], -1)
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    return np.round(127.5 + 127.5 * normal).astype(np.uint8)


def test_models_are_checked() -> None:
    findings = darboux.check(ASSETS / "made/shield.glb")
    errors = [finding for finding in findings if finding.severity == "error"]
    assert [finding.code for finding in errors] == ["tangent-shared-across-mirror"]
    assert errors[0].fixable and errors[0].mesh == 0 and errors[0].first_are == "vertices" and errors[0].count > 0
    assert all(isinstance(finding, darboux.Finding) for finding in findings)
    healthy = darboux.check(str(ASSETS / "NormalTangentTest/NormalTangentTest.glb"), maps=False)
    assert all(finding.severity != "error" for finding in healthy)


def test_models_are_repaired(tmp_path: Path) -> None:
    document = darboux.load(ASSETS / "made/shield.glb")
    found = darboux.check(document)
    assert all(finding.repaired is None for finding in found)
    fixed = darboux.fix(document)
    assert [finding.code for finding in fixed] == [finding.code for finding in found]
    assert document.is_changed
    for finding in fixed:
        assert finding.fixable == finding.repaired == (finding.left_because is None), finding
    assert any(finding.repaired for finding in fixed if finding.code == "tangent-shared-across-mirror")
    path = tmp_path / "fixed.glb"
    darboux.save(document, path)
    left = darboux.check(path)
    assert not any(finding.fixable or finding.severity == "error" for finding in left)
    again = darboux.load(path)
    assert not any(finding.repaired for finding in darboux.fix(again)) and not again.is_changed


def test_findings_are_those_of_the_command(tmp_path: Path) -> None:
    def reported(*words: object) -> Dict[str, Any]:
        command = [sys.executable, "-m", "darboux", "check", *map(str, words), "--json"]
        done = subprocess.run(command, capture_output=True, check=False)
        report: Dict[str, Any] = json.loads(done.stdout)["files"][0]
        return report

    def rows(findings: List[darboux.Finding]) -> List[Dict[str, Any]]:
        """As the report writes them, without what it leaves out."""
        found = [finding._asdict() for finding in findings]
        for row in found:
            row["evidence"] = [number._asdict() for number in row["evidence"]]
            row["change"] = row["change"] and {name: value for name, value in row["change"]._asdict().items() if value is not None}
            for name in ("source", "repaired", "change"):
                if row[name] is None:
                    del row[name]
        return found

    def compare(model: Path) -> darboux.Findings:
        found, report = darboux.check(model), reported(model)
        assert (rows(found), found.diagnosis) == (report["findings"], report["diagnosis"]), model
        assert (found.importer_note, found.warnings) == (report.get("importer_note"), report.get("warnings", [])), model
        return found

    model = ASSETS / "made/shield.glb"
    found = compare(model)
    assert (found.importer_note, found.warnings, found[0].source) == (None, [], None)
    found = compare(ASSETS / "others/assimp.fbx")
    assert found.importer_note and found.warnings and "Armature/Body in your FBX" in [finding.source for finding in found]
    (tmp_path / "alone.obj").write_bytes((ASSETS / "blender/scene.obj").read_bytes())
    assert compare(tmp_path / "alone.obj").warnings
    document = darboux.load(ASSETS / "others/assimp.fbx")
    fixed, checked = darboux.fix(document), darboux.check(ASSETS / "others/assimp.fbx")
    assert [finding.source for finding in fixed] == [finding.source for finding in checked]
    repaired, report = darboux.fix(darboux.load(model)), reported(model, "--fix", "-o", tmp_path / "fixed.glb")
    fixed = rows(repaired)
    assert any("change" in row for row in fixed)
    assert (fixed, repaired.diagnosis) == (report["findings"], report["diagnosis"])


def test_repairs_can_be_chosen() -> None:
    document = darboux.load(ASSETS / "made/shield.glb")
    fixed = darboux.fix(document, only=["tangent-zero"])
    assert not document.is_changed
    left = next(finding for finding in fixed if finding.code == "tangent-shared-across-mirror")
    assert left.fixable and not left.repaired and left.left_because is not None
    with pytest.raises(ValueError, match="tangent-odd"):
        darboux.fix(document, only=["tangent-odd"])
    with pytest.raises(TypeError, match="Document"):
        darboux.fix("model.glb")  # type: ignore[arg-type]


def test_maps_are_checked_and_judged(tmp_path: Path) -> None:
    image = pytest.importorskip("PIL.Image")
    path = tmp_path / "down.png"
    image.fromarray(bumps(128, -1.0)).save(path)
    assert [finding.code for finding in darboux.check(path)] == ["map-green-flipped"]
    assert darboux.check(path, convention="directx") == []
    for up, verdict in [(1.0, "opengl"), (-1.0, "directx")]:
        texels = bumps(128, up)
        wide = texels.astype(np.uint16) * 257
        for given in (texels, texels[..., :2], np.dstack([texels, texels[..., 0]]), wide):
            judgement = darboux.judge_normal_map(given)
            assert judgement.verdict == verdict and judgement.texels == 128 * 128
            tiles = judgement.tiles
            assert len(tiles.correlations) == tiles.columns * (128 // tiles.side) > 1
            votes = [vote for vote in tiles.correlations if vote is not None]
            assert votes and all(vote * up > 0 for vote in votes)
    assert darboux.judge_normal_map(np.full((32, 32, 3), 128, np.uint8)).verdict != "opengl"


def test_recipes_are_recognised(sheet: Mesh) -> None:
    for method in ("mikktspace", "angle-edge", "lengyel", "area", "face"):
        tangents = darboux.generate_tangents(*sheet.arrays, method=method)
        found = darboux.recognise_recipe(*sheet.arrays, tangents)
        assert len({match[:6] for match in found}) == len(found)
        best = found[0]
        assert (best.method, best.identical, best.worst) == (method, best.corners, 0.0)
        assert (best.mode == "repaired") == (method == "mikktspace")


def test_wrong_input_is_refused() -> None:
    with pytest.raises(FileNotFoundError, match="nothing.glb"):
        darboux.check("nothing.glb")
    with pytest.raises(FileNotFoundError, match="nothing.png"):
        darboux.check("nothing.png")
    with pytest.raises(ValueError, match="convention is 'metal'"):
        darboux.check("a.glb", convention="metal")  # type: ignore[arg-type]
    with pytest.raises(ValueError, match=r"\(H, W, 2 to 4\)"):
        darboux.judge_normal_map(np.zeros((4, 4), np.uint8))
    with pytest.raises(TypeError, match="float64"):
        darboux.judge_normal_map(np.zeros((4, 4, 3)))
    mesh = grid(2, 2)
    with pytest.raises(ValueError, match="tangents"):
        darboux.recognise_recipe(*mesh.arrays, np.zeros((3, 4)))


@pytest.mark.skipif(os.name != "posix", reason="FIFOs are files of Unix")
def test_what_is_no_regular_file_is_refused_at_once(tmp_path: Path) -> None:
    for name in ("pipe.png", "pipe.glb"):
        os.mkfifo(tmp_path / name)
        with pytest.raises(OSError, match="is not a regular file"):
            darboux.check(tmp_path / name)
