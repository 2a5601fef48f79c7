#version 120
#include "lamp.glsl"
#include "shadow.glsl"
// As surface.vert, and what the mucosa looks like at the vertex (geometry/mucosa_map.hpp).
uniform mat4 worldViewProj;
uniform mat4 worldView;
uniform vec4 smoke;  // y: time [s] (graphics/tissue_visual.hpp)
uniform vec3 eye;    // the lens in the frame of the organ [m]
uniform vec3 pattern_shift;  // of the patterns (geometry/mucosa_pattern.hpp) [m]

varying vec3 view_position;
varying vec3 view_normal;
varying vec4 colour;
varying vec3 rest;
varying vec4 around;  // direction around the organ; by how much the phase of the folds wanders [rad]; blotches
varying vec4 anatomy;  // share of folds, of antrum; distance beyond Z line and pylorus [m]
varying float fold;    // height of the rugae here [m]
varying vec2 reaching; // part of each light guide that the device does not hide
varying float browned;  // grade of heat times how brown its scar is (geometry/argon_traces.hpp)
varying float wisp;    // density of smoke on the way to the lens, of its mean

// Smoke is not quite even: wisps of some 40 mm drift past, seen where the ray has gone a third of its way.
float wispAt(vec3 place) {
  vec3 p = 150.0 * mix(eye, place, 0.35) + smoke.y * vec3(0.5, 0.7, 0.6);
  p += 1.5 * sin(p.yzx) + 0.7 * sin(2.3 * p.zxy);
  return 1.0 + 0.35 * sin(p.x) * sin(p.y) + 0.15 * sin(1.7 * p.z);
}

// As placeOnLens() of geometry/endoscope_optics.hpp, in the view.
const float kBeforeLens = 0.0001, kBesideLens = 0.0038, kBehindLens = 0.005;  // [m]
bool isOnLens(vec3 place) {
  return place.z > -kBeforeLens && place.z < kBehindLens && length(place.xy) < kBesideLens;
}

void main() {
  gl_Position = worldViewProj * gl_Vertex;
  // not cut by the near plane, which hides the glass of the lens: a wall that is touched lies on the glass
  gl_Position.z = max(gl_Position.z, 0.0);
  view_position = (worldView * gl_Vertex).xyz;
  if (isOnLens(view_position)) view_position.z = -kBeforeLens, gl_Position.w = kBeforeLens;
  view_normal = (worldView * vec4(gl_Normal, 0.0)).xyz;
  colour = gl_Color;
  rest = gl_MultiTexCoord0.xyz + pattern_shift;
  around = gl_MultiTexCoord1;
  anatomy = gl_MultiTexCoord2;
  fold = gl_MultiTexCoord3.x;
  reaching = lightReaching(view_position);
  browned = gl_MultiTexCoord4.x;
  wisp = wispAt(gl_Vertex.xyz);
}
