"""Bakes the maps that Blender's Cycles has, too, of one pair with both, and compares texels and processor time.

    python3 benches/bake/compare_maps.py LOW.glb HIGH.glb FOLDER [--size 1024] [--offset 0.02] [--rays 64] [--truth 1024]

Needs Python 3.11 with bpy 4.5 (pip), and a darboux with the feature bake. Both have the same cage, which darboux writes, and two threads. Texels that are not wholly inside the charts
are left out. FOLDER gets the maps of both and pictures of their differences, amplified. Without models, `--sphere CELLS` makes a
wavy sphere of 2 * CELLS * CELLS triangles and a smooth one of 20,000.

The truth of occlusion is that of darboux with --truth rays, so that the noise of both can be told from what they compute differently.
"""

import argparse
import resource
import subprocess
from pathlib import Path
from typing import Callable, Dict, Iterable, List, Tuple

import bpy
import numpy as np

THREADS = 2
KINDS = ["object-normal", "position", "base-color", "roughness", "metalness", "emission"]
"""The maps of one run of darboux beside `ao`, as it names them."""
AMPLIFIED = 8
"""By how much pictures of differences are brighter."""


def select(objects: Iterable[bpy.types.Object]) -> None:
    bpy.ops.object.select_all(action="DESELECT")
    for item in objects:
        item.select_set(True)
        bpy.context.view_layer.objects.active = item


def meshes_of(path: Path) -> List[bpy.types.Object]:
    """The meshes of a GLB, with their transforms applied."""
    before = set(bpy.data.objects)
    bpy.ops.import_scene.gltf(filepath=str(path))
    meshes = [item for item in bpy.data.objects if item not in before and item.type == "MESH"]
    for item in meshes:
        item.data = item.data.copy()
    select(meshes)
    bpy.ops.object.parent_clear(type="CLEAR_KEEP_TRANSFORM")
    bpy.ops.object.transform_apply()
    return meshes


def joined(path: Path) -> bpy.types.Object:
    meshes = meshes_of(path)
    select(meshes)
    if len(meshes) > 1:
        bpy.ops.object.join()
    return bpy.context.view_layer.objects.active


def write_spheres(cells: int, folder: Path) -> Tuple[Path, Path]:
    """A smooth and a wavy sphere without poles."""
    paths = []
    for name, side, height in [("low", 100, 0.0), ("high", cells, 0.01)]:
        bpy.ops.wm.read_factory_settings(use_empty=True)
        v, u = (axis.ravel() / side for axis in np.mgrid[0 : side + 1, 0 : side + 1])
        a, b = 2 * np.pi * u, np.pi * (0.1 + 0.8 * v)
        radius = 1 + height * np.sin(40 * a) * np.sin(30 * b)
        points = np.stack([np.sin(b) * np.sin(a), -np.sin(b) * np.cos(a), np.cos(b)], 1) * radius[:, None]
        corner = (np.arange(side)[:, None] * (side + 1) + np.arange(side)).ravel()
        below = corner + side + 1
        triangles = np.stack([corner, below, below + 1, corner, below + 1, corner + 1], 1).reshape(-1, 3)
        mesh = bpy.data.meshes.new(name)
        mesh.vertices.add(len(points))
        mesh.vertices.foreach_set("co", points.astype(np.float32).ravel())
        mesh.loops.add(triangles.size)
        mesh.loops.foreach_set("vertex_index", triangles.astype(np.int32).ravel())
        mesh.polygons.add(len(triangles))
        mesh.polygons.foreach_set("loop_start", np.arange(0, triangles.size, 3, dtype=np.int32))
        mesh.uv_layers.new().data.foreach_set("uv", np.stack([u, 1 - v], 1)[triangles.ravel()].astype(np.float32).ravel())
        mesh.update(calc_edges=True)
        mesh.shade_smooth()
        material = bpy.data.materials.new("plain")
        material.use_nodes = True
        mesh.materials.append(material)
        item = bpy.data.objects.new(name, mesh)
        bpy.context.scene.collection.objects.link(item)
        paths.append(folder / f"{name}.glb")
        bpy.ops.export_scene.gltf(filepath=str(paths[-1]), export_format="GLB")
    return paths[0], paths[1]


def pixels_of(image: bpy.types.Image) -> np.ndarray:
    """Red, green and blue of an image in linear light, from the lower left corner."""
    width, height = image.size
    pixels = np.empty(4 * width * height, dtype=np.float32)
    image.pixels.foreach_get(pixels)
    return pixels.reshape(height, width, 4)[..., :3]


