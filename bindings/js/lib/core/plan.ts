// Topology once, evaluate often.

import { choices, engine, report, surface, type AllExports } from './full.js';
import type { Own } from './wasm-module.js';
import { floats, indexError, rows, write, writeArrays } from './mesh.js';
import type * as types from '../types.js';

/** Where a plan lies. */
interface Place {
  room: Own<AllExports>;
  id: number;
}

/** The instance that new plans go to: browsers allow few of them. */
let newest: Own<AllExports> | undefined;

function drop({ room, id }: Place): void {
  try {
    room.call((exports) => exports.free_plan(id));
  } catch {
    // The instance is lost, and the plan with it.
  }
}

const garbage = new FinalizationRegistry(drop);

/**
 * The weld, groups and subgroups of one mesh, kept to evaluate tangents again after its vertices moved (morph targets, skinning). Methods
 * other than 'mikktspace' run afresh, but for the signs. Memory is freed when the plan is garbage, or by {@link Plan.dispose}.
 */
export class Plan {
  readonly #vertices: number;
  readonly #corners: number;
  #place: Place | null;

  /** The base's own tangents, 4 per corner, as `generateTangents` gives them. */
  readonly base: Float32Array<ArrayBuffer>;

  /** The report of the base's run. */
  readonly report: types.Report;

  /** Parameters and errors as those of `generateTangents`. */
  constructor(
    positions: Float32Array,
    normals: Float32Array,
    uvs: Float32Array,
    indices?: types.Indices | null,
    options: types.TangentOptions = {},
  ) {
    const given = surface(positions, normals, uvs, indices, options);
    const chosen = choices(options);
    const room = newest && !newest.isSpent() ? newest : (newest = engine.own());
    [this.#vertices, this.#corners] = [given.vertices, given.corners];
    [this.#place, this.base, this.report] = room.call((exports) => {
      write(exports, given);
      const id = exports.make_plan(...chosen);
      if (id < 0) throw indexError(given);
      return [{ room, id }, floats(exports, exports.plan_base(id), 4 * given.corners), report(exports)];
    });
    garbage.register(this, this.#place, this);
  }

  /**
   * The tangents of the moved mesh, 4 per corner, in the base's groups and subgroups; signs stay the base's.
   *
   * @param positions 3 per vertex of the base. @param normals Likewise.
   */
  evaluate(positions: Float32Array, normals: Float32Array): Float32Array<ArrayBuffer> {
    return this.#moved(positions, normals, (exports, id) => floats(exports, exports.evaluate_plan(id), 4 * this.#corners));
  }

  /** How many corners a fresh run on the moved mesh would give another tangent (other bits) than {@link Plan.evaluate}. */
  countRegrouped(positions: Float32Array, normals: Float32Array): number {
    return this.#moved(positions, normals, (exports, id) => exports.count_regrouped(id));
  }

  /** Frees memory now. The plan cannot be evaluated any more. */
  dispose(): void {
    if (!this.#place) return;
    garbage.unregister(this);
    drop(this.#place);
    this.#place = null;
  }

  #moved<R>(positions: Float32Array, normals: Float32Array, work: (exports: AllExports, id: number) => R): R {
    const vertices = this.#vertices;
    for (const [name, array] of [['positions', positions], ['normals', normals]] as const) {
      const found = rows(name, array, 3);
      if (found !== vertices) throw new RangeError(`${name} has ${found} elements but the plan has ${vertices} vertices`);
    }
    if (!this.#place) throw new Error('the plan has been disposed of; make another');
    const { room, id } = this.#place;
    return room.call((exports) => {
      writeArrays(exports, [[positions, exports.positions(vertices)], [normals, exports.normals(vertices)]]);
      return work(exports, id);
    });
  }
}
