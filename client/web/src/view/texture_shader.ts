// Reflectance and opacity by place, for the shaders of a mesh whose images are on the graphics card. The images lie on one sheet, each followed by its
// levels, and have sizes and wraps of their own: so the shader does what samplers do. src/textures/ does the same where a person clicks.

/** Of the vertex shader: passes on where on which image the vertex lies. */
export const TEXTURE_VERTEX = `
#ifdef TEXTURED
uniform highp usampler2D textures;
in vec2 coordinates;
out vec2 onImage;
flat out uvec4 image;
flat out vec3 factor;
void passImage(ivec2 at) {
  onImage = coordinates;
  image = texelFetch(textures, at, 0);
  factor = uintBitsToFloat(texelFetch(textures, at + ivec2(1, 0), 0).rgb);
}
#endif`;

/** Of the fragment shader: finds the reflectance and the opacity. */
export const TEXTURE_FRAGMENT = `
#ifdef TEXTURED
precision highp int;
uniform sampler2D sheet;  // decoded from sRGB by the GPU
in vec2 onImage;
flat in uvec4 image;  // first texel, columns, rows, wraps
flat in vec3 factor;
const uint MIRROR = 2u;
const uint CLAMP = 3u;
const vec3 BRIGHTEST = vec3(0.991102);  // of a byte of 254, for which 255 counts

// Folds a texture coordinate outside [0, 1] back into the image, as its wrap mode says.
float folded(float x, uint wrap) {
  if (wrap == CLAMP) return clamp(x, 0.0, 1.0);
  if (wrap == MIRROR) return 1.0 - abs(mod(x, 2.0) - 1.0);
  return fract(x);
}
// The texel that stands for one that is at most one beyond the end of a row or column.
int kept(int n, int count, uint wrap) {
  return wrap == MIRROR || wrap == CLAMP ? clamp(n, 0, count - 1) : (n + count) % count;
}
// Reflectance times opacity, and opacity: so colours count by how much of them is there.
vec4 texel(uint n) {
  uint width = uint(textureSize(sheet, 0).x);
  vec4 there = texelFetch(sheet, ivec2(n % width, n / width), 0);
  return vec4(there.a * min(there.rgb, BRIGHTEST), there.a);
}
// The opacity of the texel at a point: its outline is sharp.
float nearest(vec2 st) {
  uvec2 at = min(uvec2(st * vec2(image.yz)), image.yz - 1u);
  return texel(image.x + at.y * image.y + at.x).a;
}
vec4 bilinear(int level, vec2 st, uvec2 wraps) {
  uint first = image.x;
  ivec2 size = ivec2(image.yz);
  for (int n = 0; n < level && (size.x > 1 || size.y > 1); ++n) {
    first += uint(size.x * size.y);
    size = (size + 1) / 2;
  }
  vec2 x = st * vec2(size) - 0.5;
  vec2 share = fract(x);
  ivec2 low = ivec2(floor(x));
  ivec2 columns = ivec2(kept(low.x, size.x, wraps.x), kept(low.x + 1, size.x, wraps.x));
  ivec2 rows = ivec2(kept(low.y, size.y, wraps.y), kept(low.y + 1, size.y, wraps.y)) * size.x;
  vec4 upper = mix(texel(first + uint(rows.x + columns.x)), texel(first + uint(rows.x + columns.y)), share.x);
  vec4 lower = mix(texel(first + uint(rows.y + columns.x)), texel(first + uint(rows.y + columns.y)), share.x);
  return mix(upper, lower, share.y);
}
// The reflectance of what is there, and which share that is.
vec4 surfaceThere() {
  vec2 right = dFdx(onImage) * vec2(image.yz);  // before anything branches
  vec2 up = dFdy(onImage) * vec2(image.yz);
  if (image.y == 0u) return vec4(reflectance, 1.0);
  float level = clamp(0.5 * log2(max(1.0, max(dot(right, right), dot(up, up)))), 0.0, 13.0);  // 13: of 8192 texels
  uvec2 wraps = uvec2(image.w & 3u, image.w >> 2);
  vec2 st = vec2(folded(onImage.x, wraps.x), folded(onImage.y, wraps.y));
  vec4 there = bilinear(int(level), st, wraps);
  float opacity = level < 1.0 ? nearest(st) : there.a;
  if (level > 0.0) {
    vec4 farther = bilinear(int(level) + 1, st, wraps);
    there = mix(there, farther, fract(level));
    opacity = mix(opacity, farther.a, fract(level));
  }
  return vec4(there.a > 0.0 ? factor * there.rgb / there.a : vec3(0.0), opacity);
}
#endif`;
