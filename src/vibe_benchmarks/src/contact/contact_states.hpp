#pragma once
#include <string>
#include <vector>

#include "contact/contact_case.hpp"
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
  ContactCase byHand(const State& state, const WallSpot& spot) const;

  std::shared_ptr<const Model> model_;
  std::string urdf_;
  State settled_;
  std::ostream& log_;
};

}  // namespace vibe::benchmarks
