// What of each light guide reaches a place past the capsules of graphics/endoscope_lamp.hpp. To be included after
// lamp.glsl. Evaluated at vertices, so it cannot be sharper than they are dense.
const int kMaxCapsules = 12;
// One end with the radius, and the other end; view coordinates [m]. Twice kMaxCapsules: Ogre reads a number only.
uniform vec4 capsules[24];
uniform float capsule_count;

const float kGuideRadius = 0.00095;  // half of the 1.9 mm of the mesh [m]
const float kBlur = 0.001;           // half of the distance of vertices [m]

// The part of the disc of a guide that a capsule hides from a place: seen from there, the capsule is a strip before the
// disc, and the part is taken across the strip.
float hidden(vec3 place, vec3 guide, vec4 one, vec3 other) {
  vec3 ray = place - guide, axis = other - one.xyz, between = guide - one.xyz;
  float rr = dot(ray, ray), aa = dot(axis, axis) + 1e-12, ra = dot(ray, axis);
  float br = dot(between, ray), ba = dot(between, axis);
  // nearest points of the two segments (Ericson 2005, Real-Time Collision Detection, 5.1.9)
  float s = clamp((ra * ba - br * aa) / max(rr * aa - ra * ra, 1e-15), 0.0, 1.0);
  float t = clamp((ra * s + ba) / aa, 0.0, 1.0);
  s = clamp((ra * t - br) / rr, 0.0, 1.0);
  float distance = length(between + s * ray - t * axis);
  float disc = max(kGuideRadius * (1.0 - s), kBlur * s);
  return clamp((min(distance + disc, one.w) - max(distance - disc, -one.w)) / (2.0 * disc), 0.0, 1.0);
}

vec2 lightReaching(vec3 place) {
  vec2 part = vec2(1.0);
  for (int k = 0; k < kMaxCapsules; ++k) {
    if (float(k) >= capsule_count) break;
    vec4 one = capsules[2 * k];
    vec3 other = capsules[2 * k + 1].xyz;
    part.x *= 1.0 - hidden(place, guideAt(0), one, other);
    part.y *= 1.0 - hidden(place, guideAt(1), one, other);
  }
  return part;
}
