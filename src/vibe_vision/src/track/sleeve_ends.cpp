#include <cmath>

#include "track/sleeve_pattern.hpp"

namespace vibe::vision {

/// Near an end of the helix.
void SleevePattern::cutAt(std::size_t i, Part& part) const {
  const float reach = kEdgeReach * std::sqrt(part.bar_variance[i]) + part.half_motion[i], u = part.u[i];
  const bool near_begin = u - reach <= helix_begin_, near_end = u + reach >= helix_end_;
  const float cut = near_end ? helix_end_ : helix_begin_, phase = part.w[i] - u + cut;
  Blackness black;
  if (parts_.count > 1) {
    black = bentCutAt(i, part);
  } else if (near_begin != near_end && cut_.edgeDistance(phase) > kCornerReach * std::sqrt(part.stripe_variance[i])) {
    black = plainCutAt(part, i, phase, near_end ? 1.0F : -1.0F, near_end ? u - cut : cut - u);
  } else if (rough_ && near_begin != near_end) {
    black = roughCutAt(part, i, near_end ? 1.0F : -1.0F, near_end ? u - cut : cut - u);
  } else {
    black = exactCutAt(part, i);
  }
  part.value[i] += black.value;
  part.by_u[i] += black.by_u;
  part.by_w[i] += black.by_w;
  part.by_blur[i] += black.by_blur;
}

SleevePattern::Blackness SleevePattern::exactCutAt(const Part& part, std::size_t i) const {
  const float reach = kEdgeReach * std::sqrt(part.bar_variance[i]) + part.half_motion[i], u = part.u[i];
  Blackness black = u + reach >= helix_end_ ? cutStripeAt(part, i, helix_end_) : stripeAt(part, i);
  if (u - reach <= helix_begin_) add(cutStripeAt(part, i, helix_begin_), -1, black);
  return black;
}

/// Of an accelerated motion, the mean over its parts.
SleevePattern::Blackness SleevePattern::bentCutAt(std::size_t i, Part& part) const {
  const float u = part.u[i], w = part.w[i], half = part.half_motion[i], stripe_half = part.stripe_half_motion[i];
  Blackness sum;
  for (int k = 0; k < parts_.count; ++k) {
    const float middle = (parts_.place[k + 1] + parts_.place[k]) / 2,
                length = (parts_.place[k + 1] - parts_.place[k]) / 2;
    part.u[i] = u - middle * half, part.w[i] = w - middle * stripe_half;
    part.half_motion[i] = length * half, part.stripe_half_motion[i] = length * stripe_half;
    add(exactCutAt(part, i), 1 / static_cast<float>(parts_.count), sum);
  }
  part.u[i] = u, part.w[i] = w, part.half_motion[i] = half, part.stripe_half_motion[i] = stripe_half;
  return sum;
}

/// Far from the edges of the stripe, the end of the helix is a step; the rest is the stripe, less what the step has.
/// @param out  distance from the end, outside of the helix; sign: of the direction to the outside along u
SleevePattern::Blackness SleevePattern::plainCutAt(const Part& part, std::size_t i, float phase, float sign,
                                                   float out) const {
  const float half = part.half_motion[i], variance = part.bar_variance[i], black = cut_.isBlack(phase) ? 1.0F : 0.0F;
  Blackness sum;
  if (out <= -half) {
    const float slope = part.stripe_slope[i];
    sum = {part.stripe[i] - black, slope, slope, 0.5F * part.stripe_variance[i] * part.stripe_bend[i]};
  } else if (out < half) {
    sum = stripeWithin(part, i, phase, sign, out, black);
  }
  if (black == 0) return sum;
  const NormalTable& normal = NormalTable::instance();
  const float deviation = std::sqrt(variance), inverse = 1 / deviation, per_motion = 0.5F / half;
  const NormalTable::Entry a = normal.at((-out - half) * inverse), b = normal.at((-out + half) * inverse);
  sum.value += deviation * per_motion * (b.integral - a.integral);
  sum.by_u -= sign * per_motion * (b.value - a.value);
  sum.by_blur += 0.5F * deviation * per_motion * (b.density - a.density);
  return sum;
}

/// The stripe times a step: not exact where the end of the helix meets an edge of the stripe.
SleevePattern::Blackness SleevePattern::roughCutAt(const Part& part, std::size_t i, float sign, float out) const {
  const NormalTable& normal = NormalTable::instance();
  const float half = part.half_motion[i], deviation = std::sqrt(part.bar_variance[i]), inverse = 1 / deviation;
  const float per_motion = 0.5F / half, slope = part.stripe_slope[i];
  const NormalTable::Entry a = normal.at((-out - half) * inverse), b = normal.at((-out + half) * inverse);
  const float seen = deviation * per_motion * (b.integral - a.integral);
  return {seen * part.stripe[i], seen * slope - sign * per_motion * (b.value - a.value) * part.stripe[i], seen * slope,
          0.5F * (seen * part.stripe_variance[i] * part.stripe_bend[i] +
                  deviation * per_motion * (b.density - a.density) * part.stripe[i])};
}

/// Of the stripe less what it is at the end of the helix, the part of the motion that is within the helix.
SleevePattern::Blackness SleevePattern::stripeWithin(const Part& part, std::size_t i, float phase, float sign,
                                                     float out, float black) const {
  const float half = part.half_motion[i], per_motion = 0.5F / half, variance = part.stripe_variance[i];
  const BlurredLine::Entry end = stripe_.at(phase, variance), begin = stripe_.at(part.w[i] - sign * half, variance);
  const float by_w = sign * per_motion * (black - begin.value), length = half - out;
  return {per_motion * (sign * (end.integral - begin.integral) + (stripe_.mean() - black) * length), by_w, by_w,
          -0.5F * variance * sign * per_motion * begin.slope};
}

void SleevePattern::add(const Blackness& other, float weight, Blackness& sum) {
  sum.value += weight * other.value;
  sum.by_u += weight * other.by_u;
  sum.by_w += weight * other.by_w;
  sum.by_blur += weight * other.by_blur;
}

SleevePattern::Blackness SleevePattern::stripeAt(const Part& part, std::size_t i) const {
  const float half = part.stripe_half_motion[i], variance = part.stripe_variance[i], inverse = 0.5F / half;
  const BlurredLine::Entry a = stripe_.at(part.w[i] - half, variance), b = stripe_.at(part.w[i] + half, variance);
  const float by_w = (b.value - a.value) * inverse;
  return {(b.integral - a.integral) * inverse + stripe_.mean(), by_w, by_w,
          0.5F * variance * (b.slope - a.slope) * inverse};
}

/// The stripe up to a cut.
SleevePattern::Blackness SleevePattern::cutStripeAt(const Part& part, std::size_t i, float cut) const {
  const float half = part.half_motion[i], inverse = 0.5F / half, along = part.bar_variance[i];
  const float y = part.u[i] - cut, phase = part.w[i] - y;
  const CutStripe::Entry a = cut_.at(y - half, phase, along, part.cut_variance[i], part.stripe_variance[i]);
  const CutStripe::Entry b = cut_.at(y + half, phase, along, part.cut_variance[i], part.stripe_variance[i]);
  return {(b.integral - a.integral) * inverse, (b.value - a.value) * inverse, (b.by_shift - a.by_shift) * inverse,
          0.5F * along * (b.slope - a.slope) * inverse};
}

}  // namespace vibe::vision
