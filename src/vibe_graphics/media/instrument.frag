#version 120
#include "lamp.glsl"
// Metal, polymer and glass under the two light guides beside the lens, in a hollow of lit mucosa.
uniform vec3 colour;      // of the material: diffuse, and what a metal reflects
uniform float shine;      // strength of its highlights; from 0.7 on it is a metal
uniform float sharpness;  // exponent of its highlights
uniform vec4 smoke;       // x: its extinction [1/m]
uniform float reach;      // of the light, as in mucosa.frag [m]

varying vec3 view_position;
varying vec3 view_normal;

const vec3 kWall = vec3(0.30, 0.13, 0.10);  // radiance of the wall around, half lit
const float kNear = 0.04;                   // as in solid.frag [m]

// What a mirror sees in this direction: folds of the wall around, a darker lumen ahead, and behind the endoscope's own
// face, black with its lamps.
vec3 surroundings(vec3 direction) {
  float ahead = -direction.z;
  float near = smoothstep(-0.55, -0.05, ahead) * (1.0 - 0.55 * smoothstep(0.45, 1.0, ahead));
  float folds = 0.75 + 0.25 * sin(7.0 * direction.x + 3.0 * direction.y) * sin(9.0 * direction.y - 4.0 * ahead);
  return kWall * mix(0.05, folds, near);
}

void main() {
  vec3 to_eye = normalize(-view_position), normal = normalize(view_normal);
  float facing = max(dot(normal, to_eye), 0.0);
  float metal = smoothstep(0.6, 0.75, shine);
  vec3 base = linear(colour);
  vec3 mirror = mix(vec3(0.04 + 0.06 * shine), base, metal);
  float edge = (1.0 - facing) * (1.0 - facing);  // Schlick 1994
  mirror += (1.0 - mirror) * edge * edge * (1.0 - facing) * mix(0.5, 1.0, metal) * shine;

  vec3 light = base * mix(0.08, 0.03, metal);  // of the wall, from everywhere
  light += mirror * surroundings(reflect(-to_eye, normal)) * mix(shine, 0.9, metal);
  vec3 lit = lamp(view_position, normal, normal, reach, 0.0, kNear);
  float gloss = mix(lit.z, lit.y, smoothstep(30.0, 150.0, sharpness)) * mix(shine, 1.6, metal);
  light += base * lit.x * mix(0.95, 0.42, metal) + mirror * (gloss + 0.4 * metal * lit.x);
  gl_FragColor = vec4(stored(smoked(light, view_position, reach, smoke.x)), 1.0);
}
