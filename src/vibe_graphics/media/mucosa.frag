#version 120
#include "lamp.glsl"
// The inside of the stomach in the light of the endoscope. Everything is a function of the place at rest, so patterns
// move with the tissue; only the height of the rugae depends on its stretch. docs/endoscope_look.md says what is what.
// Colour: red, green, blue of the vertex times `tint`; its alpha is the effect of heat: 1 none, 2/3 mark, 1/3 burn
// scar, 0 deep burn.
uniform vec4 tint;
uniform float wet;     // strength of highlights, 0: dull
uniform float relief;  // height of the fine relief [m]
uniform float grain;   // 1: natural colours, 0: the vertices' colours tell data
uniform float fill;    // ambient light; more for data colours
uniform float scars;   // 1: show heat
uniform float reach;   // distance at which the light of the guides is 1 [m]
uniform vec2 window;   // size of the picture [px]
uniform float unseen;  // share of half the picture within which nothing of it is shown (graphics/endoscope_lens.cpp)
uniform sampler3D pattern;
// What differs from stomach to stomach (geometry/mucosa_pattern.hpp)
#ifdef USUAL
const float areae_count = 50.0, more_mucus = 0.0;
const vec3 hue = vec3(1.0);
const vec2 vessels = vec2(0.10, 0.22);
#else
uniform float areae_count;  // of the pattern of areae gastricae, 8 areae wide, in a metre [1/m]
uniform vec3 hue;           // of the gastric mucosa, 1: as usual
uniform vec2 vessels;       // strength of their net, and how much more on a stretched wall
uniform float more_mucus;
#endif

varying vec3 view_position;
varying vec3 view_normal;
varying vec4 colour;
varying vec3 rest;
varying vec4 around;
varying vec4 anatomy;
varying float fold;
varying vec2 reaching;
varying float browned;
#ifdef SMOKE
uniform vec4 smoke;  // x: extinction [1/m] (graphics/tissue_visual.hpp)
varying float wisp;
#endif

const float kVessels = 1.0 / 0.06;  // a net of 15 mm
// Up to here the wall is drawn as nearer than its middle, which is simulated, by half of its thickness [m]
const vec2 kClose = vec2(0.004, 0.010);
const float kHalfWall = 0.0012;      // [m]
const float kNear = 0.002;           // as lamp() has it [m]
const float kCapillaries = 800.0;    // of the pattern, 8 meshes wide: a net of 0.15 mm [1/m]
const mat3 kTurn = mat3(0.36, 0.48, -0.8, -0.8, 0.6, 0.0, 0.48, 0.64, 0.6);  // so that periods do not coincide

// One fold per turn of the phase: round on top, narrow at the bottom; 0 to 1.
float arch(float phase) {
  float t = 2.0 * fract(phase / 6.2831853) - 1.0;
  return 1.0 - t * t;
}

// Normal of a surface that is raised by height [m] (Mikkelsen 2010, Bump mapping unparametrized surfaces on the GPU).
vec3 raised(vec3 normal, float height) {
  vec3 px = dFdx(view_position), py = dFdy(view_position);
  vec3 r1 = cross(py, normal), r2 = cross(normal, px);
  float determinant = dot(px, r1);
  vec3 gradient = sign(determinant) * (dFdx(height) * r1 + dFdy(height) * r2);
  return normalize(abs(determinant) * normal - gradient);
}

// age: of the mark, 0: white, 1/2: tan, 1: brown; its red rim fades with it
vec3 heated(vec3 base, float heat, float age) {
  vec3 rim = vec3(0.30, 0.022, 0.016), mark = vec3(0.98, 0.86, 0.74), burn = vec3(0.18, 0.06, 0.016), deep = vec3(0.005, 0.003, 0.002);
  vec3 tan_mark = vec3(0.57, 0.28, 0.14), brown_mark = vec3(0.17, 0.062, 0.014);
  mark = mix(mix(mark, tan_mark, min(2.0 * age, 1.0)), brown_mark, max(2.0 * age - 1.0, 0.0));
  base = mix(base, rim, (0.75 - 0.5 * age) * smoothstep(0.05, 0.3, heat));  // reddened around
  base = mix(base, mark, smoothstep(0.4, 0.75, heat));
  base = mix(base, burn, smoothstep(1.2, 1.85, heat));
  return mix(base, deep, smoothstep(2.2, 2.9, heat));
}

