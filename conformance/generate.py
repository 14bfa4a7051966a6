"""Makes the cases of class large: meshes from a seed, with numbers that are the same in every language.

All choices come from one generator of 32-bit integers. Every number is an integer divided by a power of two, or (in unit normals)
the quotient of two integers, rounded once to single precision.
"""

import argparse
from pathlib import Path

import casefile
from casefile import f32

SAMPLES = 97


class Dice:
    """state = (1664525 state + 1013904223) mod 2^32; a choice below n is (state >> 8) mod n."""

    def __init__(self, seed):
        self.state = seed

    def below(self, n):
        self.state = (1664525 * self.state + 1013904223) % 2**32
        return (self.state >> 8) % n

    def between(self, low, high):
        return low + self.below(high - low + 1)

    def shuffle(self, items):
        """Fisher and Yates, from the end."""
        for at in range(len(items) - 1, 0, -1):
            other = self.below(at + 1)
            items[at], items[other] = items[other], items[at]


def unit(a, b):
    """A unit vector around +z from two integers: (2 a n, 2 b n, n n - a a - b b) / (n n + a a + b b) for n = 64."""
    square = a * a + b * b
    return [f32(x / (4096 + square)) for x in (128 * a, 128 * b, 4096 - square)]


def vertex(case, position, normal, uv):
    case["positions"].append([f32(x) for x in position])
    case["normals"].append(normal)
    case["uvs"].append([f32(x) for x in uv])
    return len(case["positions"]) - 1


def grid(case, dice, size, steep=16):
    """A jittered height field of size by size quads; returns its quads."""
    for y in range(size + 1):
        for x in range(size + 1):
            position = (x + dice.between(-60, 60) / 256, y + dice.between(-60, 60) / 256, dice.between(-steep, steep) / 32)
            normal = unit(dice.between(-8, 8), dice.between(-8, 8))
            vertex(case, position, normal, ((8 * x + dice.between(-2, 2)) / 4096, (8 * y + dice.between(-2, 2)) / 4096))
    row = size + 1
    return [[y * row + x, y * row + x + 1, (y + 1) * row + x + 1, (y + 1) * row + x] for y in range(size) for x in range(size)]


def halves(quads):
    return [half for a, b, c, d in quads for half in ([a, b, c], [a, c, d])]


def terrain(case, dice, size):
    return halves(grid(case, dice, size))


def terrain_steep(case, dice, size):
    return halves(grid(case, dice, size, 48))


def quads(case, dice, size):
    return grid(case, dice, size, 40)


def mixed(case, dice, size):
    """Quads and triangles in random order, each face starting with a random corner."""
    faces = []
    for quad in grid(case, dice, size):
        faces += [quad] if dice.below(2) else halves([quad])
    dice.shuffle(faces)
    turns = [dice.below(len(face)) for face in faces]
    return [face[turn:] + face[:turn] for face, turn in zip(faces, turns)]


def soup(case, dice, size):
    """The height field with a vertex of its own for every corner, in random order."""
    faces = halves(grid(case, dice, size))
    dice.shuffle(faces)
    old = {key: case[key] for key in casefile.INPUTS}
    for key in casefile.INPUTS:
        case[key] = [list(old[key][index]) for face in faces for index in face]
    return [[3 * at, 3 * at + 1, 3 * at + 2] for at in range(len(faces))]


def charts(case, dice, size):
    """Squares of four quads with UVs of their own, every second one mirrored, triangles in random order."""
    faces = []
    for y in range(size):
        for x in range(size):
            mirror = -1 if dice.below(2) else 1
            at = {}
            for j in range(3):
                for i in range(3):
                    position = (2 * x + i, 2 * y + j, ((2 * x + i) * (2 * y + j) % 7) / 8)
                    uv = (mirror * (i + dice.between(-1, 1) / 16) / 64 + x, (j + dice.between(-1, 1) / 16) / 64 + y)
                    at[i, j] = vertex(case, position, unit((2 * x + i) % 5, (2 * y + j) % 3), uv)
            faces += halves([[at[i, j], at[i + 1, j], at[i + 1, j + 1], at[i, j + 1]] for j in range(2) for i in range(2)])
    dice.shuffle(faces)
    return faces


