"""Wrong variants of the twin, one changed operation each, and the table of the cases that notice them.

The table is conformance/MUTATIONS.md; this fails if a new run gives another one.
A case notices a mutation when any bit of any tangent differs from what it expects. Every mutation names the class that must notice it.
"""

import argparse
import math
import multiprocessing
import sys
from pathlib import Path

import casefile
from twin import DEFAULT_SPACE, NAN, Mesh, Triangle, Twin, add, dot, divide, f32, length, normalize, not_zero, scale, sub

TABLE = Path(__file__).parent / "MUTATIONS.md"
MUTATIONS = []


def mutation(noticed_by, sentence):
    """Registers a subclass of Twin. `noticed_by`: the class of cases that must notice it."""

    def register(cls):
        cls.name = "".join("-" + c.lower() if c.isupper() else c for c in cls.__name__).lstrip("-")
        cls.noticed_by, cls.sentence = noticed_by, sentence
        MUTATIONS.append(cls)
        return cls

    return register


# Mistakes of integrations


@mutation("seams", "Results per corner are written through the index list; the last corner of a vertex wins.")
class WrittenThroughIndices(Twin):
    def result(self):
        of_vertex = dict(zip(self.mesh.indices, super().result()))
        return [of_vertex[vertex] for vertex in self.mesh.indices]


@mutation("seams", "Results are written per vertex; the first corner wins.")
class FirstCornerWins(Twin):
    def result(self):
        of_vertex = dict(reversed(list(zip(self.mesh.indices, super().result()))))
        return [of_vertex[vertex] for vertex in self.mesh.indices]


@mutation("core", "Corners are one vertex only if they have one index.")
class WeldByIndexOnly(Twin):
    def weld_key(self, corner):
        return (self.mesh.indices[corner],)


@mutation("seams", "The sign is negated.")
class SignNegated(Twin):
    def result(self):
        return [(x, y, z, -w) for x, y, z, w in super().result()]


@mutation("seams", "v is flipped before the computation.")
class VFlipped(Twin):
    def uv(self, corner):
        u, v = super().uv(corner)
        return u, f32(1.0 - v)


@mutation("seams", "The sign is always +1.")
class SignAlwaysPositive(Twin):
    def result(self):
        return [(x, y, z, 1.0) for x, y, z, _ in super().result()]


@mutation("seams", "The sign is that of the normal's dot product with the cross product of tangent and bitangent, negated where that is zero.")
class SignFromCrossProduct(Twin):
    def result(self):
        rows = []
        for corner, (s, t, _, _) in enumerate(self.spaces()):
            n = self.normal(corner)
            cross = tuple(s[(i + 1) % 3] * t[(i + 2) % 3] - s[(i + 2) % 3] * t[(i + 1) % 3] for i in range(3))
            rows.append(s + (1.0 if dot(n, cross) > 0.0 else -1.0,))
        return rows


@mutation("core", "The bitangent is returned as the tangent.")
class BitangentAsTangent(Twin):
    def result(self):
        return [t + (1.0 if preserves else -1.0,) for _, t, _, preserves in self.spaces()]


@mutation("quads", "Quads are cut from corner 0 to 2 before the computation, so that their halves are faces of their own.")
class TriangulatedBefore(Twin):
    def triangulate(self):
        triangles, first = [], 0
        for face, size in enumerate(self.mesh.faces):
            halves = {3: ((0, 1, 2),), 4: ((0, 1, 2), (0, 2, 3))}.get(size, ())
            triangles += [Triangle((face, h), tuple(first + i for i in half)) for h, half in enumerate(halves)]
            first += size
        return triangles


@mutation("degenerate", "Zero tangents are replaced by (1, 0, 0).")
class ZeroReplaced(Twin):
    def result(self):
        return [(1.0, 0.0, 0.0, row[3]) if row[:3] == (0.0,) * 3 else row for row in super().result()]


@mutation("core", "Tangents are orthogonalised against the normal once more.")
class OrthogonalisedAgain(Twin):
    def result(self):
        return [self.in_plane(self.normal(corner), row[:3]) + row[3:] for corner, row in enumerate(super().result())]


