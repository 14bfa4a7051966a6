"""Tangents for pygltflib."""

import warnings
from pathlib import Path
from typing import Any

import pygltflib

from ._darboux import dumps, loads


def add_tangents(gltf: pygltflib.GLTF2, **options: Any) -> pygltflib.GLTF2:
    """Return a copy of a document with the tangents that it lacks. Warns of primitives without normals, which get none.

    Parameters
    ----------
    gltf : pygltflib.GLTF2
        Buffers in files are read from its folder.
    **options
        As for Document.add_tangents.

    Returns
    -------
    pygltflib.GLTF2
        With all buffers in one.

    Raises
    ------
    ValueError
        As load and Document.add_tangents.
    """
    folder = getattr(gltf, "_path", None)
    document = loads(b"".join(gltf.save_to_bytes()), name="<GLTF2>", base=Path(folder) if folder else None)
    lacking = document.add_tangents(**options)["totals"]["without_normals"]
    if lacking:
        sentence = "primitives have no normals, which tangents need; add normals first, with Document.add_normals for example"
        warnings.warn(f"{lacking} {sentence}", stacklevel=2)
    made = pygltflib.GLTF2.load_from_bytes(dumps(document))
    assert made is not None
    return made
