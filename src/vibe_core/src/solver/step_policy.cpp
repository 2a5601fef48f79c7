#include "vibe_core/solver/step_policy.hpp"

#include <algorithm>
#include <cmath>

namespace vibe {

namespace {

StepPolicy in_use;

// With members of type std::string, a compiler works on this function alone for a quarter of a minute.
std::vector<PolicyNumber> listNumbers() {
  std::vector<PolicyNumber> numbers;
  const char* section = "";
#define VIBE_POLICY_SECTION(title) section = title;
#define VIBE_REAL(name, value, unit, meaning, reason) \
  numbers.push_back({section, #name, unit, meaning, reason, &StepPolicy::name, nullptr});
#define VIBE_COUNT(name, value, meaning, reason) \
  numbers.push_back({section, #name, "", meaning, reason, nullptr, &StepPolicy::name});
#include "vibe_core/solver/contact_numbers.inl"
#include "vibe_core/solver/solver_numbers.inl"
#undef VIBE_POLICY_SECTION
#undef VIBE_REAL
#undef VIBE_COUNT
  return numbers;
}

}  // namespace

void PolicyNumber::scale(StepPolicy& policy, double factor) const {
  if (real != nullptr) {
    policy.*real *= factor;
    return;
  }
  const int before = policy.*count;
  const int step = std::max(1, static_cast<int>(std::lround(std::abs(factor - 1) * before)));
  policy.*count = factor < 1 ? std::max(0, before - step) : before + step;
}

const std::vector<PolicyNumber>& policyNumbers() {
  static const std::vector<PolicyNumber> numbers = listNumbers();
  return numbers;
}

const StepPolicy& stepPolicy() {
  return in_use;
}

void setStepPolicy(const StepPolicy& policy) {
  in_use = policy;
}

}  // namespace vibe
