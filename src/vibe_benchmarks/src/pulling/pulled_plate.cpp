#include "pulling/pulled_plate.hpp"

#include <algorithm>
#include <map>
#include <sstream>

#include "fem/case_model.hpp"
#include "fem/case_runner.hpp"
#include "vibe_core/files/files.hpp"
#include "vibe_core/files/number_text.hpp"
#include "vibe_core/procedure/procedure_registry.hpp"
#include "vibe_core/procedure/stitch.hpp"
#include "vibe_core/simulation/simulation.hpp"
#include "vibe_core/solver/implicit_stepper.hpp"
#include "vibe_core/suture/technique.hpp"

namespace vibe::benchmarks {
namespace {

/// One method of pulling.
struct PullWay {
  const char* method;   ///< tissue.model
  const char* pulling;  ///< suture.cinch_model
  int particles;        ///< suture.group_particles
  double strain_limit;  ///< suture.strain_limit
};

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

/// The plate of a case in the simulator, with one set of two bites at the spots of the cinch in the case.
class PulledPlate {
 public:
  PulledPlate(const CaseModel& plate, const PullWay& way)
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

  /// Runs a frame in which the cinch draws, unless the strain of the wall has reached the limit.
  /// @return  false if it has
  bool draw() {
    const SutureScene& scene = *simulation_.model().scene.suture;
    const double amount = scene.cinch_speed * simulation_.model().scene.step_period;
    const auto& cinch = simulation_.model().cinch;
    const double drawn = cinch ? cinch->draw(simulation_.model(), state(), amount, set()) : drawThread(amount, set());
    step();
    return drawn > 0;
  }

  void step() { simulation_.step(StepInput{}); }

  double milliseconds() const { return 1e3 * simulation_.timer().last_cpu; }  ///< CPU time of the last frame

  /// distance of the bites [m]
  double apart() const {
    return (bitePosition(set().bites[0], state().x, state().y, state().z) -
            bitePosition(set().bites[1], state().x, state().y, state().z))
        .norm();
  }

  /// [N]
  double tension() const { return set().tension.front(); }

  MotionView motion() {
    State& state = simulation_.editState();
    return {{state.x.data(), state.y.data(), state.z.data()},
            {state.vx.data(), state.vy.data(), state.vz.data()},
            {state.ax.data(), state.ay.data(), state.az.data()}};
  }

  const State& state() const { return simulation_.state(); }

 private:
  Suture& set() { return simulation_.editState().procedure.sutures.front(); }
  const Suture& set() const { return state().procedure.sutures.front(); }

  Simulation simulation_;
};

constexpr int kAll = 1000;
constexpr double kFrame = 1.0 / 60, kSpeed = 15e-3;  // of the cinch [s], [m/s]
constexpr int kRest = 60;                            // frames of rest before a level is measured
constexpr int kMaxFrames = 600;                      // of drawing, before a method counts as ended
constexpr double kLimit = 0.5, kWideLimit = 2;       // of strain
constexpr PullWay kWays[] = {{"shell", "thread", 5, kLimit},
                             {"shell", "groups", 5, kLimit},
                             {"shell", "groups", kAll, kLimit},
                             {"shell", "groups", kAll, kWideLimit},
                             {"shape_matching", "thread", 5, kLimit},
                             {"shape_matching", "groups", 5, kLimit},
                             {"shape_matching", "groups", kAll, kLimit},
                             {"shape_matching", "groups", kAll, kWideLimit}};

std::string nameOf(const PullWay& way) {
  if (std::string(way.pulling) == "thread") return "thread";
  if (way.particles != kAll) return "groups, first 5";
  return way.strain_limit == kLimit ? "groups, all" : "groups, all, limit 2";
}

/// Data shared by the methods: the case, its probe, the rows, and the file of the mid-lines.
struct Table {
  FemCase bench_case = readCase(resolveAddress("package://vibe_benchmarks/cases/case7_cinch.yaml"));
  CaseModel plate{bench_case, Hold::AsFixed};
  CaseProbe probe{plate};
  std::size_t tension = 0, field = 1;
  std::vector<ResultRow> rows;
  std::ostringstream profile;
  bool has_profile = false;

  double distanceAt(double level) const {
    const double rest = 2 * plate.benchCase().spots.at(bench_case.cinch->first).centre.norm();
    return rest + level * (bench_case.cinch->distance - rest);
  }

