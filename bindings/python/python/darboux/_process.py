"""Processes one file: reads it, adds normals and tangents, writes it."""

import os
from pathlib import Path
from typing import Any, Callable, Dict, Optional, Union

from ._darboux import load, save

PathLike = Union[str, "os.PathLike[str]"]


def process(
    path: PathLike,
    output: Optional[PathLike] = None,
    *,
    normals: str = "keep",
    force: bool = False,
    allow_outside: bool = False,
    memory_limit: Optional[int] = None,
    progress: Optional[Callable[[int, int], object]] = None,
    **options: Any,
) -> Dict[str, Any]:
    """Add tangents to a glTF or GLB file, as `darboux tangents` does. Nothing is written after an error or Ctrl-C.

    Parameters
    ----------
    path : path-like
        The input.
    output : path-like, optional
        Without, model.glb becomes model.tangents.glb beside it.
    normals : str
        'flat', 'smooth' or 'crease=30' first generates missing normals, and with `overwrite` replaces existing ones. 'keep' generates
        none.
    force : bool
        Replace an output that exists.
    allow_outside : bool
        Also read files outside the input's folder.
    memory_limit : int, optional
        The most memory for the file, in MiB, as in load.
    progress : callable, optional
        Called with the triangles done and their total, after each primitive.
    **options
        As for Document.add_tangents.

    Returns
    -------
    dict
        What Document.add_tangents returns, and 'files_written'.

    Raises
    ------
    OSError, ValueError
        As load, Document.add_tangents and save.
    """
    path = Path(path)
    document = load(path, allow_outside=allow_outside, memory_limit=memory_limit)
    warnings = list(document.warnings)
    if normals != "keep":
        made = document.add_normals(**_normal_options(normals), overwrite=options.get("overwrite", False))
        warnings += made["warnings"]
    summary = document.add_tangents(progress=progress, **options)
    summary["warnings"] = warnings + summary["warnings"]
    if output is None:
        output = path.with_name(f"{path.stem}.tangents{path.suffix}")
    summary["files_written"] = save(document, output, force=force)
    return summary


def _normal_options(normals: str) -> Dict[str, Any]:
    """The arguments of Document.add_normals for the command's `--normals`."""
    if normals in ("flat", "smooth"):
        return {"shading": normals}
    name, _, degrees = normals.partition("=")
    try:
        if name == "crease":
            return {"crease": float(degrees)}
    except ValueError:
        pass
    raise ValueError(f"normals is {normals!r}; it must be 'keep', 'flat', 'smooth' or 'crease=DEGREES'")
