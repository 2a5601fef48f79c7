#pragma once

#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "contact/contact_run.hpp"
#include "output/result_row.hpp"
#include "suture/wall_plan.hpp"

namespace vibe::benchmarks {

/// Names of the cases in the order in which they are measured; the first is the free pull.
const std::vector<std::string>& contactStateNames();

/// What contactStateNames() means, one line each.
std::string describeContactStates();

/// Prepares a case on a scene with gas, scope, helix and suture: an insufflated stomach.
class ContactStates {
 public:
  /// Builds the model and insufflates it to its regulated pressure.
  /// @param urdf  text of the scene's tool
  ContactStates(const Scene& scene, std::string urdf, std::ostream& log);

  /// @throws Error for another name than those of contactStateNames(), or if the state is not reached
  ContactCase prepare(const std::string& name);

 private:
  ContactCase pull(bool insufflator) const;
  ContactCase pressed() const;
  ContactCase wound() const;
  ContactCase cinch(int sets_before) const;
  ContactCase byHand(const State& state, const WallPoint& spot) const;

  std::shared_ptr<const Model> model_;
  std::string urdf_;
  State settled_;
  std::ostream& log_;
};

/// One case at one setting.
struct ContactRow {
  std::string name;
  ContactSetting setting;
  StepTimes times;                      ///< CPU of the stepping thread [ms]
  StepTimes wall;                       ///< [ms]
  double ratio = 0;                     ///< of the median to that of the free pull at the same setting
  ContactTrace trace;                   ///< without frames and forces
  std::optional<ContactErrors> errors;  ///< empty without a reference
};

/// What runContactStates() measures.
struct ContactPlan {
  std::vector<std::string> names;        ///< empty: all
  std::vector<ContactSetting> settings;  ///< those that differ in threads only stand behind one another
  std::optional<ContactSetting> reference;
  int repeats = 1;
  bool plain_preparation = false;  ///< prepares with Arithmetic::Plain, which valgrind runs eight times as fast
};

/// @param log  progress, and what the steps have spent their time on
std::vector<ContactRow> runContactStates(const Scene& scene, const std::string& urdf, const ContactPlan& plan,
                                         std::ostream& log);

void writeContactRows(const std::vector<ContactRow>& rows, std::ostream& out);  ///< CSV

}  // namespace vibe::benchmarks
