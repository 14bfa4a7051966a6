// As types.test.mts, from CommonJS.

import { tangents as transform } from 'darboux/gltf-transform';
import { generateTangents as unindexed } from 'darboux/mikktspace';
import { generateTangents, ready, type MikkTSpaceOptions } from 'darboux/tangents';

const loaded: Promise<void> = ready;
const floats = new Float32Array();
const options: MikkTSpaceOptions = { mode: 'corrected', threshold: 60, faces: Uint32Array.of(3, 4) };
const tangents: Float32Array<ArrayBuffer> = generateTangents(floats, floats, floats, new Uint16Array(), options);
generateTangents(floats, floats, floats, null, { faces: 4 });

const callback: (positions: Float32Array, normals: Float32Array, uvs: Float32Array) => Float32Array = unindexed;
transform({ generateTangents: callback });

export { loaded, tangents };
