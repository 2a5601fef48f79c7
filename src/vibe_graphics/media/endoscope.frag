#version 120
// Applies the projection and the exposure of the endoscope to plane images; black outside of the circle.
uniform sampler2D picture;        // the plane image: square roots of radiances
uniform sampler2D middle;         // the same of a narrower cone, with more pixels
uniform vec2 picture_size;        // of the result [px]
uniform float radius;             // of the circle [px]
uniform float half_angle;         // between the axis and the circle [rad]
uniform float equidistant;        // 1: radius = f theta, 0: radius = f tan theta
uniform float source_half_width;  // tangent of the angle to the centre of an edge of the plane image
uniform float source_size;        // edge of the plane image [px]
uniform float middle_half_width;  // the same two of the middle; 0: there is none
uniform float middle_size;
uniform float gain;               // of the exposure, see geometry/endoscope_optics.hpp

varying vec2 place;  // in the result, 0 to 1

const int kMaxSamples = 12;

// Mean over one pixel of the result along the radius; near the rim that is several pixels of the plane image.
// tangent, step: distance from the centre, and to radial neighbours, in units of source_half_width
vec3 mean(sampler2D plane, float half_width, float size, vec2 direction, float tangent, float step) {
  int samples = int(clamp(ceil(step / half_width * 0.5 * size - 0.25), 1.0, float(kMaxSamples)));
  vec3 light = vec3(0.0);
  // not up to a constant with a break: without a graphics card such a loop is unrolled, and all of it is computed always
  for (int k = 0; k < samples; ++k) {
    float along = tangent + step * ((float(k) + 0.5) / float(samples) - 0.5);
    light += texture2D(plane, 0.5 + 0.5 * direction * along / half_width).rgb;
  }
  return light / float(samples);
}

void main() {
  vec2 aside = (place - 0.5) * picture_size;
  float r = length(aside);
  float inside = clamp(radius - r + 0.5, 0.0, 1.0);
  if (inside == 0.0) {
    gl_FragColor = vec4(0.0, 0.0, 0.0, 1.0);
    return;
  }
  vec2 direction = r > 0.0 ? aside / r : vec2(0.0);
  float share = min(r, radius) / radius;
  float tangent = equidistant > 0.5 ? tan(share * half_angle) : share * tan(half_angle);
  float slope = equidistant > 0.5 ? half_angle * (1.0 + tangent * tangent) : tan(half_angle);
  float step = slope / radius;
  // the two planes overlap, so that nothing shows where one ends
  float outer = smoothstep(0.85, 0.95, (tangent + 0.5 * step) / max(middle_half_width, 1e-6));
  vec3 light = vec3(0.0);
  if (outer > 0.0) light += outer * mean(picture, source_half_width, source_size, direction, tangent, step);
  if (outer < 1.0)
    light += (1.0 - outer) * mean(middle, middle_half_width, middle_size, direction, tangent, step);
  // the sensor: a shoulder that keeps detail in bright areas, per channel, so that highlights become white
  vec3 exposed = 1.0 - exp(-gain * light * light);
  gl_FragColor = vec4(inside * pow(exposed, vec3(0.6)), 1.0);
}
