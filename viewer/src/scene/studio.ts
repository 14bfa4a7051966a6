// The environment: a studio, or another room, of soft lamps, already filtered for every roughness.
//
// three.js would filter a scene on the GPU, which takes seconds without a graphics card. A lamp is a spherical Gaussian a exp(s (cos - 1)), and so,
// nearly, is the lobe of a rough surface that is seen from straight above, so that their convolution is a Gaussian, too, of the sharpness
// s t / (s + t) and the same integral (after Wang et al., "All-frequency rendering of dynamic, spatially-varying reflectance", 2009, who give
// t = 1 / (2 roughness^4) for a microfacet lobe).

import { CubeTexture, DataTexture, DataUtils, HalfFloatType, LinearFilter, LinearMipmapLinearFilter, RGBAFormat, Vector3 } from 'three';

import description from '../../../crates/darboux-render/src/studio.json';

/** The side of the sharpest level in texels. Each level has half the side of the one before. */
const SIDE = 64;

/** The levels from a mirror to roughness 1, by the mapping of three.js: the last has 4 texels per side. */
const LEVELS = 5;

/** The sharpness that the lobe of roughness 1 has more than the microfacet lobe: it is the cosine of a diffuse surface. */
const COSINE_SHARPNESS = 1.6;

interface Lamp {
  /** The unit direction to the lamp. y points up. */
  towards: Vector3;
  radiance: number;
  sharpness: number;
}

/** The lamps of an environment and the radiance from everywhere. `darboux render` has the first one, too. */
interface Environment {
  name: string;
  lamps: Lamp[];
  room: number;
}

export const ENVIRONMENTS: Environment[] = description.environments.map((environment) => ({
  ...environment,
  lamps: environment.lamps.map((lamp) => ({ ...lamp, towards: new Vector3(...lamp.towards).normalize() })),
}));

/** Makes an environment in the form that three.js calls PMREM. */
export function studio(name: string): CubeTexture {
  const environment = ENVIRONMENTS.find((other) => other.name === name) ?? ENVIRONMENTS[0];
  const faces = Array.from({ length: LEVELS + 1 }, (_, level) => level).map((level) => {
    const of = Math.min(level, LEVELS - 1) / (LEVELS - 1);
    return filtered(environment, SIDE >> level, 1 - Math.sqrt(1 - of));
  });
  const cubes = faces.map((images) => new CubeTexture(images));
  const out = cubes[0];
  // three.js takes the number of these for that of all levels, so there is one more, whose texels it does not read.
  out.mipmaps = cubes.slice(1) as unknown as typeof out.mipmaps;
  Object.assign(out, { format: RGBAFormat, type: HalfFloatType, magFilter: LinearFilter, minFilter: LinearMipmapLinearFilter, generateMipmaps: false });
  out.isPMREMTexture = true;
  out.needsUpdate = true;
  return out;
}

/** The six faces of a level. */
function filtered({ lamps: all, room }: Environment, side: number, roughness: number): DataTexture[] {
  const sharpness = Math.min(1e4, 0.5 / roughness ** 4) + COSINE_SHARPNESS;
  const lamps = all.map((own) => {
    const joint = (own.sharpness * sharpness) / (own.sharpness + sharpness);
    return { ...own, sharpness: joint, radiance: (own.radiance * integral(own.sharpness)) / integral(joint) };
  });
  const direction = new Vector3();
  return Array.from({ length: 6 }, (_, face) => {
    const data = new Uint16Array(side * side * 4);
    for (let texel = 0; texel < side * side; texel++) {
      const [u, v] = [texel % side, Math.floor(texel / side)].map((at) => (2 * at + 1) / side - 1);
      towards(face, u, v, direction);
      const radiance = lamps.reduce((sum, own) => sum + own.radiance * Math.exp(own.sharpness * (own.towards.dot(direction) - 1)), room);
      data.fill(DataUtils.toHalfFloat(radiance), texel * 4, texel * 4 + 4);
    }
    return new DataTexture(data, side, side, RGBAFormat, HalfFloatType);
  });
}

/** The integral of a spherical Gaussian over the sphere, for a radiance of 1. */
function integral(sharpness: number): number {
  return ((2 * Math.PI) / sharpness) * (1 - Math.exp(-2 * sharpness));
}

/** The direction of a place on a face of a cube map (OpenGL specification, "cube map texture selection"), with the x that three.js negates. */
function towards(face: number, u: number, v: number, out: Vector3): Vector3 {
  const [x, y, z] = [[1, -v, -u], [-1, -v, u], [u, 1, v], [u, -1, -v], [u, -v, 1], [-u, -v, -1]][face];
  return out.set(-x, y, z).normalize();
}