class Darboux:
    """Runs of the command on a pair."""

    def __init__(self, command: str, low: Path, high: Path, folder: Path, size: int, cage: Path) -> None:
        self.words = [command, "bake", low, "--high", high, "--size", size, "--convention", "blender", "--jobs", THREADS]
        self.words += ["--cage", cage, "--no-high-maps", "--force", "--quiet"]
        self.folder = folder

    def bake(self, name: str, *options: object) -> float:
        """The seconds of processor time of a whole run, with reading and writing."""
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        words = [*self.words, "-o", self.folder / name, *options]
        subprocess.run([str(word) for word in words], check=True, stdout=subprocess.DEVNULL)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime

    def map(self, name: str) -> np.ndarray:
        image = bpy.data.images.load(str(self.folder / name))
        image.colorspace_settings.name = "Non-Color"
        return pixels_of(image)


class Cycles:
    """A scene with the pair, and bakes from one to the other."""

    def __init__(self, low: Path, high: Path, cage: Path, size: int, offset: float) -> None:
        bpy.ops.wm.read_factory_settings(use_empty=True)
        scene = bpy.context.scene
        scene.render.engine = "CYCLES"
        scene.render.threads_mode, scene.render.threads = "FIXED", THREADS
        scene.cycles.device, scene.cycles.use_adaptive_sampling, scene.cycles.use_denoising = "CPU", False, False
        scene.world = bpy.data.worlds.new("world")
        self.high, self.low, self.cage = meshes_of(high), joined(low), joined(cage)
        # Occlusion at any distance, as darboux has it without another choice.
        scene.world.light_settings.distance = 1e5 * offset
        self.cage.hide_render = True
        self.image = bpy.data.images.new("map", size, size, float_buffer=True, is_data=True)
        material = bpy.data.materials.new("baked")
        material.use_nodes = True
        material.node_tree.nodes.active = material.node_tree.nodes.new("ShaderNodeTexImage")
        material.node_tree.nodes.active.image = self.image
        self.low.data.materials.clear()
        self.low.data.materials.append(material)

    def materials(self) -> Iterable[bpy.types.Material]:
        return {slot.material for item in self.high for slot in item.material_slots if slot.material}

    def without_normal_maps(self) -> None:
        """The geometry alone, as darboux bakes it with --no-high-maps."""
        for material in self.materials():
            for node in [node for node in material.node_tree.nodes if node.type == "NORMAL_MAP"]:
                material.node_tree.nodes.remove(node)

    def emit(self, inputs: str) -> Callable[[], None]:
        """Lets the materials emit one of their inputs; returns what undoes it."""
        undo: List[Callable[[], None]] = []
        for material in self.materials():
            tree = material.node_tree
            surface = next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL").inputs["Surface"]
            shader = surface.links[0].from_node
            source, before = shader.inputs[inputs], surface.links[0].from_socket
            node = tree.nodes.new("ShaderNodeEmission")
            if source.links:
                tree.links.new(source.links[0].from_socket, node.inputs["Color"])
            elif inputs == "Base Color":
                node.inputs["Color"].default_value = source.default_value
            else:
                node.inputs["Color"].default_value = (*[source.default_value] * 3, 1)
            tree.links.new(node.outputs[0], surface)
            undo.append(lambda tree=tree, node=node, before=before, surface=surface: (tree.links.new(before, surface), tree.nodes.remove(node)))
        return lambda: [step() for step in undo]

    def bake(self, kind: str, samples: int, **options: object) -> Tuple[np.ndarray, float]:
        """A map, and the seconds of processor time of the bake."""
        bpy.context.scene.cycles.samples = samples
        select([*self.high, self.low])
        before = resource.getrusage(resource.RUSAGE_SELF)
        bpy.ops.object.bake(type=kind, use_selected_to_active=True, use_cage=True, cage_object=self.cage.name, margin=0, **options)
        after = resource.getrusage(resource.RUSAGE_SELF)
        seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
        return pixels_of(self.image).copy(), seconds


def eroded(mask: np.ndarray, by: int) -> np.ndarray:
    for _ in range(by):
        inside = np.pad(mask, 1)
        mask = mask & inside[:-2, 1:-1] & inside[2:, 1:-1] & inside[1:-1, :-2] & inside[1:-1, 2:]
    return mask


def save(picture: np.ndarray, path: Path) -> None:
    height, width = picture.shape[:2]
    image = bpy.data.images.new(path.stem, width, height)
    image.colorspace_settings.name = "Non-Color"
    rgba = np.concatenate([np.clip(picture, 0, 1), np.ones((height, width, 1))], 2)
    image.pixels.foreach_set(rgba.astype(np.float32).ravel())
    image.filepath_raw, image.file_format = str(path), "PNG"
    image.save()
    bpy.data.images.remove(image)


