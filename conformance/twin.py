"""MikkTSpace in plain Python, bit for bit, slow and obvious.

The class Twin computes what mikktspace.c (commit 3e895b4) computes, one method per stage. mutations.py changes one operation at a
time in subclasses, to show that the cases notice it. Every operation is done in double precision and rounded to single precision at
once, which gives the bits of single precision. Source: mikktspace.c, M. S. Mikkelsen.
"""

import ctypes
import math

NAN, INF = math.nan, math.inf
LEAST_NORMAL = 2.0**-126
CELLS = 2048
DEFAULT_SPACE = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (1.0, 1.0), False)


def f32(x):
    """Rounds to single precision."""
    return ctypes.c_float(x).value


def add(a, b):
    return tuple(f32(x + y) for x, y in zip(a, b))


def sub(a, b):
    return tuple(f32(x - y) for x, y in zip(a, b))


def scale(factor, v):
    return tuple(f32(factor * x) for x in v)


def divide(a, b):
    """a / b as IEEE 754 defines it for a divisor of zero."""
    if b != 0.0:
        return f32(a / b)
    return NAN if a == 0.0 or a != a else math.copysign(INF, a) * math.copysign(1.0, b)


def dot(a, b):
    """The sum of products from left to right."""
    total = f32(a[0] * b[0])
    for x, y in zip(a[1:], b[1:]):
        total = f32(total + f32(x * y))
    return total


def length(v):
    return f32(math.sqrt(dot(v, v)))


def equal(a, b):
    """Equal as floats: NaN equals nothing. Python's == takes two references to one NaN for equal."""
    return all(x == y for x, y in zip(a, b))


def not_zero(x):
    return abs(x) > LEAST_NORMAL


def normalize(v):
    """Three products with the reciprocal of the length; a zero vector stays."""
    if not any(map(not_zero, v)):
        return v
    return scale(divide(1.0, length(v)), v)


class Mesh:
    """The arrays of a case. A corner is the index into `indices`."""

    def __init__(self, case):
        def rows(key):
            return [tuple(map(float, row)) for row in case[key]]

        self.positions, self.normals, self.uvs = rows("positions"), rows("normals"), rows("uvs")
        self.indices, self.faces = case["indices"], case["faces"]
        self.threshold = float(case["threshold"])


class Triangle:
    """A triangle, or half of a quad: its face, its corners and what the stages find out."""

    def __init__(self, face, corners):
        self.face, self.corners = face, corners
        self.vertices = None
        self.neighbours, self.groups = [None] * 3, [None] * 3


