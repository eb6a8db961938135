// Lets GLTFLoader of three.js read the lightmaps that alvor bake writes: loader.register(lightmaps).
import { SRGBColorSpace } from "three";

export const lightmaps = (parser) => ({
  name: "MOZ_lightmap",
  extendMaterialParams(index, params) {
    const light = parser.json.materials[index].extensions?.MOZ_lightmap;
    if (!light) return Promise.resolve();
    params.lightMapIntensity = light.intensity; // the irradiance of a white texel
    return parser.assignTexture(params, "lightMap", light, SRGBColorSpace);
  },
});
