#version 120
// Metal, polymer and glass under the two light guides beside the lens, in a hollow of lit mucosa.
uniform vec3 colour;      // of the material: diffuse, and what a metal reflects
uniform float shine;      // strength of its highlights; from 0.7 on it is a metal
uniform float sharpness;  // exponent of its highlights
uniform float reach;      // of the lamps: distance of half intensity [m]

varying vec3 view_position;
varying vec3 view_normal;

const float kAside = 0.00355;  // of the light guides from the lens [m], as in vibe_description
const vec3 kWall = vec3(0.66, 0.43, 0.39);

// What a mirror sees in this direction: folds of the wall around, a darker lumen ahead, and behind the endoscope's own
// face, black with its lamps.
vec3 surroundings(vec3 direction) {
  float ahead = -direction.z;
  float near = smoothstep(-0.55, -0.05, ahead) * (1.0 - 0.55 * smoothstep(0.45, 1.0, ahead));
  float folds = 0.75 + 0.25 * sin(7.0 * direction.x + 3.0 * direction.y) * sin(9.0 * direction.y - 4.0 * ahead);
  return kWall * mix(0.05, folds, near);
}

void main() {
  float distance = length(view_position);
  vec3 to_eye = -view_position / distance, normal = normalize(view_normal);
  float facing = max(dot(normal, to_eye), 0.0);
  float metal = smoothstep(0.6, 0.75, shine);
  vec3 mirror = mix(vec3(0.04 + 0.06 * shine), colour, metal);
  float edge = (1.0 - facing) * (1.0 - facing);  // Schlick 1994
  mirror += (1.0 - mirror) * edge * edge * (1.0 - facing) * mix(0.5, 1.0, metal) * shine;

  vec3 light = colour * mix(0.20, 0.06, metal);  // of the wall, from everywhere
  light += mirror * surroundings(reflect(-to_eye, normal)) * mix(shine, 0.9, metal);
  for (int side = 0; side < 2; ++side) {
    vec3 to_lamp = vec3(side == 0 ? kAside : -kAside, 0.0, 0.0) - view_position;
    float away = dot(to_lamp, to_lamp);
    to_lamp *= inversesqrt(away);
    float lamp = 1.0 / (1.0 + away / (reach * reach));
    float diffuse = max(dot(normal, to_lamp), 0.0);
    float half_way = max(dot(normal, normalize(to_lamp + to_eye)), 0.0);
    float gloss = pow(half_way, sharpness) * mix(shine, 1.6, metal) + pow(half_way, 0.12 * sharpness) * 0.8 * metal;
    light += lamp * (colour * diffuse * mix(0.95, 0.42, metal) + mirror * gloss);
  }
  float brightest = max(max(light.r, light.g), max(light.b, 0.001));
  light *= (1.0 - exp(-1.5 * brightest)) / brightest;  // the same as in tissue.frag
  gl_FragColor = vec4(light, 1.0);
}
