"""Tangents and normals in fewer bytes, and back. Rows in, rows out; the sign is exact in all of them."""

from ._darboux import (
    frame_from_quaternion,
    frame_to_quaternion,
    normal_from_octahedral,
    normal_to_octahedral,
    tangent_from_diamond,
    tangent_from_octahedral,
    tangent_from_snorm8,
    tangent_from_snorm10,
    tangent_from_snorm16,
    tangent_to_diamond,
    tangent_to_octahedral,
    tangent_to_snorm8,
    tangent_to_snorm10,
    tangent_to_snorm16,
)

__all__ = [
    "frame_from_quaternion",
    "frame_to_quaternion",
    "normal_from_octahedral",
    "normal_to_octahedral",
    "tangent_from_diamond",
    "tangent_from_octahedral",
    "tangent_from_snorm8",
    "tangent_from_snorm10",
    "tangent_from_snorm16",
    "tangent_to_diamond",
    "tangent_to_octahedral",
    "tangent_to_snorm8",
    "tangent_to_snorm10",
    "tangent_to_snorm16",
]