void main() {
  vec2 aside = 2.0 * gl_FragCoord.xy / window - 1.0;
  // outside of the circle that the lens shows, or where it shows its other picture
  if (dot(aside, aside) > 1.02 || dot(aside, aside) < unseen * unseen) discard;

  float heat = scars * 3.0 * (1.0 - colour.a);
  vec4 areae = texture3D(pattern, areae_count * rest);
  float broad = around.w;
  vec4 net = texture3D(pattern, kVessels * (kTurn * rest).zxy);
  float pixel = length(fwidth(rest));

  // rugae: parallel folds that meander; two counts of them side by side, so that folds end and fork at the borders
  float angle = atan(around.y, around.x);
  float bend = around.z;
  float border = smoothstep(-0.45, 0.45, sin(5.0 * angle + 0.8 * bend + dot(rest, vec3(60.0, 45.0, 80.0))));
  float straight = mix(arch(30.0 * angle + bend), arch(25.0 * angle + bend + 1.5), border);
  float tortuous = arch(3.4 * bend);  // where "around" is not defined
  float ruga = mix(tortuous, straight, smoothstep(0.3, 0.9, length(around.xy)));
  ruga = mix(ruga, 0.6, smoothstep(0.0025, 0.006, pixel));
  float height = fold * ruga * (0.7 + 0.6 * net.g);

  // pylorus: a ring with creases that run into it
  float ring = 1.0 / (1.0 + 2e4 * anatomy.w * anatomy.w);
  ring *= ring;
  height += 0.0012 * ring * arch(9.0 * angle + 2.0 * (net.g - 0.5));
  // Z line: irregular border of the oesophagus
  float gastric = smoothstep(-0.0005, 0.0005, anatomy.z + 0.012 * (net.g - 0.5) + 0.003 * (areae.g - 0.5));

  float smooth_part = max(1.0 - gastric, 0.45 * anatomy.y);
  float pits = mix(0.8, areae.r, (1.0 - smooth_part) * smoothstep(0.25, 0.7, net.g + 0.3 * (broad - 0.5)));
  // what is finer than two pixels would glitter
  float fine = 1.0 - smoothstep(0.0001, 0.00035, pixel), middling = 1.0 - smoothstep(0.0001, 0.0007, pixel);
  float rough = relief * (middling * (0.36 * pits + 0.5 * areae.g) + 0.35 * fine * areae.a * gastric);
  float mucus = smoothstep(0.58, 0.72, broad + 0.25 * (net.g - 0.5) + more_mucus) * gastric;

  vec3 flat_normal = -normalize(view_normal);
  vec3 normal = raised(flat_normal, height + rough);
  // the film of mucus is smoother than what is below it
  float followed = mix(0.75, 0.28, smoothstep(0.00005, 0.0003, pixel)) * (1.0 - 0.7 * mucus);
  vec3 film = raised(flat_normal, height + followed * rough);

  vec3 base = linear(colour.rgb * tint.rgb);
  if (grain > 0.5) {
    float blotch = 0.6 * broad + 0.4 * net.g + 0.25 * (areae.g - 0.5) - 0.5;
    base *= vec3(1.0, 0.94, 0.85);
    base = mix(base, vec3(0.80, 0.42, 0.31), 0.55 * anatomy.y);
    base *= hue + blotch * vec3(0.5, 0.9, 0.9);
    base *= mix(vec3(0.95, 0.85, 0.84), vec3(1.0), pits);
    float stretched = 1.0 - smoothstep(0.0, 0.0025, fold);
    base = mix(base, vec3(0.30, 0.05, 0.06), net.b * gastric * (vessels.x + vessels.y * stretched * (1.0 - anatomy.y)) * smoothstep(0.4, 0.6, broad + 0.2));
    float deep = fold / 0.003 * (1.0 - ruga);  // light is lost, and red, between folds
    base *= mix(vec3(1.0), vec3(0.47, 0.32, 0.30), clamp(deep, 0.0, 1.0));
    base = mix(base, vec3(0.86, 0.48, 0.37) + 0.2 * (net.g - 0.5), 1.0 - gastric);
    base = mix(base, vec3(0.78, 0.36, 0.27), 0.6 * ring);
    base = mix(base, vec3(0.85, 0.62, 0.44), 0.10 * mucus);
  }
  base = heated(base, heat, clamp(browned / max(heat, 0.01), 0.0, 1.0));

  // Where the wall is close, its face comes nearer to the guides, and where it lies on the lens, all light goes through it.
  vec3 face = view_position, through = vec3(0.0);
  float open = 1.0;
  float close = 1.0 - smoothstep(kClose.x, kClose.y, length(view_position));
  if (close > 0.0) {
    float height = max(-dot(flat_normal, view_position), 0.0);
    float raised_by = min(close * kHalfWall, 0.98 * height);
    face += raised_by * flat_normal;
    open = mix(1.0, smoothstep(0.0, 0.002, height - raised_by), close);
    normal = normalize(mix(flat_normal, normal, open));
    through = close * seeping(face, flat_normal, reach, kNear);
    base *= mix(vec3(1.0), vec3(0.95, 0.72, 0.76), close * (1.0 - smoothstep(0.0, 0.6, texture3D(pattern, kCapillaries * rest).r)));
  }

  float dull = clamp(heat - 1.0, 0.0, 1.0);
  vec3 light = lamp(face, normal, film, reach, 0.25 * open, kNear, reaching);
  float around_light = open * fill * 0.3 * reach * reach / (dot(view_position, view_position) + 4e-4);
  vec3 radiance = base * (light.x + around_light + through) + open * wet * (3.0 * light.y + 0.05 * light.z) * (0.2 + net.g * net.g * 1.8 + 0.8 * mucus) * (1.0 - dull);
#ifdef SMOKE
  radiance = smoked(radiance, view_position, reach, smoke.x * wisp);
#endif
  gl_FragColor = vec4(stored(radiance), 1.0);
}