@mutation("hostile", "Faces of more than four corners are cut into fans.")
class PentagonsCut(Twin):
    def triangulate(self):
        triangles, first = super().triangulate(), 0
        for face, size in enumerate(self.mesh.faces):
            triangles += [Triangle(face, (first, first + i, first + i + 1)) for i in range(1, size - 1) if size > 4]
            first += size
        return sorted(triangles, key=lambda triangle: triangle.corners)


@mutation("hostile", "Numbers that are not finite are replaced by zero.")
class NonFiniteReplaced(Twin):
    def finite(self, v):
        return tuple(x if math.isfinite(x) else 0.0 for x in v)

    def position(self, corner):
        return self.finite(super().position(corner))

    def normal(self, corner):
        return self.finite(super().normal(corner))

    def uv(self, corner):
        return self.finite(super().uv(corner))


# Triangles and quads


@mutation("quads", "Quads are always cut from corner 0 to 2.")
class NeverCutAcross(Twin):
    def is_cut_across(self, corners):
        return False


@mutation("quads", "Quads are cut along the other diagonal.")
class OtherDiagonal(Twin):
    def is_cut_across(self, corners):
        return not super().is_cut_across(corners)


@mutation("quads", "Quads are cut by positions before UVs.")
class DiagonalByPositionFirst(Twin):
    def is_cut_across(self, corners):
        return Swapped(self.mesh).is_cut_across(corners)


class Swapped(Twin):
    """Looks at positions before UVs."""

    def uv(self, corner):
        return super().position(corner)

    def position(self, corner):
        return super().uv(corner)


@mutation("quads", "Diagonals that tie are cut from corner 1 to 3.")
class TieCutAcross(Twin):
    def is_cut_across(self, corners):
        a, b, c, d = map(self.uv, corners)
        p, q, r, s = map(self.position, corners)
        tie = all(dot(sub(z, x), sub(z, x)) == dot(sub(w, y), sub(w, y)) for x, y, z, w in ((a, b, c, d), (p, q, r, s)))
        return tie or super().is_cut_across(corners)


@mutation("quads", "The halves of a quad keep their own orientations.")
class HalvesKeepOrientation(Twin):
    def unify_quads(self, good):
        pass


@mutation("quads", "The second half of a quad decides its orientation.")
class SecondHalfDecides(Twin):
    def first_half_decides(self, first, second):
        return False


@mutation("quads", "The larger half decides a quad's orientation also when it has no usable UV area; ties go to the second.")
class TieGoesToSecond(Twin):
    def first_half_decides(self, first, second):
        return abs(self.uv_area(first)) > abs(self.uv_area(second))


# Welding


@mutation("core", "Vertices are joined by position and UV alone.")
class WeldIgnoresNormals(Twin):
    def weld_key(self, corner):
        return self.position(corner) + self.uv(corner)


@mutation("core", "Vertices are joined by position and normal alone.")
class WeldIgnoresUvs(Twin):
    def weld_key(self, corner):
        return self.position(corner) + self.normal(corner)


@mutation("degenerate", "Vertices are joined by bits: -0 differs from +0.")
class WeldByBits(Twin):
    def weld_key(self, corner):
        return tuple((x, math.copysign(1.0, x)) for x in super().weld_key(corner))


@mutation("hostile", "Vertices are joined by bits: NaN equals NaN.")
class NanEqualsNan(Twin):
    def weld_range(self, corners, name):
        first = {}
        for corner in corners:
            name[corner] = first.setdefault(tuple("nan" if x != x else x for x in self.weld_key(corner)), corner)


@mutation("degenerate", "Vertices are joined with a tolerance of 1e-6.")
class WeldWithTolerance(Twin):
    def weld(self, triangles):
        corners = [corner for triangle in triangles for corner in triangle.corners]
        name = {}
        self.weld_range(corners, name)
        for triangle in triangles:
            triangle.vertices = tuple(name.get(corner, corner) for corner in triangle.corners)

    def weld_key(self, corner):
        return tuple(round(x * 1e6) if abs(x) < 1e12 else x for x in super().weld_key(corner))


