#pragma once
#include <pybind11/pybind11.h>

namespace vibe::python {

/// Lets other threads of Python run until the end of the scope. When the program ends meanwhile, a thread does not come
/// back: Python would end it within a destructor, and with it the process (pybind11's gil_scoped_release does that).
class Unlocked {
 public:
  Unlocked();
  ~Unlocked();
  Unlocked(const Unlocked&) = delete;
  Unlocked& operator=(const Unlocked&) = delete;

 private:
  PyThreadState* state_;
};

constexpr int kStepsBetweenLooks = 32;  ///< whether the user interrupts; design choice

/// Raises what Ctrl+C has asked for, if anything; needs Python's lock.
void checkSignals();

/// From now on, threads that are Unlocked stop when the program ends, before Python goes.
void stopThreadsAtExit();

}  // namespace vibe::python
