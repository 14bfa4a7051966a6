// Which primitives get tangents, and for which UVs.

import type { Accessor, Document, ILogger, Material, Primitive, TextureInfo } from '@gltf-transform/core';

/** A primitive that gets tangents. */
export interface Chosen {
  primitive: Primitive;
  /** Its name in messages. */
  name: string;
  position: Accessor;
  normal: Accessor;
  uv: Accessor;
}

// glTF 2.0, primitive.mode.
export const TRIANGLES = 4;
export const TRIANGLE_STRIP = 5;
export const TRIANGLE_FAN = 6;

/** The primitives that get tangents, each once; the logger hears why others do not. */
export function select(document: Document, overwrite: boolean): Chosen[] {
  const chosen = new Map<Primitive, Chosen>();
  for (const mesh of document.getRoot().listMeshes()) {
    for (const [at, primitive] of mesh.listPrimitives().entries()) {
      const name = `primitive ${at} of mesh "${mesh.getName()}"`;
      const found = choose(primitive, name, overwrite, document.getLogger());
      if (found && !chosen.has(primitive)) chosen.set(primitive, found);
    }
  }
  return [...chosen.values()];
}

function choose(primitive: Primitive, name: string, overwrite: boolean, logger: ILogger): Chosen | null {
  const skip = (reason: string) => {
    logger.debug(`tangents: Skipping ${name}: ${reason}.`);
    return null;
  };
  if (primitive.getMode() < TRIANGLES) return skip('it has no triangles');
  if (primitive.getAttribute('TANGENT') && !overwrite) return skip('TANGENT found');
  const uvs = `TEXCOORD_${uvSet(primitive.getMaterial())}`;
  const [position, normal, uv] = ['POSITION', 'NORMAL', uvs].map((semantic) => primitive.getAttribute(semantic));
  if (!position) return skip('it has no POSITION');
  if (!normal) return skip('it has no NORMAL');
  if (!uv) return skip(`it has no ${uvs}, which its material asks for`);
  return { primitive, name, position, normal, uv };
}

/** What is read of the extensions, which are classes of a package that need not be there. */
interface Extensions {
  KHR_materials_clearcoat: { getClearcoatNormalTextureInfo(): TextureInfo | null };
  KHR_materials_anisotropy: { getAnisotropyTextureInfo(): TextureInfo | null };
  KHR_texture_transform: { getTexCoord(): number | null };
}

function extension<N extends keyof Extensions>(owner: Material | TextureInfo, name: N): Extensions[N] | null {
  return owner.getExtension(name) as unknown as Extensions[N] | null;
}

/** The UV set of the normal texture (glTF 2.0, 3.9.3), else of another texture that is seen in tangent space, else the first. */
function uvSet(material: Material | null): number {
  const info =
    material &&
    (material.getNormalTextureInfo() ??
      extension(material, 'KHR_materials_clearcoat')?.getClearcoatNormalTextureInfo() ??
      extension(material, 'KHR_materials_anisotropy')?.getAnisotropyTextureInfo());
  return info ? (extension(info, 'KHR_texture_transform')?.getTexCoord() ?? info.getTexCoord()) : 0;
}
