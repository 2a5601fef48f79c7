#include "simulator/phase_lock.hpp"

#include <algorithm>

namespace vibe::sim {

namespace {

// Between gaps that are almost as wide, the deadline stays where it is: two devices of the same rate leave two.
constexpr double kPreference = 0.15;  // of a period

std::int64_t share(double of, std::int64_t period) {
  return static_cast<std::int64_t>(of * static_cast<double>(period));
}

}  // namespace

void PhaseLock::arrive(std::int64_t time) {
  if (time - last_ > kSilence || time < last_) arrived_ = 0;
  last_ = time;
  times_[arrived_ % kWindow] = time;
  ++arrived_;
}

std::int64_t PhaseLock::correction(std::int64_t deadline) const {
  const std::optional<Gap> gap = findGap(phaseOf(deadline), deadline);
  if (!gap) return 0;
  std::int64_t error = phaseOf(gap->begin + kMargin - deadline);
  if (error > period_ / 2) error -= period_;
  const std::int64_t limit = share(kSlew, period_);
  return std::clamp(error, -limit, limit);
}

bool PhaseLock::awaits(std::int64_t deadline, std::int64_t now) const {
  if (last_ >= deadline - period_ / 2 || now - deadline >= share(kGrace, period_)) return false;
  return comesEveryPeriod() && findGap(phaseOf(deadline), now).has_value();
}

bool PhaseLock::comesEveryPeriod() const {
  const std::int64_t oldest = times_[arrived_ % kWindow];
  return arrived_ >= kWindow && last_ - oldest < (static_cast<std::int64_t>(kWindow) - 1) * (period_ + period_ / 20);
}

std::int64_t PhaseLock::phaseOf(std::int64_t time) const {
  const std::int64_t rest = time % period_;
  return rest < 0 ? rest + period_ : rest;
}

std::optional<PhaseLock::Gap> PhaseLock::findGap(std::int64_t phase, std::int64_t now) const {
  constexpr std::size_t n = kWindow;
  if (arrived_ < n || now - last_ > kSilence) return std::nullopt;
  std::array<std::int64_t, n> sorted{};
  std::transform(times_.begin(), times_.end(), sorted.begin(), [this](std::int64_t time) { return phaseOf(time); });
  std::sort(sorted.begin(), sorted.end());
  const std::size_t stride = 1 + static_cast<std::size_t>(kLate * static_cast<double>(n));
  Gap widest, present;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t next = (i + stride) % n;
    const Gap gap{sorted[i], sorted[next] - sorted[i] + (i + stride >= n ? period_ : 0)};
    if (gap.width > widest.width) widest = gap;
    if (phaseOf(phase - gap.begin) < gap.width && gap.width > present.width) present = gap;
  }
  const Gap& best = present.width + share(kPreference, period_) >= widest.width ? present : widest;
  if (best.width < share(kGap, period_)) return std::nullopt;
  return best;
}

}  // namespace vibe::sim
