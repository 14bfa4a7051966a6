"""Writes polygons.obj, 120 faces of 5 to 40 corners, most of them concave, and polygons.txt, the triangles into which Blender cuts each.

    pip install bpy==5.0.1 && python polygons.py

A line of polygons.txt has the corners of the triangles of one face, numbered within the face. Positions are multiples of 1/256, so that six decimals
are exact.
"""

import math
import os
import random

import bpy

HERE = os.path.dirname(os.path.abspath(__file__))
FACES = 120


def face(number):
    """A star-shaped face in a random plane. Every third one is convex; every fourth has corners on straight lines."""
    dice = random.Random(number)
    corners = dice.randint(5, 12) if number % 5 else dice.randint(13, 40)
    is_convex = number % 3 == 0
    angles = sorted(dice.uniform(0, math.tau) for _ in range(corners)) if is_convex else [i * math.tau / corners for i in range(corners)]
    radii = [1 if is_convex else dice.uniform(0.3, 1) for _ in range(corners)]
    flat = [(r * math.cos(a), r * math.sin(a)) for r, a in zip(radii, angles)]
    if number % 4 == 1:
        flat[1] = ((flat[0][0] + flat[2][0]) / 2, (flat[0][1] + flat[2][1]) / 2)
    roll, tilt = dice.uniform(0, math.tau), dice.uniform(0, math.pi)
    points = []
    for x, y in flat:
        y, z = y * math.cos(tilt), y * math.sin(tilt)
        x, y = x * math.cos(roll) - y * math.sin(roll), x * math.sin(roll) + y * math.cos(roll)
        points.append(tuple(round(value * 256) / 256 for value in (x, y, z)))
    return points


def main():
    positions, faces = [], []
    for number in range(FACES):
        points = face(number)
        faces.append(range(len(positions), len(positions) + len(points)))
        positions += points
    mesh = bpy.data.meshes.new("Polygons")
    mesh.from_pydata(positions, [], [list(corners) for corners in faces])
    mesh.calc_loop_triangles()
    triangles = [[] for _ in faces]
    for triangle in mesh.loop_triangles:
        first = faces[triangle.polygon_index].start
        triangles[triangle.polygon_index] += [mesh.loops[loop].vertex_index - first for loop in triangle.loops]
    with open(os.path.join(HERE, "polygons.obj"), "w") as out:
        out.write("o Polygons\n")
        out.writelines("v %.8f %.8f %.8f\n" % point for point in positions)
        out.writelines("f " + " ".join(str(corner + 1) for corner in corners) + "\n" for corners in faces)
    with open(os.path.join(HERE, "polygons.txt"), "w") as out:
        out.writelines(" ".join(map(str, corners)) + "\n" for corners in triangles)


main()
