#version 120
// Applies the projection and the exposure of the endoscope to a plane image; black outside of the circle.
uniform sampler2D picture;        // the plane image: square roots of radiances
uniform vec2 picture_size;        // of the result [px]
uniform float radius;             // of the circle [px]
uniform float half_angle;         // between the axis and the circle [rad]
uniform float equidistant;        // 1: radius = f theta, 0: radius = f tan theta
uniform float source_half_width;  // tangent of the angle to the centre of an edge of the plane image
uniform float source_size;        // edge of the plane image [px]
uniform float gain;               // of the exposure, see src/geometry/auto_exposure.hpp

varying vec2 place;  // in the result, 0 to 1

const int kMaxSamples = 12;

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
  // distance in the plane image of radial neighbours; near the rim it is several pixels, which are averaged
  float slope = equidistant > 0.5 ? half_angle * (1.0 + tangent * tangent) : tan(half_angle);
  float step = slope / radius;
  int samples = int(clamp(ceil(step / source_half_width * 0.5 * source_size - 0.25), 1.0, float(kMaxSamples)));
  vec3 light = vec3(0.0);
  for (int k = 0; k < kMaxSamples; ++k) {
    if (k >= samples) break;
    float along = tangent + step * ((float(k) + 0.5) / float(samples) - 0.5);
    light += texture2D(picture, 0.5 + 0.5 * direction * along / source_half_width).rgb;
  }
  light /= float(samples);
  // the sensor: a shoulder that keeps detail in bright areas, per channel, so that highlights become white
  vec3 exposed = 1.0 - exp(-gain * light * light);
  gl_FragColor = vec4(inside * pow(exposed, vec3(0.6)), 1.0);
}
