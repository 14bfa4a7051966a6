// Builds the three.js objects of the model: both sides of the slider, lines over them, and their UV layouts.

import { Box3, BufferAttribute, Group, InstancedMesh, type Intersection, LineSegments, Mesh, MeshBasicMaterial, PlaneGeometry, Sphere, SRGBColorSpace, type BufferGeometry, type Material, type Texture, Vector3 } from 'three';

import { isLit, type Mistakes, type Settings } from '../settings';
import { cornerAngles, NO_ANGLE } from '../surface/angles';
import type { Comparison } from '../surface/comparison';
import type { BakedMap } from './baked-map';
import { frameMaterial } from './frame-material';
import { groundShadow, type GroundShadow, type NoShadow } from './ground-shadow';
import { seamLines, vectorLines } from './frame-lines';
import { boundsOfCopies, type Copy, placesOf, type Part } from './model-parts';
import { sharedAttributes, sideGeometry, sideMaterial, type SharedAttributes } from './side-geometry';

/** A part with the data of both sides. */
interface ComparedPart {
  part: Part;
  comparison: Comparison;
  shared: SharedAttributes;
  indices: BufferAttribute;
  /** The geometries of both sides, or null before they are built. */
  geometries: [BufferGeometry, BufferGeometry] | null;
  /** The mistakes that the right geometry was built with. */
  mistakes: string;
}

/** The objects of one side. */
export interface Side {
  model: Group;
  /** The triangles of the UV layout. */
  layout: Group;
}

/** What is known at a corner of the model, in the coordinates of its mesh. */
export interface Values {
  partName: string;
  triangle: number;
  corner: number;
  /** The number of the vertex in the file. */
  vertex: number;
  position: number[];
  normal: number[];
  /** xyz and w; null without a tangent. */
  tangent: number[] | null;
  uv: number[] | null;
  /** To the tangent of the other side, in degrees; null where there is none. */
  angle: number | null;
}

/** A model, and the objects that show it. */
export class ModelView {
  private parts: ComparedPart[] = [];
  /** The shadow on the ground, and the parts that cast it; null before it is asked for. */
  private shadow: { of: string; shadow: GroundShadow | NoShadow } | null = null;

  /** Replaces the parts. */
  setParts(parts: Part[], comparisons: Comparison[]): void {
    this.parts.forEach(disposeGeometries);
    this.shadow = null;
    this.parts = parts.map((part, at) => {
      const comparison = comparisons[at];
      const [shared, indices] = [sharedAttributes(part, comparison), new BufferAttribute(comparison.indices, 1)];
      return { part, comparison, shared, indices, geometries: null, mistakes: '' };
    });
  }

  /** The bounding box of all parts. */
  bounds(): Box3 {
    return this.parts.reduce((all, _, at) => all.union(this.boundsOfPart(at)), new Box3());
  }

  /** The bounding box of all copies of a part. */
  boundsOfPart(at: number): Box3 {
    const { part, comparison } = this.parts[at];
    return boundsOfCopies(part, comparison.positions);
  }

  /** The shadow on the ground of the parts that are shown, or why there is none. */
  groundShadow(hidden: Set<number>): GroundShadow | NoShadow {
    const shown = this.parts.filter((_, at) => !hidden.has(at));
    const of = [...hidden].join();
    if (this.shadow?.of !== of) {
      const placed = shown.map(({ part, comparison }) => ({ positions: comparison.positions, indices: comparison.indices, places: placesOf(part) }));
      this.shadow = { of, shadow: groundShadow(placed) };
    }
    return this.shadow.shadow;
  }

