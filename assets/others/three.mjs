// Writes one scene with the exporters of three.js 0.180: three.glb, .obj, .ply, .binary.ply, .big-endian.ply, .stl and .binary.stl.
//
//     npm install three@0.180 && node three.mjs
//
// The scene has a torus knot, whose UVs repeat, and a sphere, whose UVs are mirrored in the middle. three.js keeps v as the geometry has it, in glTF (where it
// points down) as in PLY and OBJ (where it points up). So v is turned for PLY and OBJ: 1 - v is exact for the multiples of 1/64 that the geometries are given.

import { writeFileSync } from "node:fs";
import * as THREE from "three";
import { GLTFExporter } from "three/addons/exporters/GLTFExporter.js";
import { OBJExporter } from "three/addons/exporters/OBJExporter.js";
import { PLYExporter } from "three/addons/exporters/PLYExporter.js";
import { STLExporter } from "three/addons/exporters/STLExporter.js";

// What the exporter of glTF takes from a browser.
globalThis.FileReader = class {
  readAsArrayBuffer(blob) {
    blob.arrayBuffer().then((buffer) => {
      this.result = buffer;
      this.onloadend();
    });
  }
};

const exact = (value) => Math.round(value * 64) / 64;

function scene(turnsV) {
  const knot = new THREE.TorusKnotGeometry(1, 0.375, 16, 5);
  const ball = new THREE.SphereGeometry(1, 8, 6);
  const made = new THREE.Scene();
  for (const [name, geometry, mirrored] of [["Knot", knot, false], ["Ball", ball, true]]) {
    const uv = geometry.attributes.uv;
    for (let i = 0; i < uv.count; i++) {
      const u = exact(mirrored ? Math.abs(uv.getX(i) - 0.5) * 2 : uv.getX(i) * 4);
      const v = exact(uv.getY(i));
      uv.setXY(i, u, turnsV ? 1 - v : v);
    }
    const mesh = new THREE.Mesh(geometry, new THREE.MeshStandardMaterial({ color: 0x4080c0, roughness: 0.5 }));
    mesh.name = name;
    made.add(mesh);
  }
  made.updateMatrixWorld(true);
  return made;
}

const glb = await new GLTFExporter().parseAsync(scene(false), { binary: true });
writeFileSync("three.glb", Buffer.from(glb));
const turned = scene(true);
writeFileSync("three.obj", new OBJExporter().parse(turned));
const ply = (options) => new PLYExporter().parse(turned, null, options);
writeFileSync("three.ply", ply({}));
writeFileSync("three.binary.ply", Buffer.from(ply({ binary: true, littleEndian: true })));
writeFileSync("three.big-endian.ply", Buffer.from(ply({ binary: true })));
writeFileSync("three.stl", new STLExporter().parse(turned));
writeFileSync("three.binary.stl", Buffer.from(new STLExporter().parse(turned, { binary: true }).buffer));
