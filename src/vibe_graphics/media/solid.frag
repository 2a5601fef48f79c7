#version 120
#include "lamp.glsl"
// A solid body with vertex colours, lit by a lamp at the camera.
uniform float gloss;  // strength of highlights
uniform float glow;   // 1: emissive only, for symbols
uniform vec4 smoke;   // x: its extinction [1/m]
uniform float reach;  // of the endoscope's light, as in mucosa.frag [m]; 0: a lamp of constant intensity

varying vec3 view_position;
varying vec3 view_normal;
varying vec4 colour;
varying vec3 rest;

// The instrument beside the lens stands in the half-shadow of the tip, which the guides' cones reach only in part; without
// that it would outshine the picture. Design choice [m].
const float kNear = 0.04;

void main() {
  vec3 to_eye = normalize(-view_position), normal = normalize(view_normal);
  float facing = dot(normal, to_eye);
  if (facing < 0.0) normal = -normal, facing = -facing;
  if (reach > 0.0 && glow < 0.5) {
    vec3 light = lamp(view_position, normal, normal, reach, 0.1, kNear);
    float around_light = 0.05 * reach * reach / (dot(view_position, view_position) + 4e-4);
    vec3 radiance = linear(colour.rgb) * (light.x + around_light) + gloss * (0.5 * light.y + 0.5 * light.z);
    gl_FragColor = vec4(stored(smoked(radiance, view_position, reach, smoke.x)), colour.a);
    return;
  }
  vec3 shaded = colour.rgb * mix(0.22 + 0.78 * facing, 1.0, glow);
  gl_FragColor = vec4(shaded + gloss * pow(facing, 40.0), colour.a);
}
