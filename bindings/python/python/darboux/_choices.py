"""The names of choices. Generated from Rust."""

from typing import Literal

Method = Literal["mikktspace", "angle-area", "lengyel", "lengyel-per-vertex", "average", "area", "face", "from-normal", "angle-edge"]
Mode = Literal["repaired", "reference", "corrected"]
Shading = Literal["smooth", "flat"]
NormalWeight = Literal["angle", "area", "angle-area"]
SmoothingSeams = Literal["ignored", "respected"]
Encoding = Literal["snorm8", "snorm10", "snorm16", "octahedral", "diamond"]
TangentEncoding = Literal["f32x4", "snorm16x4", "snorm8x4"]
AssumedMap = Literal["opengl", "directx", "red-inverted", "both-inverted"]
MapConvention = Literal["opengl", "directx"]
MapKind = Literal["normal", "object-normal", "height", "ao", "position", "bent-normal", "object-bent-normal", "thickness", "curvature", "id", "vertex-color", "base-color", "opacity", "roughness", "metalness", "emission", "texture", "world-direction", "uv-islands", "wireframe"]
Bitangent = Literal["pixel", "vertex"]
OcclusionFalloff = Literal["none", "linear", "quadratic"]
OcclusionWeights = Literal["cosine", "uniform"]
IdSource = Literal["material", "mesh", "part", "vertex-color"]
PartMatch = Literal["nearest", "name"]
ConventionName = Literal["gltf", "opengl", "directx", "blender", "unity", "unreal", "godot", "threejs", "maya", "3dsmax"]
