#version 120
#include "lamp.glsl"
// Blood in the light of the endoscope. Colour of the vertices: of a layer of this depth; their alpha: what it hides
// (geometry/blood_colour.hpp). Its surface is a mirror: two tight highlights of the light guides, and towards
// grazing angles the lit wall around (Schlick 1994).
uniform float reach;  // as in mucosa.frag [m]
uniform vec4 smoke;   // x: its extinction [1/m]

varying vec3 view_position;
varying vec3 view_normal;
varying vec4 colour;

const vec3 kWall = vec3(0.42, 0.20, 0.16);  // radiance of the lit wall around
const float kNear = 0.002;                  // [m]

void main() {
  vec3 to_eye = normalize(-view_position), normal = normalize(view_normal);
  if (dot(normal, to_eye) < 0.0) normal = -normal;
  vec3 light = lamp(view_position, normal, normal, reach, 0.35, kNear);
  float around_light = 0.10 * reach * reach / (dot(view_position, view_position) + 4e-4);

  float edge = 1.0 - dot(normal, to_eye);
  float fresnel = 0.02 + 0.98 * edge * edge * edge * edge * edge;
  vec3 radiance = linear(colour.rgb) * (light.x + around_light);
  vec3 mirrored = fresnel * kWall * around_light * 8.0 + 2.5 * light.y + 0.05 * light.z;
  // what is mirrored covers what is behind, however thin the blood
  float shine = clamp(max(mirrored.r, max(mirrored.g, mirrored.b)), 0.0, 1.0);
  float alpha = colour.a + (1.0 - colour.a) * shine * smoothstep(0.1, 0.4, colour.a);
  gl_FragColor = vec4(stored(smoked(radiance + mirrored, view_position, reach, smoke.x)), alpha);
}
