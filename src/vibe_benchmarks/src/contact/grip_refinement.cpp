#include "contact/grip_refinement.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <memory>
#include <ostream>

#include "contact/bench_tools.hpp"
#include "output/result_row.hpp"
#include "suture/suture_session.hpp"
#include "vibe_core/arithmetic/rotation.hpp"
#include "vibe_core/constraints/pull_patch.hpp"
#include "vibe_core/files/number_text.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::benchmarks {
namespace {

constexpr double kGripPull = 0.02;      // [m]
constexpr double kPullTime = 1;         // [s]
constexpr double kLongestWait = 3;      // until it rests [s]
constexpr double kStill = 2e-4;         // [m/s]
constexpr double kSiteDistance = 3e-3;  // [m]
constexpr double kFillFlow = 5e-4;      // of the insufflator: full within a second [m^3/s]
constexpr double kHelixReach = 0.02;    // of the helix, which is in the wall wherever the next particle is [m]
constexpr int kCorrections = 4;         // of the target of the spring

struct Site {
  Eigen::Vector3d place, inwards;
  int particle = -1;  // nearest
};

Site siteAt(const Model& model, const SurfaceView& wall, double across, double along) {
  const WallPlan plan(model.organ, wall);
  Site site;
  site.place = placeOf(plan.at(0.5 * plan.length() + along, across), wall);
  site.inwards = inwardsAt(wall, site.place);
  double nearest = HUGE_VAL;
  for (int i = 0; i < model.particle_count; ++i) {
    const double distance = (wall.position(i) - site.place).norm();
    if (distance < nearest) nearest = distance, site.particle = i;
  }
  return site;
}

StepInput insufflating() {
  StepInput input;
  input.buttons[Insufflate] = 1;
  input.joints[Insertion] = kHandStart;
  return input;
}

void rest(const StepInput& input, Simulation& simulation) {
  const int most = static_cast<int>(kLongestWait / simulation.stepPeriod());
  for (int k = 0; k < most; ++k) {
    simulation.step(input);
    if (maxSpeed(simulation.state()) < kStill) return;
  }
}

/// One insufflated mesh.
class Mesh {
 public:
  Mesh(Scene scene, int particles) {
    scene.geometry.particles = particles;
    scene.gas->flow_limit = kFillFlow;
    scene.render_surface = false;
    holdByHand({0, 0, 1}, {0, 0, 1}, scene);  // far away; every site moves the base
    scene.helix->reach = kHelixReach;
    model_ = buildModel(scene, freeHandUrdf());
    SutureSession session(model_);
    session.settle();
    settled_ = session.state();
    settled_.joints[Insertion] = kHandStart;
  }

  Site site(int number) const {
    const SurfaceView wall{model_->organ.surface.triangles, settled_.x, settled_.y, settled_.z};
    return siteAt(*model_, wall, kSiteDistance * (number % 3 - 1), kSiteDistance * (number / 3));
  }

  RefinementRow byHelix(const Site& site) const {
    auto model = std::make_shared<Model>(*model_);
    const Eigen::Quaterniond turn = rotationBetween(Eigen::Vector3d::UnitX(), site.inwards);
    model->tool_base = Eigen::Translation3d(site.place - kHandStart * site.inwards) * turn;
    Simulation simulation(model, SimulationSettings::study(1));
    simulation.replaceState(settled_);
    StepInput input = insufflating();
    input.buttons[HelixGrab] = 1;
    const int steps = static_cast<int>(kPullTime / simulation.stepPeriod());
    for (int k = 1; k <= steps; ++k) {
      input.joints[Insertion] = kHandStart + kGripPull * k / steps;
      simulation.step(input);
    }
    rest(input, simulation);
    const State& state = simulation.state();
    if (state.grip.empty()) throw Error("The helix of the study of refinement does not reach the wall.");
    RefinementRow row;
    row.held = static_cast<int>(state.grip.size());
    row.distance = kGripPull;
    row.force = std::abs(state.tool_force.x());  // along the pull, which is the x axis of the tip
    return row;
  }

  RefinementRow byPatch(const Site& site) const {
    Simulation simulation(model_, SimulationSettings::study(1));
    simulation.replaceState(settled_);
    StepInput input = insufflating();
    input.pull_particle = site.particle;
    input.pull_target = {settled_.x[at(site.particle)], settled_.y[at(site.particle)], settled_.z[at(site.particle)]};
    simulation.step(input);
    const Eigen::Vector3d start = heldPosition(simulation.state());
    double target = kGripPull;
    RefinementRow row;
    for (int k = 0; k < kCorrections; ++k) {  // until what is held, not the end of the spring, has moved by kGripPull
      input.pull_target = start + target * site.inwards;
      rest(input, simulation);
      row.distance = (heldPosition(simulation.state()) - start).dot(site.inwards);
      target += kGripPull - row.distance;
    }
    row.held = static_cast<int>(simulation.state().pull.node.size());
    row.force = simulation.state().pull.force.dot(site.inwards);
    return row;
  }

 private:
  static std::size_t at(int particle) { return static_cast<std::size_t>(particle); }

  std::shared_ptr<const Model> model_;
  State settled_;
};

}  // namespace

std::vector<RefinementRow> refineGrip(const Scene& scene, const std::vector<int>& particles, int sites,
                                      std::ostream& log) {
  std::vector<RefinementRow> rows;
  for (const int count : particles) {
    log << count << " particles" << std::endl;
    const Mesh mesh(scene, count);
    for (int number = 0; number < sites; ++number)
      for (const char* grip : {"helix", "patch"}) {
        const Site site = mesh.site(number);
        RefinementRow row = grip[0] == 'h' ? mesh.byHelix(site) : mesh.byPatch(site);
        row.grip = grip;
        row.particles = count;
        row.site = number;
        rows.push_back(row);
      }
  }
  return rows;
}

void writeRefinement(const std::vector<RefinementRow>& rows, std::ostream& out) {
  out << "grip,particles,site,held,distance_m,force_N\n";
  for (const RefinementRow& row : rows) {
    out << formatted("%s,%d,%d,%d,%.6g,%.6g\n", row.grip.c_str(), row.particles, row.site, row.held, row.distance,
                     row.force);
  }
}

}  // namespace vibe::benchmarks
