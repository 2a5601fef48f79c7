#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <atomic>
#include <exception>
#include <functional>
#include <set>
#include <string>
#include <thread>

#include "arrays.hpp"
#include "bindings.hpp"
#include "tool.hpp"
#include "unlocked.hpp"

namespace vibe::python {

namespace {

using Handles = std::vector<std::shared_ptr<SimulationHandle>>;

/// Calls body(i) for i below count on some threads; the first exception is thrown when all have ended.
void inThreads(int count, int threads, const std::function<void(int)>& body) {
  std::atomic<int> next{0};
  std::vector<std::exception_ptr> errors(static_cast<std::size_t>(count));
  const auto work = [&] {
    for (int i = next++; i < count; i = next++) try {
        body(i);
      } catch (...) {
        errors[static_cast<std::size_t>(i)] = std::current_exception();
      }
  };
  std::vector<std::thread> others;
  for (int t = 1; t < std::min(threads, count); ++t) others.emplace_back(work);
  work();
  for (std::thread& other : others) other.join();
  for (const std::exception_ptr& error : errors)
    if (error) std::rethrow_exception(error);
}

/// The right to use all of them.
std::vector<std::unique_ptr<Use>> useAll(const Handles& handles) {
  for (std::size_t k = 0; k < handles.size(); ++k)
    if (!handles[k]) throw Error("'simulations[" + std::to_string(k) + "]' is None; give simulations.");
  if (std::set<std::shared_ptr<SimulationHandle>>(handles.begin(), handles.end()).size() < handles.size())
    throw Error("'simulations' holds one simulation twice; give each once.");
  std::vector<std::unique_ptr<Use>> uses;
  for (const auto& handle : handles) uses.push_back(std::make_unique<Use>(*handle));
  return uses;
}

// From where a joint is to where it shall be, evenly over the steps.
StepInput inputAt(const StepInput& from, const StepInput& to, double part) {
  StepInput input = to;
  for (std::size_t k = 0; k < input.joints.size(); ++k)
    input.joints[k] = from.joints[k] + part * (to.joints[k] - from.joints[k]);
  return input;
}

/// The way of one simulation, of which some steps at a time are taken.
struct Way {
  Session* session;
  StepInput from, to;