@mutation("degenerate", "A welded vertex is represented by its first corner.")
class FirstCornerRepresents(Twin):
    def weld(self, triangles):
        name = {}
        self.weld_range(sorted(corner for triangle in triangles for corner in triangle.corners), name)
        for triangle in triangles:
            triangle.vertices = tuple(name.get(corner, corner) for corner in triangle.corners)


@mutation("hostile", "Ranges whose middle overflows are welded.")
class OverflowingRangesWelded(Twin):
    def final_ranges(self, corners):
        return [corners]


@mutation("hostile", "The box of the welding begins with the first corner of the triangle list.")
class BoxOfTriangles(Twin):
    def position(self, corner):
        return super().position(corner)

    def cells(self, corners):
        if not corners:
            return []
        hidden, self.mesh.indices = self.mesh.indices, [self.mesh.indices[corners[0]]] + self.mesh.indices[1:]
        try:
            return super().cells(corners)
        finally:
            self.mesh.indices = hidden


# Degenerate triangles


@mutation("degenerate", "Triangles are degenerate if two of their indices are equal.")
class DegenerateByIndex(Twin):
    def is_degenerate(self, triangle):
        return len({self.mesh.indices[corner] for corner in triangle.corners}) < 3


@mutation("degenerate", "Triangles in a line are degenerate too.")
class SliversDegenerate(Twin):
    def is_degenerate(self, triangle):
        a, b, c = map(self.position, triangle.vertices)
        (x, y, z), (u, v, w) = sub(b, a), sub(c, a)
        flat = all(f32(f32(p * q) - f32(r * s)) == 0.0 for p, q, r, s in ((y, w, z, v), (z, u, x, w), (x, v, y, u)))
        return flat or super().is_degenerate(triangle)


@mutation("degenerate", "The corners of degenerate triangles keep the default.")
class DegeneratesNotFilled(Twin):
    def fill_degenerate(self, degenerate, good, spaces):
        pass


@mutation("degenerate", "The corners of degenerate triangles copy the last good corner of their vertex.")
class LastGoodCornerCopied(Twin):
    def fill_degenerate(self, degenerate, good, spaces):
        super().fill_degenerate(degenerate, good[::-1], spaces)


@mutation("degenerate", "Degenerate halves of quads are filled by vertex, not by position.")
class HalvesFilledByVertex(Twin):
    def fill_degenerate(self, degenerate, good, spaces):
        for triangle in degenerate:
            triangle.face = ("alone", triangle.face)
        super().fill_degenerate(degenerate, good, spaces)


@mutation("degenerate", "All corners of a face have the sign of its first corner.")
class OneSignPerFace(Twin):
    def result(self):
        rows, first = super().result(), 0
        for size in self.mesh.faces:
            rows[first : first + size] = [row[:3] + rows[first][3:] for row in rows[first : first + size]]
            first += size
        return rows


# Derivatives


@mutation("degenerate", "UV areas below 1e-10 count as zero.")
class UvAreaTolerance(Twin):
    def has_uv_area(self, area):
        return abs(area) > 1e-10


@mutation("degenerate", "UV areas count as zero only if they are zero, so that subnormal ones are divided by.")
class SubnormalUvArea(Twin):
    def has_uv_area(self, area):
        return area != 0.0


@mutation("core", "T = du1 e1 + du2 e2: the matrix of UV edges is not inverted.")
class MatrixNotInverted(Twin):
    def derive(self, triangle):
        super().derive(triangle)
        p, uv = [self.position(v) for v in triangle.vertices], [self.uv(v) for v in triangle.vertices]
        (du1, dv1), (du2, dv2) = sub(uv[1], uv[0]), sub(uv[2], uv[0])
        e1, e2 = sub(p[1], p[0]), sub(p[2], p[0])
        triangle.s, triangle.t = normalize(add(scale(du1, e1), scale(du2, e2))), normalize(add(scale(dv1, e1), scale(dv2, e2)))


