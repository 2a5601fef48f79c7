#pragma once

#include <vector>

namespace vibe {

/// The numbers that steer a step: what counts as arrived, when a step is solved again, how much work it may do. They
/// belong to the method and not to a scene, whose numbers have keys. Each row of the tables solver_numbers.inl and
/// contact_numbers.inl is a member here, a row of docs/policy.md, and something that `vibe_policy` shifts to see what
/// depends on it.
struct StepPolicy {
  /// @cond
#define VIBE_POLICY_SECTION(title)
#define VIBE_REAL(name, value, unit, meaning, reason) double name = value;
#define VIBE_COUNT(name, value, meaning, reason) int name = value;
#include "vibe_core/solver/contact_numbers.inl"
#include "vibe_core/solver/solver_numbers.inl"
#undef VIBE_POLICY_SECTION
#undef VIBE_REAL
#undef VIBE_COUNT
  /// @endcond
};

/// One number of the policy, for tables and for what shifts it.
struct PolicyNumber {
  const char* section;                 ///< of the table
  const char* name;                    ///< of the member
  const char* unit;                    ///< empty for a ratio or a count
  const char* meaning;                 ///< what it decides
  const char* reason;                  ///< source, measurement or what speaks for the default
  double StepPolicy::*real = nullptr;  ///< exactly one of `real` and `count` is set
  int StepPolicy::*count = nullptr;    ///< a whole number

  /// Its value in a policy, in `unit`.
  double of(const StepPolicy& policy) const { return real != nullptr ? policy.*real : policy.*count; }
  /// A count becomes the nearest whole number, at least 1 above or below where it would stay the same.
  void scale(StepPolicy& policy, double factor) const;
};

/// All of them, in the order of the tables.
const std::vector<PolicyNumber>& policyNumbers();

/// The policy in use by this process.
const StepPolicy& stepPolicy();
/// Other numbers than the defaults, for experiments: before a model is made, and never while a step runs. Sessions then
/// have other bits, and recordings do not say so.
void setStepPolicy(const StepPolicy& policy);

/// Sets a policy, and at the end of its life the one that was before.
class ScopedStepPolicy {
 public:
  explicit ScopedStepPolicy(const StepPolicy& policy) : before_(stepPolicy()) { setStepPolicy(policy); }  ///< sets it
  ScopedStepPolicy(const ScopedStepPolicy&) = delete;
  ScopedStepPolicy& operator=(const ScopedStepPolicy&) = delete;
  ~ScopedStepPolicy() { setStepPolicy(before_); }

 private:
  const StepPolicy before_;
};

}  // namespace vibe