  void add(const std::string& method, const std::string& setting, std::size_t number, const MotionView& motion,
           double force, const std::vector<double>& times) {
    const double level = bench_case.statics->levels[number];
    ResultRow row;
    row.bench_case = formatted("bites_%.0f_mm", 1e3 * distanceAt(level)), row.method = method, row.setting = setting;
    row.particles = plate.nodeCount();
    setTimes(times, row);
    const double wanted = *bench_case.samples[tension].reference[number];
    row.motion_error = probe.measure(field, motion, plate.body(0), plate.loads(level), level);
    row.force_error = std::abs(force - wanted) / wanted;
    rows.push_back(row);
  }

  void addProfile(const std::string& method, const std::string& setting, const MotionView& motion, double force) {
    if (!has_profile) return;
    for (int n = 0; n < plate.nodeCount(); ++n)
      if (std::abs(plate.mesh().nodes[n].y()) < 1e-9)
        profile << method << ",\"" << setting << "\"," << motion.x[0][n] << ',' << motion.x[2][n] << ',' << force
                << '\n';
  }
};

void runWay(const PullWay& way, Table& table, std::ostream& log) {
  PulledPlate plate(table.plate, way);
  std::vector<double> times;
  std::size_t level = 0;
  const auto& levels = table.bench_case.statics->levels;
  for (int frame = 0; frame < kMaxFrames && level < levels.size(); ++frame) {
    if (plate.apart() > table.distanceAt(levels[level])) {
      if (!plate.draw()) break;  // the smallest distance that this method reaches
      times.push_back(plate.milliseconds());
      continue;
    }
    for (int k = 0; k < kRest; ++k) plate.step(), times.push_back(plate.milliseconds());
    table.add(way.method, nameOf(way), level, plate.motion(), plate.tension(), times);
    ++level;
  }
  for (int k = 0; level < levels.size() && k < kRest; ++k) plate.step(), times.push_back(plate.milliseconds());
  ResultRow end;
  end.bench_case = formatted("end_%.1f_mm_%.2f_N", 1e3 * plate.apart(), plate.tension()), end.method = way.method,
  end.setting = nameOf(way);
  end.particles = table.plate.nodeCount();
  setTimes(times, end);
  table.rows.push_back(end);
  log << "  " << way.method << ", " << nameOf(way) << ": bites end " << 1e3 * plate.apart() << " mm apart at "
      << plate.tension() << " N, frames take " << end.ms_p50 << " ms\n";
  table.addProfile(way.method, nameOf(way), plate.motion(), plate.tension());
}

/// The condition of the case itself, moved at the speed of the cinch in the steps of the shell.
void runConstraint(Table& table, std::ostream& log) {
  StepSettings settings;
  settings.iterations = TissueScene{}.iterations;
  ElasticBody body = table.plate.body(0);
  body.mass_damping = TissueScene{}.mass_damping;
  body.stiffness_damping = TissueScene{}.stiffness_damping;
  const ImplicitStepper stepper(body, settings);
  const auto scratch = stepper.makeWorkspace();
  BodyMotion motion(body);
  StepperMemory memory;
  std::vector<double> times;
  double now = 0, force = 0;
  const double part = kSpeed * kFrame / (table.distanceAt(0) - table.distanceAt(1));
  const auto step = [&](double level) {
    BodyLoads loads = table.plate.loads(level);
    const double before = threadMilliseconds();
    stepper.step(motion.view(), loads, memory, *scratch);
    times.push_back(threadMilliseconds() - before);
    force = -loads.constraints[0].force;
  };
  const auto& levels = table.bench_case.statics->levels;
  for (std::size_t level = 0; level < levels.size(); ++level) {
    while (now < levels[level]) step(now = std::min(levels[level], now + part));
    for (int k = 0; k < kRest; ++k) step(now);
    table.add("shell", "condition", level, motion.view(), force, times);
  }
  log << "  shell, condition: " << force << " N, frames take " << table.rows.back().ms_p50 << " ms\n";
  table.addProfile("shell", "condition", motion.view(), force);
}

}  // namespace

std::vector<ResultRow> runPulling(const std::string& profile, std::ostream& log) {
  Table table;
  if (!profile.empty()) {
    table.has_profile = true;
    table.profile << "method,setting,x,z,tension\n";
  }
  log << "pulling two bites together, " << table.plate.nodeCount() << " particles\n";
  runConstraint(table, log);
  for (const PullWay& way : kWays) runWay(way, table, log);
  if (!profile.empty()) writeFile(profile, table.profile.str(), "The table of mid-lines");
  return table.rows;
}

}  // namespace vibe::benchmarks
