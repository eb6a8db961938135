// The table of materials that the shaders read: a texture with two texels for each material.

import * as THREE from "three";

const NUMBERS = 8; // of each material
const WIDEST = 1024; // materials; textures have sides of 2048 everywhere

/** Returns the table of eight numbers of each material: floats, or words of 32 bits. */
export function materialTable(numbers: Float32Array | Uint32Array): THREE.DataTexture {
  const count = Math.max(1, numbers.length / NUMBERS);
  const width = Math.min(count, WIDEST);
  const height = Math.ceil(count / width);
  const isFloat = numbers instanceof Float32Array;
  const data = new (isFloat ? Float32Array : Uint32Array)(NUMBERS * width * height);
  data.set(numbers);
  const table = isFloat
    ? new THREE.DataTexture(data, 2 * width, height, THREE.RGBAFormat, THREE.FloatType)
    : new THREE.DataTexture(data, 2 * width, height, THREE.RGBAIntegerFormat, THREE.UnsignedIntType);
  table.needsUpdate = true;
  return table;
}
