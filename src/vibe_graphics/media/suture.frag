#version 120
#include "lamp.glsl"
// Thread, T-tag and cinch in the light of the endoscope, with vertex colours. Alpha 0.5: metal; 1: polymer.
uniform float reach;  // as in mucosa.frag [m]
uniform vec4 smoke;   // x: its extinction [1/m]

varying vec3 view_position;
varying vec3 view_normal;
varying vec4 colour;

const vec3 kWall = vec3(0.42, 0.20, 0.16);  // radiance of the lit wall around, which is mirrored
const float kNear = 0.002;                  // [m]

void main() {
  vec3 to_eye = normalize(-view_position), normal = normalize(view_normal);
  if (dot(normal, to_eye) < 0.0) normal = -normal;
  float facing = dot(normal, to_eye), metal = step(colour.a, 0.75);
  vec3 base = linear(colour.rgb);
  vec3 light = lamp(view_position, normal, normal, reach, 0.1, kNear);
  float around_light = 0.10 * reach * reach / (dot(view_position, view_position) + 4e-4);

  // a mirror shows the wall to the sides, and the dark end of the endoscope where it faces the lens
  vec3 mirrored = kWall * smoothstep(1.0, 0.55, facing) * around_light * 6.0;
  // on what is as thin as a pixel a tight highlight would glitter
  float tight = 1.0 - smoothstep(0.3, 0.9, length(fwidth(view_normal)));
  vec3 polymer = base * (light.x + around_light) + mix(0.10, 0.25, tight) * light.z + 2.0 * tight * light.y;
  vec3 steel = base * (0.55 * light.x + mirrored + 0.9 * light.z + 2.5 * tight * light.y);
  gl_FragColor = vec4(stored(smoked(mix(polymer, steel, metal), view_position, reach, smoke.x)), 1.0);
}