class Twin:
    def __init__(self, mesh):
        self.mesh = mesh

    def position(self, corner):
        return self.mesh.positions[self.mesh.indices[corner]]

    def normal(self, corner):
        return self.mesh.normals[self.mesh.indices[corner]]

    def uv(self, corner):
        return self.mesh.uvs[self.mesh.indices[corner]]

    def result(self):
        """The tangent and sign of each corner."""
        return [s + (1.0 if preserves else -1.0,) for s, _, _, preserves in self.spaces()]

    def spaces(self):
        """Tangent, bitangent, magnitudes and orientation of each corner."""
        triangles = self.triangulate()
        self.weld(triangles)
        degenerate = [t for t in triangles if self.is_degenerate(t)]
        good = [t for t in triangles if not self.is_degenerate(t)]
        for triangle in good:
            self.derive(triangle)
        self.unify_quads(good)
        self.find_neighbours(good)
        groups = self.build_groups(good)
        spaces = [None] * len(self.mesh.indices)
        for group in groups:
            self.write_group(group, spaces)
        self.fill_degenerate(degenerate, good, spaces)
        return [space or DEFAULT_SPACE for space in spaces]

    # Triangles

    def triangulate(self):
        triangles, first = [], 0
        for face, size in enumerate(self.mesh.faces):
            a, b, c, d = range(first, first + 4)
            if size == 3:
                triangles.append(Triangle(face, (a, b, c)))
            elif size == 4:
                across = self.is_cut_across((a, b, c, d))
                halves = ((a, b, d), (b, c, d)) if across else ((a, b, c), (a, c, d))
                triangles += [Triangle(face, half) for half in halves]
            first += size
        return triangles

    def is_cut_across(self, corners):
        """True if a quad is cut from corner 1 to 3: by UVs, on a tie by positions."""
        for attribute in (self.uv, self.position):
            a, b, c, d = map(attribute, corners)
            ac, bd = dot(sub(c, a), sub(c, a)), dot(sub(d, b), sub(d, b))
            if ac < bd or bd < ac:
                return bd < ac
        return False

    # Welding

    def weld(self, triangles):
        """Names the vertex of every corner after one of the corners that equal it."""
        corners = [corner for triangle in triangles for corner in triangle.corners]
        name = {}
        for cell in self.cells(corners):
            for final in self.final_ranges(cell):
                self.weld_range(final, name)
        for triangle in triangles:
            triangle.vertices = tuple(name.get(corner, corner) for corner in triangle.corners)

    def cells(self, corners):
        """Sorts the corners into cells along the longest axis. The box starts with corner 0 and misses the first of the list."""
        if not corners:
            return []
        low, high = self.bounds([self.position(0)] + [self.position(corner) for corner in corners[1:]])
        axis = self.longest_axis(low, high)
        extent = f32(high[axis] - low[axis])
        cells = {}
        for corner in corners:
            place = f32(CELLS * divide(f32(self.position(corner)[axis] - low[axis]), extent))
            cell = min(int(place), CELLS - 1) if 0.0 <= place < 2.0**31 else 0
            cells.setdefault(cell, []).append(corner)
        return [cells[cell] for cell in sorted(cells)]

    def bounds(self, positions):
        low, high = list(positions[0]), list(positions[0])
        for position in positions[1:]:
            for axis, value in enumerate(position):
                low[axis] = value if value < low[axis] else low[axis]
                high[axis] = value if value > high[axis] else high[axis]
        return low, high

    def longest_axis(self, low, high):
        x, y, z = sub(high, low)
        return 1 if y > x and y > z else 2 if z > x else 0

    def final_ranges(self, corners):
        """Halves the corners until no float lies between the ends of a range, exchanging as quicksort does."""
        if len(corners) < 2:
            return [corners]
        low, high = self.bounds([self.position(corner) for corner in corners])
        axis = self.longest_axis(low, high)
        middle = f32(0.5 * f32(high[axis] + low[axis]))
        if not math.isfinite(middle):
            return []
        if middle >= high[axis] or middle <= low[axis]:
            return [corners]
        left, right = 0, len(corners)
        while True:
            while left < right and self.position(corners[left])[axis] < middle:
                left += 1
            while left < right and not self.position(corners[right - 1])[axis] < middle:
                right -= 1
            if left == right:
                break
            corners[left], corners[right - 1] = corners[right - 1], corners[left]
            left, right = left + 1, right - 1
        return self.final_ranges(corners[:left]) + self.final_ranges(corners[left:])

    def weld_range(self, corners, name):
        first = {}
        for corner in corners:
            key = self.weld_key(corner)
            if all(x == x for x in key):
                name[corner] = first.setdefault(key, corner)

    def weld_key(self, corner):
        """Corners with equal keys are one vertex. -0 equals +0, NaN equals nothing."""
        return self.position(corner) + self.normal(corner) + self.uv(corner)

    # Degenerate triangles

    def is_degenerate(self, triangle):
        a, b, c = map(self.position, triangle.vertices)
        return equal(a, b) or equal(a, c) or equal(b, c)

    def fill_degenerate(self, degenerate, good, spaces):
        half = {triangle.face: triangle for triangle in reversed(good)}
        first = {}
        for triangle in good:
            for corner, vertex in zip(triangle.corners, triangle.vertices):
                first.setdefault(vertex, corner)
        for triangle in degenerate:
            for corner, vertex in zip(triangle.corners, triangle.vertices):
                if triangle.face not in half and vertex in first:
                    spaces[corner] = spaces[first[vertex]]
        for triangle in degenerate:
            present = half[triangle.face].corners if triangle.face in half else ()
            for corner in triangle.corners:
                same = [c for c in present if equal(self.position(c), self.position(corner))]
                if corner not in present and same:
                    spaces[corner] = spaces[same[0]]

    # Derivatives

    def derive(self, triangle):
        """dP/du and dP/dv, their lengths, and whether UVs keep the orientation."""
        p, uv = [self.position(v) for v in triangle.vertices], [self.uv(v) for v in triangle.vertices]
        e1, e2 = sub(p[1], p[0]), sub(p[2], p[0])
        (du1, dv1), (du2, dv2) = sub(uv[1], uv[0]), sub(uv[2], uv[0])
        s, t = sub(scale(dv2, e1), scale(dv1, e2)), add(scale(-du2, e1), scale(du1, e2))
        area = self.uv_area(triangle)
        triangle.preserves, triangle.joins_any = area > 0.0, True
        triangle.magnitude = (0.0, 0.0)
        if self.has_uv_area(area):
            sign = 1.0 if triangle.preserves else -1.0
            lengths = length(s), length(t)
            s = scale(divide(sign, lengths[0]), s) if not_zero(lengths[0]) else s
            t = scale(divide(sign, lengths[1]), t) if not_zero(lengths[1]) else t
            triangle.magnitude = tuple(divide(x, abs(area)) for x in lengths)
            triangle.joins_any = not all(map(not_zero, triangle.magnitude))
        triangle.s, triangle.t = s, t

    def uv_area(self, triangle):
        """Twice the signed area in UV space."""
        uv = [self.uv(v) for v in triangle.vertices]
        (du1, dv1), (du2, dv2) = sub(uv[1], uv[0]), sub(uv[2], uv[0])
        return f32(f32(du1 * dv2) - f32(dv1 * du2))

    def has_uv_area(self, area):
        return not_zero(area)

    def unify_quads(self, good):
        """Gives both halves of a quad the orientation of the larger one."""
        for first, second in zip(good, good[1:]):
            if first.face == second.face:
                decides = first if self.first_half_decides(first, second) else second
                first.preserves = second.preserves = decides.preserves

    def first_half_decides(self, first, second):
        return second.joins_any or abs(self.uv_area(first)) >= abs(self.uv_area(second))

    # Neighbours

    def find_neighbours(self, good):
        def upwards(edge):
            t, k = edge
            return good[t].vertices[k] < good[t].vertices[(k + 1) % 3]

        for run in self.edge_runs(good):
            for at, edge in enumerate(run):
                (t, k) = edge
                if good[t].neighbours[k] is not None:
                    continue
                for other in run[at + 1 :]:
                    if good[other[0]].neighbours[other[1]] is None and self.can_pair(upwards(edge), upwards(other)):
                        good[t].neighbours[k] = good[other[0]]
                        good[other[0]].neighbours[other[1]] = good[t]
                        break

    def can_pair(self, upwards, other_upwards):
        return upwards != other_upwards

    def edge_runs(self, good):
        """Runs of half-edges with equal ends. The last ones are not sorted (issue 5 of the reference)."""

        def ends(edge):
            t, k = edge
            return tuple(sorted((good[t].vertices[k], good[t].vertices[(k + 1) % 3])))

        edges = [(t, k) for t in range(len(good)) for k in range(3)]
        if not edges:
            return []
        self.quicksort(edges, lambda edge: ends(edge)[0])
        tail = next(i for i in range(len(edges)) if ends(edges[i])[0] == ends(edges[-1])[0])
        edges[:tail] = sorted(edges[:tail], key=lambda edge: (ends(edge), edge))
        runs = []
        for edge in edges:
            if runs and ends(runs[-1][0]) == ends(edge):
                runs[-1].append(edge)
            else:
                runs.append([edge])
        return [sorted(run) for run in runs[:-1]] + runs[-1:]

    def quicksort(self, edges, key):
        """The reference's unstable sort. Both parts go on with the seed of the whole."""
        waiting = [(0, len(edges) - 1, 39871946)]
        while waiting:
            first, last, seed = waiting.pop()
            if last - first < 1:
                continue
            if last - first == 1:
                if key(edges[first]) > key(edges[last]):
                    edges[first], edges[last] = edges[last], edges[first]
                continue
            turn = seed & 31
            seed = (seed + ((seed << turn | seed >> (32 - turn)) & 0xFFFFFFFF) + 3) & 0xFFFFFFFF
            pivot = key(edges[first + seed % (last - first + 1)])
            left, right = first, last
            while left <= right:
                while key(edges[left]) < pivot:
                    left += 1
                while key(edges[right]) > pivot:
                    right -= 1
                if left <= right:
                    edges[left], edges[right] = edges[right], edges[left]
                    left, right = left + 1, right - 1
            waiting += [(first, right, seed), (left, last, seed)]

    # Groups

    def build_groups(self, good):
        """Lists of (triangle, corner index) around a vertex, connected by edges, of one orientation."""
        groups = []
        for seed in good:
            for k in range(3):
                if self.can_seed(seed) and seed.groups[k] is None:
                    groups.append(self.flood(seed, seed.vertices[k], len(groups)))
        return groups

    def can_seed(self, triangle):
        return not triangle.joins_any

    def flood(self, seed, vertex, number):
        members, waiting, preserves = [], [seed], seed.preserves
        while waiting:
            triangle = waiting.pop()
            k = triangle.vertices.index(vertex)
            if triangle.groups[k] is not None:
                continue
            if triangle.joins_any and triangle.groups == [None] * 3:
                self.adopt(triangle, preserves)
            if self.may_join(triangle, preserves):
                triangle.groups[k] = number
                members.append((triangle, k))
                around = triangle.neighbours[(k + 2) % 3], triangle.neighbours[k]
                waiting += [neighbour for neighbour in around if neighbour]
        return members

    def adopt(self, triangle, preserves):
        triangle.preserves = preserves

    def may_join(self, triangle, preserves):
        return triangle.preserves == preserves

    # Evaluation

    def threshold_cosine(self):
        radians = divide(f32(self.mesh.threshold * f32(math.pi)), 180.0)
        return f32(math.cos(radians)) if math.isfinite(radians) else NAN

    def write_group(self, group, spaces):
        """Gives each member the mean of its subgroup; the second write to a corner averages."""
        least = self.threshold_cosine()
        normal = self.normal(group[0][0].vertices[group[0][1]])
        ascending = sorted(group, key=lambda member: member[0].corners)
        directions = {id(t): (self.in_plane(normal, t.s), self.in_plane(normal, t.t)) for t, _ in group}
        known = {}
        for triangle, k in group:
            subgroup = [other for other in ascending if self.joins(triangle, other[0], directions, least)]
            key = tuple(id(member[0]) for member in subgroup)
            if key not in known:
                known[key] = self.mean(subgroup, normal)
            space = known[key] + (triangle.preserves,)
            corner = triangle.corners[k]
            spaces[corner] = space if spaces[corner] is None else self.second_write(spaces[corner], space)

    def in_plane(self, normal, v):
        return normalize(sub(v, scale(dot(normal, v), normal)))

    def joins(self, a, b, directions, least):
        if a.joins_any or b.joins_any or a.face == b.face:
            return True
        return all(self.is_near(dot(x, y), least) for x, y in zip(directions[id(a)], directions[id(b)]))

    def is_near(self, cosine, least):
        return cosine > least

    def mean(self, members, normal):
        """The sum over members, weighted by the angle at the corner, normalised."""
        s, t, magnitude, total = (0.0,) * 3, (0.0,) * 3, (0.0, 0.0), 0.0
        for triangle, k in members:
            if self.contributes(triangle):
                weight = self.weight(triangle, k, normal)
                s = self.accumulate(s, weight, self.in_plane(normal, triangle.s))
                t = self.accumulate(t, weight, self.in_plane(normal, triangle.t))
                magnitude = self.accumulate(magnitude, weight, triangle.magnitude)
                total = f32(total + weight)
        if total > 0.0:
            magnitude = tuple(divide(x, total) for x in magnitude)
        return normalize(s), normalize(t), magnitude

    def contributes(self, triangle):
        return not triangle.joins_any

    def accumulate(self, total, weight, v):
        return add(total, scale(weight, v))

    def weight(self, triangle, k, normal):
        before, here, after = (self.position(triangle.vertices[i % 3]) for i in (k + 2, k, k + 1))
        cosine = dot(self.in_plane(normal, sub(before, here)), self.in_plane(normal, sub(after, here)))
        return self.angle(cosine)

    def angle(self, cosine):
        return f32(math.acos(min(max(cosine, -1.0), 1.0))) if cosine == cosine else NAN

    def second_write(self, first, second):
        if all(map(equal, first[:3], second[:3])):
            return first[:3] + second[3:]
        s, t = (normalize(add(a, b)) for a, b in zip(first[:2], second[:2]))
        return s, t, tuple(f32(0.5 * f32(a + b)) for a, b in zip(first[2], second[2])), second[3]
