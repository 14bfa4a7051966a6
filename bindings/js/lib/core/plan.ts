// `Plan`: groups a mesh once, and evaluates its tangents again whenever its vertices have moved.

import { rowCount } from './checks.js';
import { fullModule, readReport, tangentMesh, tangentOptions, type FullExports } from './full.js';
import { indexError, readFloats, writeArrays, writeMesh } from './mesh.js';
import type { OwnInstance } from './wasm-module.js';
import type * as types from '../types.js';

/** The instance that holds a plan, and the plan's id there. */
interface Handle {
  instance: OwnInstance<FullExports>;
  id: number;
}

/** New plans share this instance until it is full, because browsers limit the number of instances. */
let newest: OwnInstance<FullExports> | undefined;

function free({ instance, id }: Handle): void {
  try {
    instance.call((exports) => exports.free_plan(id));
  } catch {
    // The instance ran out of memory and is unusable, and so are its plans.
  }
}

const collected = new FinalizationRegistry(free);

/**
 * The weld, groups and subgroups of one mesh, kept to evaluate tangents again after its vertices moved (morph targets, skinning). Methods
 * other than 'mikktspace' compute everything again and keep only the signs. Memory is freed by {@link Plan.dispose}, or when the plan is garbage-collected.
 */
export class Plan {
  readonly #vertices: number;
  readonly #corners: number;
  #handle: Handle | null;

  /** The tangents of the planned mesh, 4 per corner, as `generateTangents` returns them. */
  readonly base: Float32Array<ArrayBuffer>;

  /** The report of that run. */
  readonly report: types.Report;

  /** Parameters and errors are those of `generateTangents`. */
  constructor(
    positions: Float32Array,
    normals: Float32Array,
    uvs: Float32Array,
    indices?: types.Indices | null,
    options?: types.TangentOptions | null,
  ) {
    const mesh = tangentMesh(positions, normals, uvs, indices, options);
    const codes = tangentOptions(options);
    const instance = newest && !newest.isFull() ? newest : (newest = fullModule.newInstance());
    [this.#vertices, this.#corners] = [mesh.vertices, mesh.corners];
    [this.#handle, this.base, this.report] = instance.call((exports) => {
      writeMesh(exports, mesh);
      const id = exports.make_plan(...codes);
      if (id < 0) throw indexError(mesh);
      return [{ instance, id }, readFloats(exports, exports.plan_base(id), 4 * mesh.corners), readReport(exports)];
    });
    collected.register(this, this.#handle, this);
  }

  /**
   * The tangents of the moved mesh, 4 per corner, in the groups and subgroups of the planned mesh. Signs stay those of the planned mesh.
   *
   * @param positions 3 per vertex of the planned mesh.
   * @param normals 3 per vertex of the planned mesh.
   */
  evaluate(positions: Float32Array, normals: Float32Array): Float32Array<ArrayBuffer> {
    return this.#withMoved(positions, normals, (exports, id) => readFloats(exports, exports.evaluate_plan(id), 4 * this.#corners));
  }

  /** The number of corners whose tangent a fresh run on the moved mesh would compute with other bits than {@link Plan.evaluate}. */
  countRegrouped(positions: Float32Array, normals: Float32Array): number {
    return this.#withMoved(positions, normals, (exports, id) => exports.count_regrouped(id));
  }

  /** Frees the plan's memory now. The plan cannot be evaluated afterwards. */
  dispose(): void {
    if (!this.#handle) return;
    collected.unregister(this);
    free(this.#handle);
    this.#handle = null;
  }

  #withMoved<R>(positions: Float32Array, normals: Float32Array, work: (exports: FullExports, id: number) => R): R {
    const vertices = this.#vertices;
    for (const [name, array] of [['positions', positions], ['normals', normals]] as const) {
      const rows = rowCount(name, array, 3);
      if (rows !== vertices) throw new RangeError(`${name} has ${rows} elements but the plan has ${vertices} vertices`);
    }
    if (!this.#handle) throw new Error('the plan has been disposed of; make another');
    const { instance, id } = this.#handle;
    return instance.call((exports) => {
      writeArrays(exports, [[positions, exports.positions(vertices)], [normals, exports.normals(vertices)]]);
      return work(exports, id);
    });
  }
}