def mirrored(case, dice, size):
    """The height field with u running back from the middle on: one long mirrored seam."""
    faces = halves(grid(case, dice, size))
    middle = 8 * (size // 2)
    for at in range(len(case["uvs"])):
        x = at % (size + 1)
        u = 8 * x if 8 * x <= middle else 2 * middle - 8 * x
        case["uvs"][at][0] = f32(u / 4096)
    return faces


def fan(case, dice, size):
    """Triangles around one vertex, whose border runs along a square."""
    center = vertex(case, (0, 0, 0), unit(2, 3), (0.5, 0.5))
    side = [(i, -size) for i in range(-size, size)]
    border = side + [(-y, x) for x, y in side] + [(-x, -y) for x, y in side] + [(y, -x) for x, y in side]
    ring = [
        vertex(case, (x, y, dice.between(-9, 9) / 8), unit(0, 0), (0.5 + x / 1024 + y / 8192, 0.5 + y / 1024 + dice.between(-3, 3) / 65536))
        for x, y in border
    ]
    return [[center, ring[at], ring[(at + 1) % len(ring)]] for at in range(len(ring))]


def degenerate(case, dice, size):
    """The height field with collapsed triangles and collapsed UVs strewn in."""
    faces = halves(grid(case, dice, size))
    for face in faces:
        chance = dice.below(12)
        if chance == 0:
            face[dice.below(3)] = face[dice.below(3)]
        elif chance == 1:
            case["uvs"][face[0]] = list(case["uvs"][face[1]])
        elif chance == 2:
            case["positions"][face[0]] = list(case["positions"][face[1]])
    return faces


def crowded(case, dice, size):
    """Random triangles among few vertices: edges of many triangles, in both directions."""
    for _ in range(size):
        vertex(case, [dice.between(-4, 4) / 4 for _ in range(3)], unit(dice.between(-9, 9), 0), [dice.between(-4, 4) / 8 for _ in range(2)])
    return [[dice.below(size) for _ in range(3)] for _ in range(20 * size)]


def blocks(case, dice, size):
    """Many small meshes of random faces, whose numbers are few: zeros of both signs, ties, repeats."""
    values = (0.0, -0.0, 1.0, 0.5, -1.0, 2.0)
    faces = []
    for _ in range(size):
        first = len(case["positions"])
        for _ in range(7):
            rows = [[values[dice.below(6)] for _ in range(width)] for width in (3, 2)]
            vertex(case, rows[0], [0.0, -0.0 if dice.below(2) else 0.0, float(dice.below(2))], rows[1])
        faces += [[first + dice.below(7) for _ in range(3 + dice.below(2))] for _ in range(6)]
    return faces


FAMILIES = {f.__name__: f for f in (terrain, terrain_steep, quads, mixed, soup, charts, mirrored, fan, degenerate, crowded, blocks)}


def generate(case):
    """A large case with vertices."""
    made = {**case, **{key: [] for key in casefile.INPUTS}}
    generator = case["generator"]
    faces = FAMILIES[generator["family"]](made, Dice(generator["seed"]), generator["size"])
    made["faces"] = [len(face) for face in faces]
    made["indices"] = [index for face in faces for index in face]
    return made


def write_folder(folder, every):
    folder.mkdir(parents=True, exist_ok=True)
    written = 0
    for path in sorted(casefile.CASES.glob("*.json")):
        case = casefile.read(path)
        if case["class"] == "large":
            casefile.write(folder / path.name, generate(case))
        elif every:
            (folder / path.name).write_bytes(path.read_bytes())
        written += every or case["class"] == "large"
    print(f"{written} cases are in {folder}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", metavar="FOLDER", type=Path, help="where the cases go; it is made if it is missing")
    parser.add_argument("--all", action="store_true", help="copy the small cases, too, as adapters need them")
    given = parser.parse_args()
    write_folder(given.folder, given.all)


if __name__ == "__main__":
    main()