@mutation("core", "Derivatives are not normalised before they are projected and added.")
class DerivativesNotNormalised(Twin):
    def in_plane(self, normal, v):
        flat = sub(v, scale(dot(normal, v), normal))
        return flat if self.summing else normalize(flat)

    summing = False

    def mean(self, members, normal):
        scaled = [(t, k) for t, k in members if not t.joins_any]
        kept = [(t.s, t.t) for t, _ in scaled]
        for t, _ in scaled:
            t.s, t.t = scale(t.magnitude[0], t.s), scale(t.magnitude[1], t.t)
        self.summing = True
        try:
            return super().mean(members, normal)
        finally:
            self.summing = False
            for (t, _), (s, b) in zip(scaled, kept):
                t.s, t.t = s, b

    def weight(self, triangle, k, normal):
        self.summing = False
        weight = super().weight(triangle, k, normal)
        self.summing = True
        return weight


@mutation("seams", "The orientation comes from the winding in space against the normal.")
class OrientationFromWinding(Twin):
    def derive(self, triangle):
        super().derive(triangle)
        p = [self.position(v) for v in triangle.vertices]
        (x, y, z), (u, v, w) = sub(p[1], p[0]), sub(p[2], p[0])
        cross = (y * w - z * v, z * u - x * w, x * v - y * u)
        triangle.preserves = dot(cross, self.normal(triangle.vertices[0])) > 0.0


# Neighbours and groups


@mutation("degenerate", "All edges are sorted (issue 5 of the reference is mended).")
class EdgesAllSorted(Twin):
    def edge_runs(self, good):
        runs = {}
        for t, triangle in enumerate(good):
            for k in range(3):
                ends = tuple(sorted((triangle.vertices[k], triangle.vertices[(k + 1) % 3])))
                runs.setdefault(ends, []).append((t, k))
        return list(runs.values())


@mutation("degenerate", "Edges of the same direction are paired too.")
class SameWayEdgesPaired(Twin):
    def can_pair(self, upwards, other_upwards):
        return True


@mutation("degenerate", "Only the first two triangles of an edge are paired.")
class TwoTrianglesPerEdge(Twin):
    def edge_runs(self, good):
        return [run[:2] for run in super().edge_runs(good)]


@mutation("seams", "Triangles need no common edge: all of one orientation at a vertex are a group.")
class GroupsWithoutEdges(Twin):
    def build_groups(self, good):
        groups = {}
        for triangle in good:
            for k, vertex in enumerate(triangle.vertices):
                groups.setdefault((vertex, triangle.preserves), []).append((triangle, k))
        return [group for group in groups.values() if not all(t.joins_any for t, _ in group)]


@mutation("seams", "Groups ignore the orientation; a mirrored seam is not split.")
class OrientationIgnored(Twin):
    def may_join(self, triangle, preserves):
        return True


@mutation("degenerate", "Triangles without UV area never adopt an orientation.")
class NeverAdopts(Twin):
    def adopt(self, triangle, preserves):
        pass


@mutation("degenerate", "Triangles without UV area join every group, whatever they adopted.")
class JoinsEveryGroup(Twin):
    def may_join(self, triangle, preserves):
        return triangle.joins_any or super().may_join(triangle, preserves)


@mutation("degenerate", "Triangles without UV area start groups.")
class UvDegeneratesSeed(Twin):
    def can_seed(self, triangle):
        return True


@mutation("degenerate", "Triangles without UV area add to the sums.")
class UvDegeneratesContribute(Twin):
    def contributes(self, triangle):
        return True


# Thresholds


@mutation("thresholds", "The threshold is ignored.")
class ThresholdIgnored(Twin):
    def joins(self, a, b, directions, least):
        return True


@mutation("thresholds", "Cosines equal to that of the threshold join.")
class ThresholdNotStrict(Twin):
    def is_near(self, cosine, least):
        return cosine >= least


@mutation("thresholds", "Only tangents are compared with the threshold.")
class ThresholdOnTangents(Twin):
    def joins(self, a, b, directions, least):
        s = {key: (s, s) for key, (s, _) in directions.items()}
        return super().joins(a, b, s, least)


@mutation("thresholds", "Only bitangents are compared with the threshold.")
class ThresholdOnBitangents(Twin):
    def joins(self, a, b, directions, least):
        return super().joins(a, b, {key: (t, t) for key, (_, t) in directions.items()}, least)


@mutation("thresholds", "Half the threshold is used.")
class ThresholdHalved(Twin):
    def threshold_cosine(self):
        return f32(math.cos(math.radians(self.mesh.threshold / 2))) if math.isfinite(self.mesh.threshold) else NAN


