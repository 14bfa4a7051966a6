"""An outside check, where Blender is installed as a module: its calc_tangents beside ours.

Blender has a MikkTSpace of its own, rewritten: it computes other roundings, so that bits differ. Directions may not, nor signs.
"""

import importlib.util
from pathlib import Path
from typing import Any, Callable, Dict

import darboux
import numpy as np
import pytest

bpy = pytest.importorskip("bpy")

EXAMPLE = Path(__file__).resolve().parents[1] / "examples/blender.py"
LARGEST = 0.002
"""Degrees."""


def example() -> Any:
    spec = importlib.util.spec_from_file_location("blender", EXAMPLE)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


MAKERS: Dict[str, Callable[[], Any]] = {
    "sphere": lambda: bpy.ops.mesh.primitive_uv_sphere_add(calc_uvs=True),
    "monkey": lambda: bpy.ops.mesh.primitive_monkey_add(calc_uvs=True),
    "cylinder": lambda: bpy.ops.mesh.primitive_cylinder_add(calc_uvs=True, end_fill_type="TRIFAN"),
    "cube": lambda: bpy.ops.mesh.primitive_cube_add(calc_uvs=True),
    "torus": lambda: bpy.ops.mesh.primitive_torus_add(generate_uvs=True),
    "grid": lambda: bpy.ops.mesh.primitive_grid_add(calc_uvs=True),
}


@pytest.mark.parametrize("smooth", [True, False])
@pytest.mark.parametrize("name", MAKERS)
def test_blender_agrees(name: str, smooth: bool) -> None:
    blender = example()
    MAKERS[name]()
    mesh = bpy.context.object.data
    mesh.polygons.foreach_set("use_smooth", [smooth] * len(mesh.polygons))
    mesh.update()
    blender.add_tangents(mesh)
    attributes = mesh.attributes
    ours = np.hstack(
        [
            blender.column(attributes["tangent"].data, "vector", 3),
            blender.column(attributes["tangent_sign"].data, "value", 1),
        ]
    )
    mesh.calc_tangents(uvmap=mesh.uv_layers.active.name)
    theirs = np.hstack(
        [blender.column(mesh.loops, "tangent", 3), blender.column(mesh.loops, "bitangent_sign", 1)]
    )
    difference = darboux.measure_tangents(theirs, ours)
    assert difference.corners == len(mesh.loops) > 20
    assert (difference.sign_flips, difference.without_angle) == (0, 0)
    assert difference.max < LARGEST