  /** The values at the corner that is nearest to a hit on one of the meshes. */
  valuesAt({ object, face, faceIndex, barycoord }: Intersection<Mesh>, side: 0 | 1): Values {
    const { part, comparison } = this.parts[object.userData.part];
    const { sourceOfVertex, positions, normals, uvs, tangents } = comparison;
    const weights = barycoord!.toArray();
    const corner = weights.indexOf(Math.max(...weights));
    const vertex = [face!.a, face!.b, face!.c][corner];
    const at = (array: Float32Array, width: number) => array.subarray(vertex * width, (vertex + 1) * width);
    const own = tangents[side];
    const [left, right] = tangents.map((field) => field && at(field, 4));
    const angle = left && right ? cornerAngles(left, right)[0] : NO_ANGLE;
    return {
      partName: part.name,
      triangle: faceIndex!,
      corner: 3 * faceIndex! + corner,
      vertex: sourceOfVertex[vertex],
      position: [...at(positions, 3)],
      normal: [...at(normals, 3)],
      tangent: own && [...at(own, 4)],
      uv: part.surface.uvs && [...at(uvs, 2)],
      angle: angle === NO_ANGLE ? null : angle,
    };
  }

  /** Builds a side: 0 is the left one. `radius` is that of the model; `baked`: the map in place of the materials' own, or null. */
  side(at: 0 | 1, settings: Settings, radius: number, baked: BakedMap | null = null): Side {
    const side = empty();
    const mistakes = at === 1 ? settings.mistakes : NONE;
    for (const [number, compared] of this.parts.entries()) {
      if (settings.hidden.has(number)) continue;
      const { part } = compared;
      const hasTangents = isVertexData(compared, settings, at);
      const geometry = geometriesOf(compared, settings)[at];
      const isShaded = isLit(settings.paint);
      const map = baked?.covers(part) ? baked : null;
      for (const copy of part.copies) {
        const material = isShaded ? sideMaterial(part, hasTangents, settings.paint, mistakes, map) : frameMaterial(settings.paint, copy.place, false);
        const mesh = meshOf(copy, geometry, material);
        mesh.userData.part = number;
        side.model.add(mesh);
        const misses = isShaded ? map?.missesOf(part) : null;
        if (misses) side.model.add(meshOf(copy, geometry, misses));
        if (settings.wireframe) side.model.add(meshOf(copy, geometry, new MeshBasicMaterial(WIRES)));
      }
      if (settings.layout) addLayout(side, part, geometry, isShaded ? 'sign' : settings.paint, map);
      this.addLines(side, at, compared, geometry, settings, radius);
    }
    return side;
  }

  private addLines(side: Side, at: 0 | 1, { part, comparison }: ComparedPart, geometry: BufferGeometry, settings: Settings, radius: number): void {
    const { positions, normals } = comparison;
    const tangents = geometry.getAttribute('frame').array as Float32Array;
    const places = placesOf(part);
    const vertices = { positions, normals, tangents, places };
    for (const name of ['tangent', 'bitangent', 'normal'] as const) {
      if (settings.vectors[name]) side.model.add(vectorLines(vertices, name, settings.length * radius));
    }
    const seams = comparison.seams[at];
    if (settings.seams && seams.length) side.model.add(seamLines(seams, places));
  }
}

/** The look of edges, on the surface and in the UV layout. */
const WIRES = { color: 0x101216, wireframe: true, transparent: true, opacity: 0.55, toneMapped: false } as const;

/** Adds a part to the UV layout: its texture once, its triangles and their edges. */
function addLayout(side: Side, part: Part, geometry: BufferGeometry, paint: Settings['paint'], baked: BakedMap | null): void {
  const { map, normalMap } = part.material;
  const texture = baked ? asColors(baked.textureOf(part)) : (map ?? (normalMap && asColors(normalMap)));
  if (texture && !side.layout.children.length) {
    const square = new Mesh(new PlaneGeometry().translate(0.5, 0.5, 0), new MeshBasicMaterial({ map: texture, toneMapped: false, depthTest: false }));
    // Rows of images count downwards in glTF.
    square.geometry.getAttribute('uv').array.forEach((x, at, uvs) => at % 2 && (uvs[at] = 1 - x));
    side.layout.add(square);
  }
  const { place } = part.copies[0];
  side.layout.add(layoutMesh(geometry, frameMaterial(paint, place, true)), layoutMesh(geometry, layoutEdges(frameMaterial(paint, place, true))));
}