def row(name: str, ours: np.ndarray, theirs: np.ndarray, mask: np.ndarray, unit: str = "") -> None:
    """The differences of the texels of two maps."""
    if unit == "degrees":
        a, b = (2 * image[mask] - 1 for image in (ours, theirs))
        cosines = (a * b).sum(1) / np.maximum(np.linalg.norm(a, axis=1) * np.linalg.norm(b, axis=1), 1e-20)
        differences = np.degrees(np.arccos(np.clip(cosines, -1, 1)))
    else:
        differences = np.abs(ours - theirs)[mask].max(1)
    mean = (ours[mask].mean() - theirs[mask].mean()) if not unit else 0.0
    print(
        f"| {name} | {np.median(differences):.5f} | {np.quantile(differences, 0.95):.5f} | {np.quantile(differences, 0.99):.5f} | "
        f"{np.sqrt((differences**2).mean()):.5f} | {mean:+.5f} | {unit} |",
        flush=True,
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("low", type=Path, nargs="?")
    parser.add_argument("high", type=Path, nargs="?")
    parser.add_argument("folder", type=Path)
    parser.add_argument("--sphere", type=int, help="cells per side of a wavy sphere in place of models")
    parser.add_argument("--size", type=int, default=1024)
    parser.add_argument("--offset", type=float, default=0.02, help="of the cage, in the models' unit")
    parser.add_argument("--rays", type=int, default=64)
    parser.add_argument("--truth", type=int, default=1024)
    parser.add_argument("--darboux", default="darboux")
    options = parser.parse_args()
    folder = options.folder.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    low, high = (options.low, options.high) if options.low else write_spheres(options.sphere or 1000, folder)
    cage = folder / "cage.glb"
    words = [options.darboux, "bake", low, "--high", high, "--size", 16, "-o", folder / "cage.png", "--force", "--quiet"]
    subprocess.run([str(word) for word in [*words, "--cage-offset", options.offset, "--write-cage", cage]], check=True)

    darboux = Darboux(options.darboux, low, high, folder, options.size, cage)
    darboux.bake("mask.png", "--map", "uv-islands", "--padding", 0, "--samples", 1)
    darboux.bake("ours.exr", "--bits", 32, "--map", ",".join(KINDS))
    ours_seconds = darboux.bake("ours-ao.exr", "--bits", 32, "--map", "ao", "--ao-rays", options.rays)
    darboux.bake("truth.exr", "--bits", 32, "--map", "ao", "--ao-rays", options.truth)

    cycles = Cycles(low, high, cage, options.size, options.offset)
    cycles.without_normal_maps()
    mask = eroded(darboux.map("mask.png").max(2) > 0, 2)
    theirs: Dict[str, np.ndarray] = {}
    theirs["object-normal"], _ = cycles.bake("NORMAL", 1, normal_space="OBJECT")
    theirs["position"], _ = cycles.bake("POSITION", 1)
    theirs["emission"], _ = cycles.bake("EMIT", 1)
    theirs["roughness"], _ = cycles.bake("ROUGHNESS", 1)
    theirs["diffuse colour"], _ = cycles.bake("DIFFUSE", 1, pass_filter={"COLOR"})
    for kind, inputs in [("base-color", "Base Color"), ("metalness", "Metallic")]:
        undo = cycles.emit(inputs)
        theirs[kind], _ = cycles.bake("EMIT", 1)
        undo()
    occlusion, their_seconds = cycles.bake("AO", options.rays)
    many, _ = cycles.bake("AO", options.truth)

    ours = {kind: darboux.map(f"ours.{kind}.exr") for kind in KINDS}
    ours_ao, truth = darboux.map("ours-ao.exr"), darboux.map("truth.exr")
    print(f"{mask.sum()} texels; ao with {options.rays} rays: darboux {ours_seconds:.2f} s, Cycles {their_seconds:.2f} s of processor time")
    print("| map | median | 95 % | 99 % | root mean square | mean of ours less mean of theirs | unit |\n|---|---|---|---|---|---|---|")
    for kind in KINDS:
        row(kind, ours[kind], theirs[kind], mask, "degrees" if kind == "object-normal" else "")
    row("base-color, diffuse pass", ours["base-color"], theirs["diffuse colour"], mask)
    row(f"ao, both {options.rays} rays", ours_ao, occlusion, mask)
    row(f"ao, darboux {options.rays}, truth", ours_ao, truth, mask)
    row(f"ao, Cycles {options.rays}, truth", occlusion, truth, mask)
    row(f"ao, both {options.truth} rays", truth, many, mask)
    for kind in KINDS:
        save(AMPLIFIED * np.abs(ours[kind] - theirs[kind]) * mask[..., None], folder / f"difference.{kind}.png")
    save(np.concatenate([ours_ao, occlusion, AMPLIFIED * np.abs(truth - many) * mask[..., None]], 1), folder / "difference.ao.png")


main()
