"""Tangents for an engine's vertices: four triangles whose UVs are mirrored at x = 0."""

import darboux
import numpy as np

Vertex = np.dtype([("position", "f4", 3), ("uv", "f4", 2), ("normal", "f4", 3), ("tangent", "f4", 4)])

vertices = np.zeros(6, Vertex)
vertices["position"] = [(-1, 0, 0), (0, 0, 0), (1, 0, 0), (-1, 1, 0), (0, 1, 0), (1, 1, 0)]
vertices["uv"] = [(1, 0), (0, 0), (1, 0), (1, 1), (0, 1), (1, 1)]
vertices["normal"] = (0, 0, 1)
indices = np.array([(0, 1, 4), (0, 4, 3), (1, 2, 5), (1, 5, 4)], np.uint16)

tangents = darboux.generate_tangents(vertices["position"], vertices["normal"], vertices["uv"], indices)

split = darboux.split_vertices(indices, tangents, len(vertices))
print(f"{len(vertices)} vertices became {len(split.source_of_vertex)}")
vertices = vertices[split.source_of_vertex]
vertices["tangent"] = split.tangent_of_vertex
for vertex in vertices:
    print("%g %g %g: tangent %g %g %g %g" % (*vertex["position"], *vertex["tangent"]))
