// What is read of glTF 2.0's JSON.

import type { Transform } from "./placement";

export interface Gltf {
  asset?: { version?: string };
  scene?: number;
  scenes?: { nodes?: number[] }[];
  nodes?: GltfNode[];
  meshes?: { primitives?: GltfPrimitive[] }[];
  accessors?: GltfAccessor[];
  bufferViews?: { buffer?: number; byteOffset?: number; byteLength?: number; byteStride?: number }[];
  buffers?: { uri?: string; byteLength?: number }[];
  materials?: GltfMaterial[];
  textures?: { source?: number }[];
  images?: GltfImage[];
  extensionsRequired?: string[];
  extensions?: { KHR_lights_punctual?: { lights?: { type?: string }[] } };
}

export interface GltfNode extends Transform {
  mesh?: number;
  children?: number[];
  extensions?: { KHR_lights_punctual?: { light?: number } };
}

export interface GltfPrimitive {
  mode?: number;
  attributes?: Record<string, number>;
  indices?: number;
  material?: number;
}

export interface GltfAccessor {
  bufferView?: number;
  byteOffset?: number;
  componentType?: number;
  normalized?: boolean;
  count?: number;
  type?: string;
  sparse?: unknown;
}

export interface GltfImage {
  name?: string;
  uri?: string;
  bufferView?: number;
}

export interface GltfTexture {
  index?: number;
}

export interface GltfMaterial {
  name?: string;
  pbrMetallicRoughness?: {
    baseColorFactor?: number[];
    baseColorTexture?: GltfTexture;
    metallicFactor?: number;
    metallicRoughnessTexture?: GltfTexture;
  };
  emissiveFactor?: number[];
  emissiveTexture?: GltfTexture;
  alphaMode?: string;
  doubleSided?: boolean;
  extensions?: Record<string, { emissiveStrength?: number }>;
}
