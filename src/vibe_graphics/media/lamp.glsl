// The light of the endoscope: two light guides beside the lens. View coordinates of Ogre: x right, y up, z backward.
// Radiances are linear, 1 for a white wall at the distance `reach` that faces the guides, before exposure.
//
// The numbers are shared by all materials that this file lights (graphics/endoscope_lamp.hpp): their programs say
// shared_params_ref vibe_lamp. Programs that define USUAL have the defaults as constants, which is faster where there is
// no graphics card.
#ifdef USUAL
const vec4 right_guide = vec4(0.0035, 0.0012, 0.0, 0.15), left_guide = vec4(-0.0035, 0.0012, 0.0, 0.15);
const vec2 lamp_ahead = vec2(0.35, 0.35);
const vec3 lamp_colour = vec3(1.0, 1.0, 1.0);
#else
uniform vec4 right_guide;  // place of the light guide [m]; w: what it shines at right angles
uniform vec4 left_guide;
uniform vec2 lamp_ahead;   // how much more each shines ahead
uniform vec3 lamp_colour;  // of the light, on a sensor whose white is balanced
#endif

vec3 guideAt(int k) {
  return vec3(k == 0 ? right_guide.xy : left_guide.xy, 0.0);
}

// What a surface at `place` with unit `normal` scatters (x) towards the lens, and what a film on it with the unit normal
// `film` mirrors, tightly (y) and in a wide lobe (z): powers 256 and 32 of the cosine (Blinn 1977), multiplied out
// because that is faster than pow().
// soft: how far scattered light reaches around edges, 0 to 1.
// near: distance below which light does not grow any more [m].
// reaching: the part of each guide's light that nothing hides, see shadow.glsl.
vec3 lamp(vec3 place, vec3 normal, vec3 film, float reach, float soft, float near, vec2 reaching) {
  vec3 to_eye = normalize(-place);
  vec3 sum = vec3(0.0);
  for (int k = 0; k < 2; ++k) {
    vec3 to_lamp = guideAt(k) - place;
    float square = dot(to_lamp, to_lamp);
    to_lamp *= inversesqrt(square);
    // the guides shine less to the sides
    float power = (k == 0 ? reaching.x : reaching.y) * reach * reach / (square + near * near) * ((k == 0 ? right_guide.w : left_guide.w) + (k == 0 ? lamp_ahead.x : lamp_ahead.y) * max(to_lamp.z, 0.0));
    vec3 half_way = to_lamp + to_eye;
    float mirrored = max(dot(film, half_way), 0.0);
    float m = mirrored * mirrored / dot(half_way, half_way);  // power 2
    m *= m, m *= m, m *= m, m *= m;                           // 32
    sum.x += power * max((dot(normal, to_lamp) + soft) / (1.0 + soft), 0.0);
    sum.z += power * m;
    m *= m, m *= m, m *= m;  // 256
    sum.y += power * m;
  }
  return sum;
}

vec3 lamp(vec3 place, vec3 normal, vec3 film, float reach, float soft, float near) {
  return lamp(place, normal, film, reach, soft, near, vec2(1.0));
}

const float kFreePath = 0.001;                       // of light in the wall until it has no direction [m]
const vec3 kAttenuation = vec3(400.0, 1000.0, 1200.0);  // of red, green and blue in the wall [1/m]

// What seeps out of a wall at `place` of the light that enters it beside, beyond what lamp() gives: all of it where the
// wall lies on the lens. The irradiance of a guide at the height h above a plane is Poisson's kernel of h, scattered over
// the length l it is that of h + l, and what has gone the way s through the wall is attenuated:
//   reach^2 [(h + l)/(a^2 + (h + l)^2)^(3/2) - h/(r (r^2 + near^2))] exp(-k (s - l)),  s = l/(h + l) sqrt(a^2 + (h + l)^2)
// with a the distance of the guide along the plane, and r in space. docs/endoscope_look.md has the sources.
vec3 seeping(vec3 place, vec3 normal, float reach, float near) {
  vec3 sum = vec3(0.0);
  for (int k = 0; k < 2; ++k) {
    vec3 to_lamp = guideAt(k) - place;
    float square = dot(to_lamp, to_lamp), height = max(dot(normal, to_lamp), 0.0);
    float deep = height + kFreePath;
    float way = sqrt(max(square - height * height, 0.0) + deep * deep);
    float more = deep / (way * way * way) - height * inversesqrt(square) / (square + near * near);
    float power = (k == 0 ? right_guide.w : left_guide.w) + (k == 0 ? lamp_ahead.x : lamp_ahead.y) * max(normal.z, 0.0);
    sum += power * max(more, 0.0) * exp(-kAttenuation * (kFreePath / deep * way - kFreePath));
  }
  return reach * reach * sum;
}

// Half-shadow beside the lens: nearer than this, smoke gets little more light. Design choice [m].
const float kSmokeNear = 0.025;
const vec3 kSmokeColour = vec3(0.80, 0.86, 0.92);  // small particles scatter blue more; design choice

// What comes to the lens from a surface of this radiance at `place`, through smoke with this extinction [1/m]. Its
// light goes there and back, and on the way smoke scatters light of the guides to the lens (once, to all sides alike):
//   radiance exp(-2 s d) + colour s/4 integral_0^d reach^2 / (r^2 + near^2) exp(-2 s r) dr.
// With r = near tan(u) the integral is one of exp() alone, taken at the middle of u. For all materials that lamp()
// lights, blood too: the last thing before stored(), with param_named_auto smoke fog_params in its program. Without
// smoke it changes nothing.
vec3 smoked(vec3 radiance, vec3 place, float reach, float extinction) {
  if (extinction <= 0.0) return radiance;
  float far = length(place);
  float middle = kSmokeNear * far / (kSmokeNear + sqrt(kSmokeNear * kSmokeNear + far * far));
  float lit = reach * reach / kSmokeNear * atan(far / kSmokeNear) * (right_guide.w + left_guide.w - (lamp_ahead.x + lamp_ahead.y) * place.z / far);
  float scattered = 0.25 * extinction * lit * exp(-2.0 * extinction * middle);
  return radiance * exp(-2.0 * extinction * far) + kSmokeColour * scattered;
}

// Shades are stored as square roots, near to what a screen shows; media/endoscope.frag exposes them. All light comes from
// the lamp, so its colour is that of all radiances.
vec3 stored(vec3 radiance) {
  return sqrt(max(radiance * lamp_colour, vec3(0.0)));
}

vec3 linear(vec3 shown) {
  return shown * shown;
}