  void take(int first, int last, int steps) const {
    for (int k = first; k <= last; ++k)
      session->step(k == steps ? to : inputAt(from, to, static_cast<double>(k) / steps));
  }
};

std::vector<Way> waysOf(const std::vector<std::unique_ptr<Use>>& uses, const py::array_t<double>& joints,
                        const py::array_t<double>& pressed) {
  std::vector<Way> ways;
  for (const auto& use : uses) {
    const auto row = static_cast<py::ssize_t>(ways.size());
    StepInput to;
    std::copy_n(joints.data() + row * kJointCount, kJointCount, to.joints.begin());
    for (int k = 0; k < kButtonCount; ++k)
      to.buttons[static_cast<std::size_t>(k)] = pressed.data()[row * kButtonCount + k] != 0 ? 1 : 0;
    StepInput from = to;
    from.joints = use->state().joints;
    (*use)->events.clear();
    ways.push_back({&**use, from, to});
  }
  return ways;
}

std::vector<std::vector<Event>> stepAll(const Handles& handles, const py::handle& joints, const py::handle& buttons,
                                        int steps, int threads) {
  const auto count = static_cast<py::ssize_t>(handles.size());
  if (steps < 1) throw Error("'steps' is not positive; give how many steps each simulation is to take.");
  if (threads < 1) throw Error("'threads' is not positive; give the number of threads.");
  const auto wanted = numbers(joints, "joints", {count, kJointCount});
  const auto pressed = numbers(buttons, "buttons", {count, kButtonCount});
  const auto uses = useAll(handles);
  const std::vector<Way> ways = waysOf(uses, wanted, pressed);
  for (int done = 0; done < steps;) {
    const int last = std::min(steps, done + kStepsBetweenLooks);
    {
      const Unlocked others;
      inThreads(static_cast<int>(count), threads,
                [&](int i) { ways[static_cast<std::size_t>(i)].take(done + 1, last, steps); });
    }
    checkSignals();
    done = last;
  }
  std::vector<std::vector<Event>> events;
  for (const auto& use : uses) events.push_back((*use)->events);
  return events;
}

py::dict observeAll(const Handles& handles) {
  const auto count = static_cast<py::ssize_t>(handles.size());
  const auto uses = useAll(handles);
  py::array_t<double> joints({count, py::ssize_t{kJointCount}}), pose({count, py::ssize_t{4}, py::ssize_t{4}});
  py::array_t<double> wrench({count, py::ssize_t{6}}), time(count);
  py::array_t<std::int32_t> contacts(count);
  py::array_t<bool> grips(count);
  for (py::ssize_t i = 0; i < count; ++i) {
    const Use& use = *uses[static_cast<std::size_t>(i)];
    const State& state = use.state();
    std::copy_n(state.joints.data(), kJointCount, joints.mutable_data(i, 0));
    Eigen::Map<Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(pose.mutable_data(i, 0, 0)) =
        linkPose(use.model(), state, use.model().tip_link).matrix();
    Eigen::Map<Eigen::Matrix<double, 6, 1>>(wrench.mutable_data(i, 0)) = wrenchOf(state);
    time.mutable_at(i) = state.time;
    contacts.mutable_at(i) = state.contact_count;
    grips.mutable_at(i) = !state.grip.empty();
  }
  py::dict found;
  found["joints"] = joints;
  found["tip_pose"] = pose;
  found["wrench"] = wrench;
  found["time"] = time;
  found["contacts"] = contacts;
  found["grips"] = grips;
  return found;
}

py::array_t<double> wallPoints(const Handles& handles, const py::handle& triangles, const py::handle& weights) {
  const auto count = static_cast<py::ssize_t>(handles.size());
  const auto number = numbers(triangles, "triangles", {count, -1});
  const py::ssize_t points = number.shape(1);
  const auto weight = numbers(weights, "weights", {count, points, 3});
  const auto uses = useAll(handles);
  py::array_t<double> place({count, points, py::ssize_t{3}});
  for (py::ssize_t i = 0; i < count; ++i) {
    const Use& use = *uses[static_cast<std::size_t>(i)];
    const auto& list = use.model().organ.surface.triangles;
    for (py::ssize_t p = 0; p < points; ++p) {
      const double t = number.at(i, p);
      if (!(t >= 0 && t < static_cast<double>(list.size())))
        throw Error("'triangles' holds a number that is not a triangle of its wall; see Model.triangles.");
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (int k = 0; k < 3; ++k) {
        const auto node = static_cast<std::size_t>(list[static_cast<std::size_t>(t)][static_cast<std::size_t>(k)]);
        sum += weight.at(i, p, k) * Eigen::Vector3d(use.state().x[node], use.state().y[node], use.state().z[node]);
      }
      for (int k = 0; k < 3; ++k) place.mutable_at(i, p, k) = sum[k];
    }
  }
  return place;
}

}  // namespace

void bindBatch(py::module_& module) {
  module.def("step_all", &stepAll, py::arg("simulations"), py::arg("joints"), py::arg("buttons"), py::arg("steps"),
             py::arg("threads"),
             "Some steps of many simulations, each in one of the threads: joints (n, 7) are reached evenly over the "
             "steps, buttons (n, 6) are pressed. Returns a list of events per simulation. The results are those of one "
             "after the other. Ctrl+C ends it within some steps.");
  module.def("observe_all", &observeAll, py::arg("simulations"),
             "A dictionary of new arrays: joints (n, 7), tip_pose (n, 4, 4), wrench (n, 6), time (n,), contacts (n,) "
             "int32, grips (n,) bool; as the attributes of Simulation.");
  module.def("wall_points", &wallPoints, py::arg("simulations"), py::arg("triangles"), py::arg("weights"),
             "New array (n, k, 3): present positions of places of the wall, triangles (n, k) and weights (n, k, 3) of "
             "their corners [m].");
}

}  // namespace vibe::python
