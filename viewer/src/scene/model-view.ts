// The model on the stage: both sides of the slider, lines over them, and their UV layout.

import { Box3, BufferAttribute, Group, InstancedMesh, LineSegments, Mesh, type BufferGeometry, type Material, Vector3 } from 'three';

import type { Mistakes, Settings } from '../settings';
import type { Arrangement } from '../surface/comparison';
import { inkOf } from './frame-material';
import { seamLines, vectorLines } from './frame-lines';
import { type Copy, placesOf, type Part } from './model-parts';
import { geometryOf, materialOf, sharedOf, type Shared } from './side-geometry';

/** A part, its vertices split for the two sources that are compared. */
interface Piece {
  part: Part;
  arrangement: Arrangement;
  shared: Shared;
  indices: BufferAttribute;
  /** Of both sides, and the mistakes that the right one was made with. */
  geometries: [BufferGeometry, BufferGeometry] | null;
  mistakes: string;
}

/** What is drawn on one side. */
export interface Side {
  model: Group;
  /** The triangles of the UV layout. */
  layout: Group;
}

export class Shown {
  /** The left and the right side. */
  sides: [Side, Side] = [empty(), empty()];
  private pieces: Piece[] = [];

  /** Takes parts in place of those before. */
  arrange(parts: Part[], arrangements: Arrangement[]): void {
    this.pieces.forEach(forget);
    this.pieces = parts.map((part, at) => {
      const arrangement = arrangements[at];
      const [shared, indices] = [sharedOf(part, arrangement), new BufferAttribute(arrangement.indices, 1)];
      return { part, arrangement, shared, indices, geometries: null, mistakes: '' };
    });
  }

  /** What holds all that is seen, wherever parts are. */
  bounds(): Box3 {
    const all = new Box3();
    for (const { part, arrangement } of this.pieces) {
      const own = boundsOf(arrangement.positions);
      if (!own.isEmpty()) placesOf(part).forEach((place) => all.union(own.clone().applyMatrix4(place)));
    }
    return all;
  }

  /** Builds both sides anew, for a model of some radius. */
  build(settings: Settings, radius: number): void {
    this.sides.forEach(dispose);
    this.sides = [this.side(0, settings, radius), this.side(1, settings, radius)];
  }

  private side(at: 0 | 1, settings: Settings, radius: number): Side {
    const side = empty();
    const mistakes = at === 1 ? settings.mistakes : NONE;
    for (const piece of this.pieces) {
      const { part } = piece;
      const hasTangents = isVertexData(piece, settings, at);
      const geometry = geometriesOf(piece, settings)[at];
      const isShaded = settings.paint === 'shaded';
      for (const copy of part.copies) {
        const material = isShaded ? materialOf(part, hasTangents, settings.pattern, mistakes) : inkOf(settings.paint, copy.place, false);
        side.model.add(placed(copy, geometry, material));
      }
      if (settings.layout) side.layout.add(flat(new Mesh(geometry, inkOf(isShaded ? 'sign' : settings.paint, part.copies[0].place, true))));
      this.lines(side, at, piece, geometry, settings, radius);
    }
    return side;
  }

  private lines(side: Side, at: 0 | 1, { part, arrangement }: Piece, geometry: BufferGeometry, settings: Settings, radius: number): void {
    const { positions, normals } = arrangement;
    const tangents = geometry.getAttribute('frame').array as Float32Array;
    const places = placesOf(part);
    const roots = { positions, normals, tangents, places };
    for (const name of ['tangent', 'bitangent', 'normal'] as const) {
      if (settings.vectors[name]) side.model.add(vectorLines(roots, name, settings.length * radius));
    }
    const seams = arrangement.seams[at];
    if (settings.seams && seams.length) side.model.add(seamLines(seams, places));
  }
}

const NONE: Mistakes = { green: false, w: false, v: false };

/** The geometry of both sides. It is kept while nothing in it changes: it may be large. */
function geometriesOf(piece: Piece, settings: Settings): [BufferGeometry, BufferGeometry] {
  const { shared, indices, arrangement } = piece;
  const { mistakes } = settings;
  const key = JSON.stringify([mistakes.w, mistakes.v]);
  if (piece.geometries && piece.mistakes === key) return piece.geometries;
  forget(piece);
  const none = () => new Float32Array(arrangement.sourceOfVertex.length * 4);
  const make = (at: 0 | 1) => {
    const frames = arrangement.tangents[at] ?? none();
    return geometryOf(shared, indices, frames, isVertexData(piece, settings, at), at ? mistakes : NONE);
  };
  piece.mistakes = key;
  return (piece.geometries = [make(0), make(1)]);
}

/** Whether a side's tangents are given to the renderer; what it has none for it derives itself. */
function isVertexData({ arrangement }: Piece, { sources }: Settings, at: 0 | 1): boolean {
  return sources[at] !== 'derivatives' && arrangement.tangents[at] !== null;
}

/** The box that holds points, but for those that are not finite. */
function boundsOf(positions: Float32Array): Box3 {
  const box = new Box3();
  const point = new Vector3();
  for (let at = 0; at < positions.length; at += 3) {
    point.fromArray(positions, at);
    if (Number.isFinite(point.x + point.y + point.z)) box.expandByPoint(point);
  }
  return box;
}

function forget(piece: Piece): void {
  piece.geometries?.forEach((geometry) => geometry.dispose());
  piece.geometries = null;
}

/** At its node's place, as often as there are instances. */
function placed({ place, instances }: Copy, geometry: BufferGeometry, material: Material): Mesh {
  const mesh = instances ? new InstancedMesh(geometry, material, 0) : new Mesh(geometry, material);
  if (mesh instanceof InstancedMesh && instances) [mesh.instanceMatrix, mesh.count] = [instances, instances.count];
  mesh.matrixAutoUpdate = false;
  mesh.matrix.copy(place);
  return mesh;
}

function flat(mesh: Mesh): Mesh {
  mesh.frustumCulled = false;
  return mesh;
}

function empty(): Side {
  return { model: new Group(), layout: new Group() };
}

/** Gives back memory of the graphics card, but for geometry and textures: those belong to pieces and parts. */
function dispose({ model, layout }: Side): void {
  for (const object of [...model.children, ...layout.children] as (Mesh | LineSegments)[]) {
    if (object instanceof LineSegments) object.geometry.dispose();
    for (const material of [object.material].flat() as Material[]) material.dispose();
  }
  model.removeFromParent();
  layout.removeFromParent();
}

