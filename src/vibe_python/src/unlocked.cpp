#include "unlocked.hpp"

#include <unistd.h>

#include <atomic>
#include <chrono>
#include <thread>

namespace vibe::python {

namespace {

std::atomic<int> unlocked{0};  // threads without Python's lock that want it back
std::atomic<bool> is_ending{false};
std::thread::id ending_thread;  // which goes on

constexpr std::chrono::seconds kPatience{2};  // with threads that are in the middle of a step

void stopIfEnding() {
  if (!is_ending || std::this_thread::get_id() == ending_thread) return;
  --unlocked;
  for (;;) ::pause();
}

void end() {
  ending_thread = std::this_thread::get_id();
  is_ending = true;
  const Unlocked others;
  const auto until = std::chrono::steady_clock::now() + kPatience;
  while (unlocked > 1 && std::chrono::steady_clock::now() < until)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

}  // namespace

Unlocked::Unlocked() : state_(PyEval_SaveThread()) {
  ++unlocked;
  stopIfEnding();
}

Unlocked::~Unlocked() {
  stopIfEnding();
  PyEval_RestoreThread(state_);
  --unlocked;
}

void checkSignals() {
  if (PyErr_CheckSignals() != 0) throw pybind11::error_already_set();
}

void stopThreadsAtExit() {
  pybind11::module_::import("atexit").attr("register")(pybind11::cpp_function(&end));
}

}  // namespace vibe::python
