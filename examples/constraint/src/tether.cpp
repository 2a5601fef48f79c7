#include "vibe_example_constraint/tether.hpp"

#include <memory>

#include "vibe_core/constraints/constraint_registry.hpp"
#include "vibe_core/state/state.hpp"

namespace {

class TetherBlock : public vibe::ConstraintBlock {
 public:
  explicit TetherBlock(const Tether& tether) : tether_(tether), node_{tether.particle} {}

  /// Three rows that hold the particle at the end of the spring.
  vibe::Activity prepare(const vibe::StepContext& context, vibe::BodyLoads& loads) override {
    start_ = position(context.state);
    loads.addPoint(node_, weight_, tether_.end, 1 / tether_.stiffness);
    return vibe::Activity::Disturb;
  }

  /// The work of the spring on the tissue, for the energy balance.
  double store(const vibe::StepContext& context, const vibe::BodyLoads&, std::vector<vibe::ToolTouch>&) override {
    const double before = (tether_.end - start_).squaredNorm();
    const double after = (tether_.end - position(context.state)).squaredNorm();
    context.state.energy.pull_work += 0.5 * tether_.stiffness * (before - after);
    return 0;  // there is no energy term
  }

 private:
  Eigen::Vector3d position(const vibe::State& state) const {
    const auto i = static_cast<std::size_t>(tether_.particle);
    return {state.x[i], state.y[i], state.z[i]};
  }

  Tether tether_;
  std::vector<int> node_;
  std::vector<double> weight_{1};
  Eigen::Vector3d start_ = Eigen::Vector3d::Zero();  // of the step
};

}  // namespace

void registerTether(const Tether& tether) {
  vibe::registerConstraint("tether", [tether](const vibe::Model&) { return std::make_unique<TetherBlock>(tether); });
}
