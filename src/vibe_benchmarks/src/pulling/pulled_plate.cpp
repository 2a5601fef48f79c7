#include "pulling/pulled_plate.hpp"

#include <algorithm>

#include "output/result_row.hpp"
#include "vibe_core/procedure/procedure_registry.hpp"
#include "vibe_core/procedure/stitch.hpp"
#include "vibe_core/suture/technique.hpp"

namespace vibe::benchmarks {
namespace {

constexpr double kDepth = 10e-3;  // of the box that closes the plate, as shape matching requires [m]

/// Adds a held underside and sides, because shape matching requires a closed surface.
void closeBelow(SurfaceMesh& mesh) {
  const int count = static_cast<int>(mesh.vertices.size());
  std::map<std::array<int, 2>, int> sides;
  for (const auto& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k) ++sides[{t[k], t[(k + 1) % 3]}];
  for (int n = 0; n < count; ++n) mesh.vertices.emplace_back(mesh.vertices[n] - kDepth * Eigen::Vector3d::UnitZ());
  const std::size_t top = mesh.triangles.size();
  for (std::size_t i = 0; i < top; ++i) {
    const auto t = mesh.triangles[i];
    mesh.triangles.push_back({t[0] + count, t[2] + count, t[1] + count});
  }
  for (const auto& [side, times] : sides) {
    const auto [a, b] = side;
    if (times != 1 || sides.count({b, a}) != 0) continue;
    mesh.triangles.push_back({a, a + count, b + count});
    mesh.triangles.push_back({a, b + count, b});
  }
}

Bite biteAt(const NodeMean& spot, double thickness) {
  Bite bite;
  bite.particle = spot.node;
  bite.weight = spot.weight;
  bite.depth = bite.thickness = thickness;
  return bite;
}

std::shared_ptr<const Model> makeModel(const CaseModel& plate, const PullWay& way) {
  const FemCase& c = plate.benchCase();
  auto model = std::make_shared<Model>();
  Scene& scene = model->scene;
  scene.tissue.model = way.method;
  scene.tissue.law = "neo_hookean";
  scene.tissue.density = c.density;
  scene.tissue.young_modulus = c.material.young_modulus;
  scene.tissue.poisson_ratio = c.material.poisson_ratio;
  scene.attach_oesophagus = true;
  scene.suture = SutureScene{};
  scene.suture->cinch_model = way.pulling;
  scene.suture->group_particles = way.particles;
  scene.suture->strain_limit = way.strain_limit;
  Organ& organ = model->organ;
  organ.surface.vertices = plate.mesh().nodes;
  organ.surface.triangles = plate.mesh().triangles;
  const std::size_t count = organ.surface.vertices.size();
  if (scene.tissue.model == "shape_matching") closeBelow(organ.surface);
  const std::size_t all = organ.surface.vertices.size();
  organ.region.assign(all, Region::Body);
  organ.wall.assign(all, Wall::Anterior);
  organ.end.assign(all, End::None);
  organ.thickness.assign(all, c.thickness);
  for (const std::string& name : c.clamped)
    for (const int node : plate.set(name)) organ.end[node] = End::Oesophagus;
  std::fill(organ.end.begin() + static_cast<std::ptrdiff_t>(count), organ.end.end(), End::Oesophagus);
  finishModel("", *model);
  return model;
}

}  // namespace

PulledPlate::PulledPlate(const CaseModel& plate, const PullWay& way)
    : simulation_(makeModel(plate, way), SimulationSettings::study(1)) {
  const FemCase& c = plate.benchCase();
  Suture& suture = simulation_.editState().procedure.sutures.emplace_back();
  for (const std::string& spot : {c.cinch->first, c.cinch->second})
    suture.bites.push_back(biteAt(plate.spot(spot), c.thickness));
  suture.length = {apart()};
  suture.tension = {0};
  suture.technique = static_cast<std::uint8_t>(Technique::Other);
  suture.stage = Suture::Stage::Cinching;
  if (const auto& cinch = simulation_.model().cinch) cinch->begin(simulation_.model(), state(), suture);
}

bool PulledPlate::draw() {
  const SutureScene& scene = *simulation_.model().scene.suture;
  const double amount = scene.cinch_speed * simulation_.model().scene.step_period;
  const auto& cinch = simulation_.model().cinch;
  const double drawn = cinch ? cinch->draw(simulation_.model(), state(), amount, set()) : drawThread(amount, set());
  step();
  return drawn > 0;
}

void PulledPlate::step() {
  simulation_.step(StepInput{});
}

double PulledPlate::apart() const {
  return (bitePosition(set().bites[0], state().x, state().y, state().z) -
          bitePosition(set().bites[1], state().x, state().y, state().z))
      .norm();
}

double PulledPlate::tension() const {
  return set().tension.front();
}

MotionView PulledPlate::motion() {
  State& state = simulation_.editState();
  return {{state.x.data(), state.y.data(), state.z.data()},
          {state.vx.data(), state.vy.data(), state.vz.data()},
          {state.ax.data(), state.ay.data(), state.az.data()}};
}

}  // namespace vibe::benchmarks
