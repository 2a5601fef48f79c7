#pragma once
#include <functional>
#include <memory>
#include <ostream>
#include <string>
#include <vector>

#include "vibe_core/model/model.hpp"
#include "vibe_core/simulation/simulation.hpp"

namespace vibe::benchmarks {

/// Force that a case compares.
enum class ContactSignal { ToolForce, ThreadTension };

/// A start state with contact and the motion of the hand that follows, prescribed over time, so that any step period
/// gives the same motion.
struct ContactCase {
  std::string name;
  std::shared_ptr<const Model> model;  ///< at the step period at which it was prepared
  std::string urdf;                    ///< text, of the tool
  State start;                         ///< at time 0
  double duration = 1;                 ///< [s]
  /// Command of the step that ends at a time after the start [s].
  std::function<StepInput(double end)> input;
  ContactSignal signal = ContactSignal::ToolForce;
};

/// Settings of the implicit step.
struct ContactSetting {
  int rate = 60;                 ///< steps per second, a multiple of 60 [Hz]
  int iterations = 4;            ///< tissue.iterations
  double spectral_radius = 0.2;  ///< tissue.spectral_radius
};

/// The model of the case with another setting.
std::shared_ptr<const Model> modelAt(const ContactCase& one, const ContactSetting& setting);

}  // namespace vibe::benchmarks