const colored = new WeakMap<Texture, Texture>();

/** A normal map whose texels are shown as the colours that they are in its file. */
function asColors(texture: Texture): Texture {
  const found = colored.get(texture) ?? texture.clone();
  found.colorSpace = SRGBColorSpace;
  colored.set(texture, found);
  return found;
}

/** The material of edges in the UV layout. */
function layoutEdges(material: ReturnType<typeof frameMaterial>): ReturnType<typeof frameMaterial> {
  material.wireframe = true;
  material.defines.EDGES = '';
  return material;
}

const NONE: Mistakes = { green: false, w: false, v: false };

/** The geometries of both sides, rebuilt only where the mistakes changed. */
function geometriesOf(part: ComparedPart, settings: Settings): [BufferGeometry, BufferGeometry] {
  const { shared, indices, comparison } = part;
  const { mistakes } = settings;
  const key = JSON.stringify([mistakes.w, mistakes.v]);
  if (part.geometries && part.mistakes === key) return part.geometries;
  disposeGeometries(part);
  const zeros = () => new Float32Array(comparison.sourceOfVertex.length * 4);
  const make = (at: 0 | 1) => {
    const frames = comparison.tangents[at] ?? zeros();
    const geometry = sideGeometry(shared, indices, frames, isVertexData(part, settings, at), at ? mistakes : NONE);
    // three.js would find none where a position is not finite.
    geometry.boundingSphere = boundsOf(comparison.positions).getBoundingSphere(new Sphere());
    return geometry;
  };
  part.mistakes = key;
  return (part.geometries = [make(0), make(1)]);
}

/** Whether the renderer gets the tangents of a side as a vertex attribute. Without them it uses derivatives. */
function isVertexData({ comparison }: ComparedPart, { sources }: Settings, at: 0 | 1): boolean {
  return sources[at] !== 'derivatives' && comparison.tangents[at] !== null;
}

/** The bounding box of the finite points. */
function boundsOf(positions: Float32Array): Box3 {
  const box = new Box3();
  const point = new Vector3();
  for (let at = 0; at < positions.length; at += 3) {
    point.fromArray(positions, at);
    if (Number.isFinite(point.x + point.y + point.z)) box.expandByPoint(point);
  }
  return box;
}

function disposeGeometries(part: ComparedPart): void {
  part.geometries?.forEach((geometry) => geometry.dispose());
  part.geometries = null;
}

/** A mesh, or an instanced mesh, at the place of a copy. */
function meshOf({ place, instances }: Copy, geometry: BufferGeometry, material: Material): Mesh {
  const mesh = instances ? new InstancedMesh(geometry, material, 0) : new Mesh(geometry, material);
  if (mesh instanceof InstancedMesh && instances) [mesh.instanceMatrix, mesh.count] = [instances, instances.count];
  mesh.matrixAutoUpdate = false;
  mesh.matrix.copy(place);
  return mesh;
}

/** A mesh for the UV layout, whose positions say nothing about where it is drawn. */
function layoutMesh(geometry: BufferGeometry, material: Material): Mesh {
  const mesh = new Mesh(geometry, material);
  mesh.frustumCulled = false;
  return mesh;
}

/** A side without objects. */
export function empty(): Side {
  return { model: new Group(), layout: new Group() };
}

/** Removes a side. Frees materials and line geometries; other geometries and textures are shared, and stay. */
export function dispose({ model, layout }: Side): void {
  for (const object of [...model.children, ...layout.children] as (Mesh | LineSegments)[]) {
    if (object instanceof LineSegments) object.geometry.dispose();
    for (const material of [object.material].flat() as Material[]) material.dispose();
  }
  model.removeFromParent();
  layout.removeFromParent();
}

