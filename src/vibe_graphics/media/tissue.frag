#version 120
// Wet tissue. Colour: red, green, blue of the vertex times `tint`; its alpha is the effect of heat:
// 1 none, 2/3 mark, 1/3 burn scar, 0 deep burn.
uniform float side;        // 1: seen from outside, -1: seen from inside
uniform vec4 tint;         // alpha: opacity of the wall seen head-on
uniform float edge_alpha;  // opacity at grazing angles
uniform float wet;         // strength of highlights, 0: dull
uniform float relief;      // height of the fine relief [m]
uniform float grain;       // how much the fine pattern changes the colour
uniform float fill;        // ambient light; more for data colours
uniform float scars;       // 1: show heat, 0: do not; from outside it is shown only through a transparent wall
uniform float reach;       // of the lamp: distance of half intensity [m]; 0: constant intensity

varying vec3 view_position;
varying vec3 view_normal;
varying vec4 colour;
varying vec3 rest;

float hash(vec3 p) {
  p = fract(p * 0.3183099 + vec3(0.71, 0.113, 0.419));
  p *= 17.0;
  return fract(p.x * p.y * p.z * (p.x + p.y + p.z));
}

float noise(vec3 p) {
  vec3 cell = floor(p), f = fract(p);
  f = f * f * (3.0 - 2.0 * f);
  vec2 o = vec2(0.0, 1.0);
  return mix(mix(mix(hash(cell), hash(cell + o.yxx), f.x), mix(hash(cell + o.xyx), hash(cell + o.yyx), f.x), f.y),
             mix(mix(hash(cell + o.xxy), hash(cell + o.yxy), f.x), mix(hash(cell + o.xyy), hash(cell + o.yyy), f.x), f.y),
             f.z);
}

// Normal of a surface that is raised by height [m] (Mikkelsen 2010, Bump mapping unparametrized surfaces on the GPU).
vec3 raised(vec3 normal, float height) {
  vec3 px = dFdx(view_position), py = dFdy(view_position);
  vec3 r1 = cross(py, normal), r2 = cross(normal, px);
  float determinant = dot(px, r1);
  vec3 gradient = sign(determinant) * (dFdx(height) * r1 + dFdy(height) * r2);
  return normalize(abs(determinant) * normal - gradient);
}

vec3 heated(vec3 base, float heat) {
  vec3 rim = vec3(0.50, 0.16, 0.13), mark = vec3(0.96, 0.92, 0.80), burn = vec3(0.42, 0.24, 0.12), deep = vec3(0.07, 0.05, 0.04);
  base = mix(base, rim, 0.75 * smoothstep(0.05, 0.3, heat));  // reddened around
  base = mix(base, mark, smoothstep(0.4, 0.75, heat));
  base = mix(base, burn, smoothstep(1.2, 1.85, heat));
  return mix(base, deep, smoothstep(2.2, 2.9, heat));
}

void main() {
  float heat = scars * 3.0 * (1.0 - colour.a);
  // patterns finer than a pixel fade into their mean, otherwise they would alias
  float pixel = length(fwidth(rest));
  float fine = mix(noise(rest * 800.0), 0.5, smoothstep(0.15, 0.5, 800.0 * pixel));
  float coarse = mix(noise(rest * vec3(230.0, 230.0, 140.0)), 0.5, smoothstep(0.3, 0.8, 230.0 * pixel));
  vec3 to_eye = normalize(-view_position);
  vec3 normal = raised(side * normalize(view_normal), relief * (0.75 * coarse + 0.25 * fine));
  float facing = max(dot(normal, to_eye), 0.0);

  vec3 base = colour.rgb * tint.rgb * (1.0 + grain * (0.6 * coarse + 0.4 * fine - 0.5));
  base = heated(base, heat);
  float distance = length(view_position);
  float lamp = reach > 0.0 ? 2.0 / (1.0 + distance * distance / (reach * reach)) : 1.0;
  float above = reach > 0.0 ? 0.0 : 0.14 * normal.y;
  vec3 shaded = base * (fill + lamp * (0.96 - fill) * facing + above);

  vec3 aside = normalize(to_eye + normalize(vec3(0.35, 0.75, 0.55)));
  float gloss = pow(facing, 90.0) + (reach > 0.0 ? 0.0 : 0.6 * pow(max(dot(normal, aside), 0.0), 60.0));
  vec3 light = shaded + wet * lamp * gloss * vec3(1.0, 0.97, 0.93) * (1.0 - 0.8 * clamp(heat - 1.0, 0.0, 1.0));
  // exposure: bright areas keep their colour instead of becoming white
  float brightest = max(max(light.r, light.g), max(light.b, 0.001));
  if (reach > 0.0) light *= (1.0 - exp(-1.5 * brightest)) / brightest;
  float opacity = mix(edge_alpha, tint.a, facing);
  opacity = max(opacity, 0.75 * smoothstep(0.05, 0.4, heat));  // marks are visible through a transparent wall
  gl_FragColor = vec4(light, clamp(opacity + wet * gloss * 0.6, 0.0, 1.0));
}
