// A baked normal map as textures, for the materials of the low model.

import { DataTexture, LinearFilter, LinearMipmapLinearFilter, MeshBasicMaterial, type MeshStandardMaterial, NearestFilter, RepeatWrapping, type Texture } from 'three';

import type { ShownBake } from '../bake/baker';
import type { Part } from './model-parts';

/** The map as textures with one UV set and transform. */
interface MapTextures {
  normals: Texture;
  misses: Texture;
}

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

  /** The map as a texture, where a part shows it. */
  textureOf(part: Part): Texture {
    return this.texturesOf(part).normals;
  }

  /** A material that covers the texels of a part that no ray reached; null where they are not shown. */
  missesOf(part: Part): MeshBasicMaterial | null {
    if (!this.showsMisses || !this.bake.report.missedTexels) return null;
    return new MeshBasicMaterial({ map: this.texturesOf(part).misses, transparent: true, alphaTest: 0.5, toneMapped: false, side: part.material.side });
  }

  dispose(): void {
    for (const { normals, misses } of this.textures.values()) [normals, misses].forEach((texture) => texture.dispose());
  }

  private texturesOf({ material }: Part): MapTextures {
    const own = material.normalMap;
    const found = this.textures.get(own);
    if (found) return found;
    const { width, height, normals, misses } = this.bake;
    const made = { normals: transformedLike(new DataTexture(normals, width, height), own), misses: transformedLike(new DataTexture(misses, width, height), own) };
    Object.assign(made.normals, { magFilter: LinearFilter, minFilter: LinearMipmapLinearFilter, generateMipmaps: true, anisotropy: 8 });
    Object.assign(made.misses, { magFilter: NearestFilter, minFilter: NearestFilter });
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
