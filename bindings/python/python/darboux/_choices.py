"""The names of choices. Generated from the core."""

from typing import Literal

Method = Literal["mikktspace", "angle-area", "lengyel", "lengyel-per-vertex", "average", "area", "face", "from-normal", "angle-edge"]
Mode = Literal["repaired", "reference", "corrected"]
Shading = Literal["smooth", "flat"]
NormalWeight = Literal["angle", "area", "angle-area"]
SmoothingSeams = Literal["ignored", "respected"]
Encoding = Literal["snorm8", "snorm10", "snorm16", "octahedral", "diamond"]
