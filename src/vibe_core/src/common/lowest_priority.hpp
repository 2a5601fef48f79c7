#pragma once
#include <pthread.h>
#include <sched.h>

namespace vibe {

/// For a thread that works ahead for a step to come: it inherits the real-time priority of the thread that steps, and
/// would take the processor from it just when the next step is due. Gives it the lowest real-time priority: below the
/// stepping thread, but above ordinary programs, since a step may have to wait for it. Ordinary threads stay as they
/// are.
inline void takeLowestPriority() {
  int policy = SCHED_OTHER;
  sched_param parameters{};
  if (::pthread_getschedparam(::pthread_self(), &policy, &parameters) != 0 || policy == SCHED_OTHER) return;
  parameters.sched_priority = ::sched_get_priority_min(policy);
  ::pthread_setschedparam(::pthread_self(), policy, &parameters);
}

}  // namespace vibe