@mutation("thresholds", "The threshold is clamped to 0 to 180 degrees.")
class ThresholdClamped(Twin):
    def threshold_cosine(self):
        if not math.isfinite(self.mesh.threshold):
            return NAN
        radians = f32(f32(min(max(self.mesh.threshold, 0.0), 180.0) * f32(math.pi)) / 180.0)
        return f32(math.cos(radians))


@mutation("thresholds", "Directions are compared with the threshold before their projection.")
class ThresholdBeforeProjection(Twin):
    def joins(self, a, b, directions, least):
        return super().joins(a, b, {id(t): (t.s, t.t) for t in (a, b)}, least)


@mutation("quads", "The halves of a quad are compared with the threshold too.")
class HalvesCompared(Twin):
    def joins(self, a, b, directions, least):
        if a.joins_any or b.joins_any or a is b:
            return True
        return all(self.is_near(dot(x, y), least) for x, y in zip(directions[id(a)], directions[id(b)]))


@mutation("thresholds", "Triangles without UV area are compared with the threshold too.")
class UvDegeneratesCompared(Twin):
    def joins(self, a, b, directions, least):
        if a.face == b.face:
            return True
        return all(self.is_near(dot(x, y), least) for x, y in zip(directions[id(a)], directions[id(b)]))


# Evaluation


@mutation("core", "All triangles have the same weight.")
class EqualWeights(Twin):
    def weight(self, triangle, k, normal):
        return 1.0


@mutation("core", "Triangles are weighted by area.")
class AreaWeights(Twin):
    def weight(self, triangle, k, normal):
        p = [self.position(v) for v in triangle.vertices]
        (x, y, z), (u, v, w) = sub(p[1], p[0]), sub(p[2], p[0])
        return length(tuple(f32(c) for c in (y * w - z * v, z * u - x * w, x * v - y * u)))


@mutation("core", "Angles are taken in space, not in the plane of the normal.")
class AnglesNotProjected(Twin):
    def weight(self, triangle, k, normal):
        before, here, after = (self.position(triangle.vertices[i % 3]) for i in (k + 2, k, k + 1))
        return self.angle(dot(normalize(sub(before, here)), normalize(sub(after, here))))


@mutation("core", "Derivatives are not projected to the plane of the normal.")
class NotProjected(Twin):
    def in_plane(self, normal, v):
        return normalize(v)


@mutation("core", "Normals are normalised before the projection.")
class NormalsNormalised(Twin):
    def normal(self, corner):
        return normalize(super().normal(corner))


@mutation("core", "Sums are added in the opposite order.")
class SumsReversed(Twin):
    def mean(self, members, normal):
        return super().mean(members[::-1], normal)


@mutation("core", "Sums are kept in double precision.")
class SumsInDouble(Twin):
    def accumulate(self, total, weight, v):
        return tuple(a + weight * x for a, x in zip(total, v))

    def mean(self, members, normal):
        s, t, magnitude = super().mean(members, normal)
        return tuple(map(f32, s)), tuple(map(f32, t)), tuple(map(f32, magnitude))


@mutation("core", "Sums use fused multiply-add.")
class FusedMultiplyAdd(Twin):
    def accumulate(self, total, weight, v):
        return tuple(f32(a + weight * x) for a, x in zip(total, v))


@mutation("core", "The arccosine is a polynomial with an error of 7e-5.")
class FastArccosine(Twin):
    def angle(self, cosine):
        x = min(abs(cosine), 1.0)
        angle = math.sqrt(1.0 - x) * (1.5707288 + x * (-0.2121144 + x * (0.0742610 - 0.0187293 * x)))
        return f32(angle if cosine >= 0.0 else math.pi - angle)


@mutation("core", "Vectors are divided by their length instead of multiplied with its reciprocal.")
class NormalisedByDivision(Twin):
    def in_plane(self, normal, v):
        flat = sub(v, scale(dot(normal, v), normal))
        size = length(flat)
        return tuple(divide(x, size) for x in flat) if any(map(not_zero, flat)) else flat


