#pragma once
#include <memory>

#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

class SelfContact;

/// Where the wall of an organ touches itself, as the contact of the simulation sees it.
class WallContacts {
 public:
  /// @throws Error as the contact itself, for a wall without thickness or stiffness
  explicit WallContacts(const Model& model);
  ~WallContacts();

  /// Pairs of points of the wall that are in contact; 0 in a scene without self-contact.
  int count(const State& state);

 private:
  std::unique_ptr<SelfContact> contact_;  // null: without
};

}  // namespace vibe
