// Selects the primitives that get tangents, and the UV set of each.

import type { Accessor, Document, ILogger, Material, Primitive, TextureInfo } from '@gltf-transform/core';

/** A primitive that gets tangents. */
export interface SelectedPrimitive {
  primitive: Primitive;
  /** The name in messages. */
  name: string;
  position: Accessor;
  normal: Accessor;
  uv: Accessor;
}

// glTF 2.0, primitive.mode.
export const TRIANGLES = 4;
export const TRIANGLE_STRIP = 5;
export const TRIANGLE_FAN = 6;

/** The primitives that get tangents, each once. The reason why another does not is logged. */
export function selectPrimitives(document: Document, overwrite: boolean): SelectedPrimitive[] {
  const selected = new Map<Primitive, SelectedPrimitive>();
  for (const mesh of document.getRoot().listMeshes()) {
    for (const [at, primitive] of mesh.listPrimitives().entries()) {
      const name = `primitive ${at} of mesh "${mesh.getName()}"`;
      const found = eligible(primitive, name, overwrite, document.getLogger());
      if (found && !selected.has(primitive)) selected.set(primitive, found);
    }
  }
  return [...selected.values()];
}

/** A primitive with its attributes, or null where one is missing or tangents exist. */
function eligible(primitive: Primitive, name: string, overwrite: boolean, logger: ILogger): SelectedPrimitive | null {
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

/** The methods of extensions that are called here. Their classes are in a package that may not be installed. */
interface Extensions {
  KHR_materials_clearcoat: { getClearcoatNormalTextureInfo(): TextureInfo | null };
  KHR_materials_anisotropy: { getAnisotropyTextureInfo(): TextureInfo | null };
  KHR_texture_transform: { getTexCoord(): number | null };
}

function extension<N extends keyof Extensions>(owner: Material | TextureInfo, name: N): Extensions[N] | null {
  return owner.getExtension(name) as unknown as Extensions[N] | null;
}

/** The UV set of the normal texture (glTF 2.0, 3.9.3), else of the clearcoat normal or anisotropy texture, else 0. */
function uvSet(material: Material | null): number {
  const info =
    material &&
    (material.getNormalTextureInfo() ??
      extension(material, 'KHR_materials_clearcoat')?.getClearcoatNormalTextureInfo() ??
      extension(material, 'KHR_materials_anisotropy')?.getAnisotropyTextureInfo());
  return info ? (extension(info, 'KHR_texture_transform')?.getTexCoord() ?? info.getTexCoord()) : 0;
}
