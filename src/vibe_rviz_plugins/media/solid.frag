#version 120
// A solid body with vertex colours, lit by a lamp at the camera.
uniform float gloss;  // strength of highlights
uniform float glow;   // 1: emissive only, for symbols
uniform float reach;  // of the lamp: distance of half intensity [m]; 0: constant intensity

varying vec3 view_position;
varying vec3 view_normal;
varying vec4 colour;
varying vec3 rest;

void main() {
  vec3 to_eye = normalize(-view_position), normal = normalize(view_normal);
  float facing = abs(dot(normal, to_eye));
  float distance = length(view_position);
  float lamp = reach > 0.0 ? 2.0 / (1.0 + distance * distance / (reach * reach)) : 1.0;
  vec3 shaded = colour.rgb * mix(0.22 + 0.78 * lamp * facing, 1.0, glow);
  vec3 light = shaded + gloss * lamp * pow(facing, 40.0);
  float brightest = max(max(light.r, light.g), max(light.b, 0.001));
  if (reach > 0.0) light *= (1.0 - exp(-1.5 * brightest)) / brightest;  // the same as in tissue.frag
  gl_FragColor = vec4(light, colour.a);
}
