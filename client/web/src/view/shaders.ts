// Radiosity B = E + rho (H + ambient) is put together for each pixel, from H interpolated between vertices. rho is the material's, with
// TEXTURED that of the texels there (see texture_shader.ts); with COLOURED it is multiplied by the colour interpolated between vertices. With
// TRANSLUCENT, tau (H + ambient) of the other side is added, of which tau H is interpolated between vertices. With TOLD, leaves have told
// errors.

import { TEXTURE_FRAGMENT, TEXTURE_VERTEX } from "./texture_shader";

/** Parts of the shaders that are left out unless they are defined. */
export type ShaderPart = "TEXTURED" | "COLOURED" | "TRANSLUCENT" | "TOLD";

export const VERTEX = `
precision highp float;
precision highp sampler2D;
uniform mat4 modelViewMatrix;
uniform mat4 projectionMatrix;
uniform sampler2D materials;
uniform int materialsWide;
in vec3 position;
in vec4 value;
out vec3 irradiance;
out float centre;
flat out vec3 emission;
flat out vec3 reflectance;
flat out float through;
#ifdef COLOURED
in vec3 vertexColour;
out vec3 colourThere;
#endif
#ifdef TRANSLUCENT
uniform sampler2D transmittances;
in vec3 transmitted;
out vec3 transmittedThere;
flat out vec3 transmittance;
#endif
#ifdef TOLD
in float error;
out float errorThere;
#endif
${TEXTURE_VERTEX}
void main() {
  int material = int(value.w + 0.5);
  ivec2 at = ivec2(2 * (material % materialsWide), material / materialsWide);
  vec4 first = texelFetch(materials, at, 0);
  emission = first.rgb;
  through = first.a;
  reflectance = texelFetch(materials, at + ivec2(1, 0), 0).rgb;
#ifdef TEXTURED
  passImage(at);
#endif
#ifdef COLOURED
  colourThere = vertexColour;
#endif
#ifdef TRANSLUCENT
  transmittedThere = transmitted;
  transmittance = texelFetch(transmittances, at, 0).rgb;
#endif
#ifdef TOLD
  errorThere = error;
#endif
  irradiance = value.rgb;
  centre = gl_VertexID % 9 == 0 ? 1.0 : 0.0;
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
}`;

export const FRAGMENT = `
precision highp float;
precision highp sampler2D;
uniform sampler2D colours;
uniform vec3 ambient;
uniform bool falseColour;
uniform bool isOfErrors;
uniform int tone;
uniform float exposure;
uniform vec2 scale;
uniform bool logarithmic;
uniform bool outlines;
in vec3 irradiance;
in float centre;
flat in vec3 emission;
flat in vec3 reflectance;
flat in float through;
#ifdef COLOURED
in vec3 colourThere;
#endif
#ifdef TRANSLUCENT
in vec3 transmittedThere;
flat in vec3 transmittance;
#endif
#ifdef TOLD
in float errorThere;
#else
const float errorThere = 0.0;
#endif
out vec4 pixel;
${TEXTURE_FRAGMENT}

// Bayer's matrix of 4 x 4: of each such square of pixels, a pane or a cut-out leaves the share that light passes.
const float thresholds[16] = float[](0.0, 8.0, 2.0, 10.0, 12.0, 4.0, 14.0, 6.0, 3.0, 11.0, 1.0, 9.0, 15.0, 7.0, 13.0, 5.0);
bool passes(float share) {
  ivec2 at = ivec2(gl_FragCoord.xy) % 4;
  return share > (thresholds[4 * at.y + at.x] + 0.5) / 16.0;
}

vec3 toned(vec3 x) {
  x = min(x, vec3(1000.0));
  if (tone == 0) return min(vec3(1.0), x * (2.51 * x + 0.03) / (x * (2.43 * x + 0.59) + 0.14));  // Narkowicz 2015
  if (tone == 1) return x / (1.0 + dot(x, vec3(0.2126, 0.7152, 0.0722)));  // Reinhard et al. 2002, by luminance
  return x;
}
vec3 srgb(vec3 x) {
  x = clamp(x, 0.0, 1.0);
  return mix(1.055 * pow(x, vec3(1.0 / 2.4)) - 0.055, 12.92 * x, lessThanEqual(x, vec3(0.0031308)));
}
float place(float h) {
  if (logarithmic) return log(max(h, 1e-30) / scale.x) / log(scale.y / scale.x);
  return (h - scale.x) / max(scale.y - scale.x, 1e-30);
}
void main() {
#ifdef TEXTURED
  vec4 there = surfaceThere();
  float passing = through + (1.0 - there.a) * (1.0 - through);  // also where the image has holes
  vec3 rho = there.rgb;
#else
  float passing = through;
  vec3 rho = reflectance;
#endif
#ifdef COLOURED
  rho *= colourThere;
#endif
  if (passes(passing)) discard;  // so that through < 1 from here on
  vec3 h = irradiance + ambient;
  vec3 radiosity = emission + rho * h;
#ifdef TRANSLUCENT
  radiosity += transmittedThere + transmittance * ambient;
#endif
  vec3 colour;
  float shown = isOfErrors ? errorThere : dot(h, vec3(0.2126, 0.7152, 0.0722));
  if (falseColour) colour = texture(colours, vec2(clamp(place(shown), 0.0, 1.0), 0.5)).rgb;
  else colour = srgb(toned(exposure * radiosity / (1.0 - through)));  // what is left of a pane has all its light
  if (outlines) {
    float line = 1.0 - smoothstep(0.0, 1.2, centre / fwidth(centre));
    float bright = dot(colour, vec3(0.299, 0.587, 0.114));
    colour = mix(colour, vec3(bright > 0.5 ? 0.0 : 1.0), 0.45 * line);
  }
  pixel = vec4(colour, 1.0);
}`;
