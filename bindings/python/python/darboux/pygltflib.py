"""Tangents for pygltflib."""

from pathlib import Path
from typing import Any

import pygltflib

from ._darboux import dumps, loads


def add_tangents(gltf: pygltflib.GLTF2, **options: Any) -> pygltflib.GLTF2:
    """Give a document with the tangents that it lacks; the argument stays as it is.

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
    document.add_tangents(**options)
    made = pygltflib.GLTF2.load_from_bytes(dumps(document))
    assert made is not None
    return made
