#include "geometry/stomach_knots.hpp"

#include <algorithm>

#include "arithmetic/elementary.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe {

namespace {

const StomachKnots kSthenic{0.75e-3,
                            {{-17, 43, 60, 39},
                             {-14, 38, 35, 45},
                             {-8, 30, 8, 45.5},
                             {-1, 22, -18, 43},
                             {5, 11, -42, 39},
                             {10, -6, -58, 34},
                             {13, -27, -62, 29.5},
                             {12, -48, -55, 25.5},
                             {7, -64, -42, 20.5},
                             {2, -73, -30, 14.5}},
                            {-4, -82, -17, 5},
                            {-10, -91, -2, 12.5},
                            {2, -33, -30, 0},
                            {-9, 0, 46, 0},
                            {-13, -12, 82, 0}};

const StomachKnots kJ{0.75e-3,
                      {{-16, 30, 92, 35},
                       {-14, 28, 66, 39},
                       {-10, 25, 34, 39},
                       {-5, 21, 2, 37},
                       {1, 15, -30, 34.5},
                       {6, 6, -62, 32},
                       {10, -8, -88, 29},
                       {12, -28, -100, 26},
                       {11, -47, -92, 23},
                       {7, -60, -74, 19},
                       {3, -67, -54, 14}},
                      {-3, -72, -36, 5},
                      {-9, -77, -18, 12.5},
                      {4, -33, -66, 0},
                      {-9, -5, 76, 0},
                      {-13, -17, 112, 0}};

const StomachKnots kSteerHorn{0.75e-3,
                              {{-16, 58, 38, 42},
                               {-13, 50, 16, 46.5},
                               {-7, 36, -4, 46},
                               {0, 17, -20, 43},
                               {6, -3, -32, 38},
                               {10, -23, -41, 33},
                               {11, -42, -48, 28},
                               {9, -60, -54, 23},
                               {5, -75, -60, 18.5},
                               {0, -87, -66, 13.5}},
                              {-6, -96, -72, 5},
                              {-13, -104, -80, 12.5},
                              {8, -32, -12, 0},
                              {-9, 8, 30, 0},
                              {-13, -2, 66, 0}};

constexpr int kFundusKnots = 4;

/// About the incisura, in the frontal plane.
void turn(Knot& knot, const Knot& about, double angle) {
  const double y = knot.y - about.y, z = knot.z - about.z;
  const double c = math::cos(angle), s = math::sin(angle);
  knot.y = about.y + c * y + s * z;
  knot.z = about.z - s * y + c * z;
}

}  // namespace

const std::vector<std::string>& stomachShapes() {
  static const std::vector<std::string> words{"sthenic", "j", "steer_horn"};
  return words;
}

const StomachKnots& stomachKnots(const std::string& shape) {
  if (shape == "sthenic") return kSthenic;
  if (shape == "j") return kJ;
  if (shape == "steer_horn") return kSteerHorn;
  throw Error("geometry.shape '" + shape + "' is unknown; choose sthenic, j or steer_horn");
}

StomachKnots variedKnots(const std::string& shape, double fundus_width, double antrum_angle) {
  StomachKnots knots = stomachKnots(shape);
  for (int k = 0; k < kFundusKnots; ++k)
    knots.body[k].radius *= 1 + (fundus_width - 1) * (kFundusKnots - k) / kFundusKnots;
  if (antrum_angle == 0) return knots;  // the same bits as without
  const Knot& incisura = knots.incisura_side;
  const auto distance = [&](const Knot& k) { return math::hypot(k.y - incisura.y, k.z - incisura.z); };
  const auto nearest = std::min_element(knots.body.begin(), knots.body.end(),
                                        [&](const Knot& a, const Knot& b) { return distance(a) < distance(b); });
  turn(*nearest, incisura, antrum_angle / 2);  // between the body, which stays, and the antrum
  std::for_each(nearest + 1, knots.body.end(), [&](Knot& knot) { turn(knot, incisura, antrum_angle); });
  for (Knot* knot : {&knots.pylorus, &knots.duodenum}) turn(*knot, incisura, antrum_angle);
  return knots;
}

}  // namespace vibe
