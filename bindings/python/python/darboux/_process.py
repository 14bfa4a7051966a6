"""One file, from reading to writing."""

import os
from pathlib import Path
from typing import Any, Callable, Dict, Literal, Optional, Union

from ._darboux import load, save

PathLike = Union[str, "os.PathLike[str]"]


def process(
    path: PathLike,
    output: Optional[PathLike] = None,
    *,
    normals: Optional[Literal["flat", "smooth"]] = None,
    force: bool = False,
    allow_outside: bool = False,
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
    normals : str, optional
        'flat' or 'smooth' makes new normals first, in place of all that exist.
    force : bool
        Replace an output that exists.
    allow_outside : bool
        Also read files outside the input's folder.
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
    document = load(path, allow_outside=allow_outside)
    warnings = list(document.warnings)
    if normals is not None:
        warnings += document.add_normals(shading=normals, overwrite=True)["warnings"]
    summary = document.add_tangents(progress=progress, **options)
    summary["warnings"] = warnings + summary["warnings"]
    if output is None:
        output = path.with_name(f"{path.stem}.tangents{path.suffix}")
    summary["files_written"] = save(document, output, force=force)
    return summary
