#pragma once
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "contact/contact_run.hpp"
#include "suture/set_scenario.hpp"

namespace vibe::benchmarks {

/// One case at one setting.
struct ContactRow {
  std::string name;
  ContactSetting setting;
  StepTimes times;                      ///< [ms]
  double ratio = 0;                     ///< of the median to that of the free pull at the same setting
  ContactTrace trace;                   ///< without frames and forces
  std::optional<ContactErrors> errors;  ///< empty without a reference
};

/// What runContactStates() measures.
struct ContactPlan {
  std::vector<std::string> names;  ///< empty: all
  std::vector<ContactSetting> settings;
  std::optional<ContactSetting> reference;
  bool check_reference = false;  ///< adds a row of the reference against one with steps half as long
  int repeats = 1;
};

/// @param log  progress and rows as they come
std::vector<ContactRow> runContactStates(const Scene& scene, const std::string& urdf, const ContactPlan& plan,
                                         std::ostream& log);

void printContactHeader(std::ostream& out);
void printContactRow(const ContactRow& row, std::ostream& out);
void writeContactRows(const std::vector<ContactRow>& rows, std::ostream& out);  ///< CSV

}  // namespace vibe::benchmarks
