#pragma once
#include <memory>

#include "vibe_core/constraints/constraint_registry.hpp"
#include "vibe_core/procedure/procedure_registry.hpp"

namespace vibe::prototype {

/// What the cinch does to a set that pulls by a group of particles (suture.cinch_model: groups), see group_draw.hpp.
class GroupCinch : public CinchModel {
 public:
  void begin(const Model& model, const State& state, Suture& suture) const override;
  double draw(const Model& model, const State& state, double amount, Suture& suture) const override;
  void slacken(const State& state, Suture& suture) const override;
};

/// The pull of such sets, see GroupPull. Null in a scene with other sutures or none.
std::unique_ptr<ConstraintBlock> makeGroupBlock(const Model& model);

}  // namespace vibe::prototype
