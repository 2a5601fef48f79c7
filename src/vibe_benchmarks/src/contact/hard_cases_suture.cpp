// Hard cases of threads and gas.

#include "contact/bench_tools.hpp"
#include "contact/hard_cases.hpp"
#include "suture/suture_session.hpp"
#include "suture/wall_plan.hpp"

namespace vibe::benchmarks {
namespace {

constexpr double kMercury = 133.322;    // [Pa/mmHg]
constexpr double kCinchTime = 3.5;      // longer than most sets need to their tension [s]
constexpr double kAfter = 1;            // between two sets [s]
constexpr double kApart = 0.15;         // of the bites of the case across [m]
constexpr double kAcrossTension = 8;    // [N]
constexpr double kAcrossTime = 12;      // of its cinch [s]
constexpr double kPressureFlow = 5e-3;  // of an insufflator that changes the pressure within a second [m^3/s]

StepInput pressing(Button button, StepInput input) {
  input.buttons[button] = 1;
  return input;
}

double distanceOf(const WallPoint& a, const WallPoint& b, const SurfaceView& wall) {
  return (placeOf(a, wall) - placeOf(b, wall)).norm();
}

/// Two places of the greater curvature at a distance, as far as the organ is long enough.
std::vector<WallPoint> spotsApart(const WallPlan& plan, const SurfaceView& wall, double distance) {
  std::vector<WallPoint> spots{plan.at(0.02 * plan.length(), 0), {}};
  for (double along = 0.04; along <= 0.98; along += 0.01) {
    spots[1] = plan.at(along * plan.length(), 0);
    if (distanceOf(spots[0], spots[1], wall) >= distance) break;
  }
  return spots;
}

}  // namespace

std::vector<std::vector<WallPoint>> HardCases::setsOf(int sets, int bites, double half_width, double share) const {
  SetLayout layout;
  layout.sets = sets;
  layout.bites = bites;
  layout.half_width = half_width;
  layout.share = share;
  const SurfaceView wall{model_->organ.surface.triangles, settled_.x, settled_.y, settled_.z};
  return planSets(WallPlan(model_->organ, wall), layout);
}

// Bites, T-tag, cinch, and a second without.
void HardCases::addSet(const std::vector<WallPoint>& spots, const StepInput& hold, HardCase& hard) const {
  const double step = model_->scene.step_period;
  hard.phases.push_back(still("tag", step, pressing(TTag, hold)));
  hard.phases.back().prepare = [spots](Simulation& simulation) {
    const State& state = simulation.state();
    const SurfaceView wall{simulation.model().organ.surface.triangles, state.x, state.y, state.z};
    Suture suture = sutureThrough(simulation.model(), wall, spots, state.time);
    simulation.editState().procedure.sutures.push_back(std::move(suture));
  };
  hard.phases.push_back(still("tagged", step, hold));
  hard.phases.push_back(still("cinch", kCinchTime, pressing(Cinch, hold)));
  hard.phases.push_back(still("after", kAfter, hold));
}

HardCase HardCases::cinchAcross() const {
  HardCase hard = begin();
  Scene scene = model_->scene;
  scene.suture->cinch_tension = kAcrossTension;
  scene.suture->pull_out_force = kStrongTissue;
  hard.model = modelWith(scene, urdf_, *model_);
  const SurfaceView wall{model_->organ.surface.triangles, settled_.x, settled_.y, settled_.z};
  const StepInput hold = holdAt(hard.start);
  addSet(spotsApart(WallPlan(model_->organ, wall), wall, kApart), hold, hard);
  hard.phases[2].duration = brief_ ? 4 : kAcrossTime;
  hard.phases.push_back(still("hold", brief_ ? 0.5 : 2, hold));
  hard.phases.push_back(still("rest", brief_ ? 1 : 4, hold));
  hard.phases.back().prepare = [](Simulation& simulation) { simulation.editState().procedure.sutures.clear(); };
  return hard;
}

HardCase HardCases::desufflate() const {
  HardCase hard = begin();
  hard.returns = false;
  const StepInput hold = holdAt(hard.start);
  for (const auto& spots : setsOf(brief_ ? 1 : 2, 7, 0.018, brief_ ? 0.15 : 0.3)) addSet(spots, hold, hard);
  Scene empty = model_->scene;
  empty.gas->regulated_pressure = 0;
  if (brief_) empty.gas->flow_limit *= 4;
  hard.phases.push_back(still("gas out", brief_ ? 2 : 8, hold));
  hard.phases.back().model = modelWith(empty, urdf_, *model_);
  hard.phases.push_back(still("gas in", brief_ ? 2 : 10, hold));
  hard.phases.back().model = model_;
  return hard;
}

HardCase HardCases::manySets(int sets, int bites) const {
  HardCase hard = begin();
  hard.returns = false;
  const StepInput hold = holdAt(hard.start);
  auto places = setsOf(sets, bites, 0.018, 0.6);
  if (brief_) places.resize(2);
  for (const auto& spots : places) addSet(spots, hold, hard);
  return hard;
}

HardCase HardCases::setOverSet() const {
  HardCase hard = begin();
  hard.returns = false;
  const StepInput hold = holdAt(hard.start);
  addSet(setsOf(3, 7, 0.018, 0.4)[1], hold, hard);
  addSet(setsOf(3, 7, 0.025, 0.6)[1], hold, hard);
  hard.phases.push_back(still("rest", brief_ ? 1 : 3, hold));
  return hard;
}

HardCase HardCases::pressureSteps() const {
  HardCase hard = begin();
  Scene low = model_->scene, high = model_->scene;
  low.gas->regulated_pressure = 5 * kMercury;
  high.gas->regulated_pressure = 45 * kMercury;
  low.gas->flow_limit = high.gas->flow_limit = kPressureFlow;
  const auto low_model = modelWith(low, urdf_, *model_), high_model = modelWith(high, urdf_, *model_);
  const StepInput hold = holdAt(hard.start);
  for (int k = 0; k < (brief_ ? 1 : 5); ++k) {
    hard.phases.push_back(still("5 mmHg", 1, hold));
    hard.phases.back().model = low_model;
    hard.phases.push_back(still("45 mmHg", 1, hold));
    hard.phases.back().model = high_model;
  }
  hard.phases.push_back(still("5 mmHg", 1, hold));
  hard.phases.back().model = low_model;
  Scene back = model_->scene;
  back.gas->flow_limit = kPressureFlow;
  hard.phases.push_back(still("rest", brief_ ? 1 : 3, hold));
  hard.phases.back().model = modelWith(back, urdf_, *model_);
  return hard;
}

}  // namespace vibe::benchmarks
