#version 120
// Metal, polymer and glass under the two light guides beside the lens, in a hollow of lit mucosa.
uniform vec3 colour;      // of the material: diffuse, and what a metal reflects
uniform float shine;      // strength of its highlights; from 0.7 on it is a metal
uniform float sharpness;  // exponent of its highlights
uniform float reach;      // of the lamps: distance of half intensity [m]

varying vec3 view_position;
varying vec3 view_normal;

const float kAside = 0.00355;  // of the light guides from the lens [m], as in vibe_description
const vec3 kWall = vec3(0.78, 0.36, 0.30);

// What a mirror sees in this direction: the wall around, darker ahead in the lumen, dark behind on the endoscope itself.
vec3 surroundings(vec3 direction) {
  float ahead = -direction.z;
  float around = 1.0 - smoothstep(0.35, 1.0, abs(ahead + 0.15));
  return kWall * mix(ahead > 0.0 ? 0.20 : 0.07, 0.85, around);
}

void main() {
  float distance = length(view_position);
  vec3 to_eye = -view_position / distance, normal = normalize(view_normal);
  if (dot(normal, to_eye) < 0.0) normal = -normal;
  float facing = dot(normal, to_eye);
  float metal = smoothstep(0.6, 0.75, shine);
  vec3 mirror = mix(vec3(0.04 + 0.06 * shine), colour, metal);
  mirror += (1.0 - mirror) * pow(1.0 - facing, 5.0) * mix(0.5, 1.0, metal) * shine;

  vec3 light = colour * mix(0.16, 0.05, metal);  // of the wall, from everywhere
  light += mirror * surroundings(reflect(-to_eye, normal)) * mix(shine, 1.0, metal);
  for (int side = 0; side < 2; ++side) {
    vec3 to_lamp = vec3(side == 0 ? kAside : -kAside, 0.0, 0.0) - view_position;
    float away = dot(to_lamp, to_lamp);
    to_lamp *= inversesqrt(away);
    float lamp = 1.0 / (1.0 + away / (reach * reach));
    float diffuse = max(dot(normal, to_lamp), 0.0);
    float gloss = pow(max(dot(normal, normalize(to_lamp + to_eye)), 0.0), sharpness);
    light += lamp * (colour * diffuse * mix(0.85, 0.30, metal) + mirror * gloss * mix(1.2 * shine, 1.4, metal));
  }
  float brightest = max(max(light.r, light.g), max(light.b, 0.001));
  light *= (1.0 - exp(-1.5 * brightest)) / brightest;  // the same as in tissue.frag
  gl_FragColor = vec4(light, 1.0);
}