@mutation("degenerate", "Triangles with an angle below one degree add nothing.")
class SliversSkipped(Twin):
    def weight(self, triangle, k, normal):
        weight = super().weight(triangle, k, normal)
        return 0.0 if weight < math.radians(1.0) or weight > math.radians(179.0) else weight


# Slots


@mutation("quads", "The second half of a quad overwrites the corners of the diagonal.")
class SecondHalfOverwrites(Twin):
    def second_write(self, first, second):
        return second


@mutation("quads", "The first half of a quad keeps the corners of the diagonal.")
class FirstHalfKeeps(Twin):
    def second_write(self, first, second):
        return first[:3] + second[3:]


@mutation("quads", "Both halves of a quad are averaged although they are equal.")
class EqualHalvesAveraged(Twin):
    def second_write(self, first, second):
        s, t = (normalize(add(a, b)) for a, b in zip(first[:2], second[:2]))
        return s, t, tuple(f32(0.5 * f32(a + b)) for a, b in zip(first[2], second[2])), second[3]


@mutation("degenerate", "Corners that nothing reaches have the sign +1.")
class DefaultSignPositive(Twin):
    def spaces(self):
        return [DEFAULT_SPACE[:3] + (True,) if space is DEFAULT_SPACE else space for space in super().spaces()]


def notices(mutant, case):
    """True if a case's expected tangents are not those of a mutant."""
    rows = mutant(Mesh(case)).result()
    corner = 0
    for size in case["faces"]:
        for _ in range(size):
            expected = case["expected"]["tangents"][corner]
            if size in (3, 4) and list(map(casefile.word, rows[corner])) != list(map(casefile.word, expected)):
                return True
            corner += 1
    return False


def table(cases):
    """The page, and the faults: mutations that their class does not notice, and cases that notice nothing."""
    with multiprocessing.Pool() as pool:
        noticed = pool.starmap(notices, [(mutant, case) for mutant in MUTATIONS for case in cases], chunksize=64)
    flags = iter(noticed)
    found = {mutant: [case for case in cases if next(flags)] for mutant in MUTATIONS}
    lines = [
        "# Mutations",
        "",
        "Made by `python3 conformance/mutations.py --write`. Each row is the twin (twin.py) with one operation changed; the columns count the cases",
        "of each class that notice the change, and the class that must notice it is bold. Cases of class `large` are not run, because the twin would take",
        "hours; they try sizes at which implementations change to other code.",
        "",
        "| mutation | what is wrong | " + " | ".join(casefile.CLASSES[:-1]) + " |",
        "|---|---|" + "--:|" * (len(casefile.CLASSES) - 1),
    ]
    faults = []
    for mutant, noticed in found.items():
        counts = {name: sum(case["class"] == name for case in noticed) for name in casefile.CLASSES[:-1]}
        if not counts[mutant.noticed_by]:
            faults.append(f"no case of class {mutant.noticed_by} notices {mutant.name}")
        cells = [f"**{n}**" if name == mutant.noticed_by else str(n) for name, n in counts.items()]
        lines.append(f"| {mutant.name} | {mutant.sentence} | " + " | ".join(cells) + " |")
    lines += ["", "## What each case notices", "", "| case | class | mutations | rarest ones |", "|---|---|--:|---|"]
    for case in cases:
        by = sorted((len(noticed), mutant.name) for mutant, noticed in found.items() if case in noticed)
        if not by and {3, 4} & set(case["faces"]):
            faults.append(f"{case['name']} notices no mutation")
        lines.append(f"| {case['name']} | {case['class']} | {len(by)} | {', '.join(name for _, name in by[:3])} |")
    lines += ["", "The cases that notice nothing have no corner with a tangent: they show that such meshes are survived."]
    return "\n".join(lines) + "\n", faults


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--write", action="store_true", help="write the table instead of comparing it")
    given = parser.parse_args()
    text, faults = table([case for case in casefile.read_all() if case["class"] != "large"])
    if given.write:
        TABLE.write_text(text, encoding="utf-8")
    elif TABLE.read_text(encoding="utf-8") != text:
        faults.append(f"{TABLE.name} is out of date: run python3 conformance/mutations.py --write")
    for fault in faults:
        print(fault, file=sys.stderr)
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
