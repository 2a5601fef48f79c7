#include "vibe_core/constraints/wall_contacts.hpp"

#include "contact/self_contact.hpp"

namespace vibe {

WallContacts::WallContacts(const Model& model) {
  const TissueScene& tissue = model.scene.tissue;
  if (tissue.self_contact)
    contact_ = std::make_unique<SelfContact>(model.organ.surface, model.organ.thickness, tissue.young_modulus);
}

WallContacts::~WallContacts() = default;

int WallContacts::count(const State& state) {
  if (!contact_) return 0;
  contact_->detect({state.x.data(), state.y.data(), state.z.data()},
                   {state.vx.data(), state.vy.data(), state.vz.data()}, 0, 0);
  return static_cast<int>(contact_->pairs().size());
}

}  // namespace vibe
