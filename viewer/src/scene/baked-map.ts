// Baked maps as textures, for the materials of the low model.

import { DataTexture, LinearFilter, LinearMipmapLinearFilter, MeshBasicMaterial, type MeshStandardMaterial, NearestFilter, RepeatWrapping, SRGBColorSpace, type Texture } from 'three';

import type { ShownBake } from '../bake/baker';
import { type FurtherKind, isLight } from '../bake/map-texels';
import type { Part } from './model-parts';

/** The maps as textures with one UV set and transform. */
interface MapTextures {
  normals: Texture;
  misses: Texture;
  further: Map<FurtherKind, Texture>;
}

/** How a material shows a further map, where it can. `white`: the value of a white texel. */
const SHOW: Partial<Record<FurtherKind, (material: MeshStandardMaterial, map: Texture, white: number) => void>> = {
  'ao': (material, aoMap) => Object.assign(material, { aoMap, aoMapIntensity: 1 }),
  'roughness': (material, roughnessMap) => Object.assign(material, { roughnessMap, roughness: 1 }),
  'metalness': (material, metalnessMap) => Object.assign(material, { metalnessMap, metalness: 1 }),
  // The baked colour is that of the high model, which colours of the low model's vertices would multiply.
  'base-color': (material, map, white) => Object.assign(material, { map, vertexColors: false }).color.setScalar(white),
  'emission': (material, emissiveMap, white) => Object.assign(material, { emissiveMap, emissiveIntensity: 1 }).emissive.setScalar(white),
};

export class BakedMap {
  /** By the file's own normal map, whose UV set and transform the bake has used; by null where there is none. */
  private readonly textures = new Map<Texture | null, MapTextures>();

  /** `showsMisses`: whether texels that no ray reached are marked. */
  constructor(
    private readonly bake: ShownBake,
    private readonly showsMisses: boolean,
  ) {}

  /** Whether the map was baked for a part. */
  covers({ origin }: Part): boolean {
    return this.bake.material === null || origin?.material === this.bake.material;
  }

  /** Sets the map as the normal map of a part's material. */
  applyTo(material: MeshStandardMaterial, part: Part): void {
    material.normalMap = this.textureOf(part);
    material.normalScale.set(1, 1);
  }

  /** Sets the further maps of the bake that a material has a place for. */
  applyFurtherTo(material: MeshStandardMaterial, part: Part): void {
    const { further } = this.texturesOf(part);
    for (const { kind, ranges } of this.bake.further) SHOW[kind]?.(material, further.get(kind)!, ranges[0][1]);
  }

  /** The normal map as a texture, where a part shows it. */
  textureOf(part: Part): Texture {
    return this.texturesOf(part).normals;
  }

  /** A material that covers the texels of a part that no ray reached; null where they are not shown. */
  missesOf(part: Part): MeshBasicMaterial | null {
    if (!this.showsMisses || !this.bake.report.missedTexels) return null;
    return new MeshBasicMaterial({ map: this.texturesOf(part).misses, transparent: true, alphaTest: 0.5, toneMapped: false, side: part.material.side });
  }

  dispose(): void {
    for (const { normals, misses, further } of this.textures.values()) [normals, misses, ...further.values()].forEach((texture) => texture.dispose());
  }

  private texturesOf({ material }: Part): MapTextures {
    const own = material.normalMap;
    const found = this.textures.get(own);
    if (found) return found;
    const { width, height, normals, misses, further } = this.bake;
    const textureOf = (texels: Uint8ClampedArray<ArrayBuffer>) => transformedLike(new DataTexture(texels, width, height), own);
    const smooth = (texture: Texture) => Object.assign(texture, { magFilter: LinearFilter, minFilter: LinearMipmapLinearFilter, generateMipmaps: true, anisotropy: 8 });
    const made: MapTextures = { normals: smooth(textureOf(normals)), misses: textureOf(misses), further: new Map() };
    Object.assign(made.misses, { magFilter: NearestFilter, minFilter: NearestFilter });
    for (const { kind, texels } of further) {
      if (!SHOW[kind]) continue;
      const texture = smooth(textureOf(texels));
      if (isLight(kind)) texture.colorSpace = SRGBColorSpace;
      made.further.set(kind, texture);
    }
    this.textures.set(own, made);
    return made;
  }
}

/** Gives a texture, whose first row is the top, the UV set and transform of the file's own one. */
function transformedLike(texture: DataTexture, own: Texture | null): DataTexture {
  texture.wrapS = texture.wrapT = RepeatWrapping;
  if (own) {
    texture.channel = own.channel;
    texture.offset.copy(own.offset);
    texture.repeat.copy(own.repeat);
    texture.rotation = own.rotation;
  }
  texture.needsUpdate = true;
  return texture;
}
