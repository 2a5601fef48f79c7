#include "suture/outcome_study.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "output/result_row.hpp"
#include "suture/suture_session.hpp"
#include "vibe_core/files/files.hpp"
#include "vibe_core/files/number_text.hpp"
#include "vibe_core/geometry/anatomical_map.hpp"
#include "vibe_core/trainee/suture_pattern.hpp"

namespace vibe::benchmarks {

namespace {

constexpr double kFlow = 5e-4;                    // of the insufflator: full within seconds [m^3/s]
constexpr double kLongest = 60;                   // of waiting for equilibrium [s]
constexpr double kMillimetreOfMercury = 133.322;  // [Pa]

double meanStress(const Model& model, const State& state) {
  const std::size_t n = state.x.size();
  std::vector<double> fx(n, 0.0), fy(n, 0.0), fz(n, 0.0);
  model.tissue->addForces(state, fx.data(), fy.data(), fz.data());
  const auto mean = [&](const std::vector<double>& v) { return std::accumulate(v.begin(), v.end(), 0.0) / double(n); };
  const double cx = mean(state.x), cy = mean(state.y), cz = mean(state.z);
  double virial = 0, wall = 0;
  for (std::size_t i = 0; i < n; ++i) {
    virial += fx[i] * (state.x[i] - cx) + fy[i] * (state.y[i] - cy) + fz[i] * (state.z[i] - cz);
    wall += model.area[i] * model.organ.thickness[i];
  }
  return -0.5 * virial / wall;
}

double meanStrain(const Model& model, const State& state) {
  std::vector<float> strain(state.x.size());
  model.tissue->strain(state, strain.data());
  double sum = 0, area = 0;
  for (std::size_t i = 0; i < strain.size(); ++i) {
    sum += model.area[i] * static_cast<double>(strain[i]);
    area += model.area[i];
  }
  return sum / area;
}

WallMeasures measure(const SutureSession& session, OrganRuler& ruler) {
  const State& state = session.state();
  return {ruler.measure(state.x, state.y, state.z), meanStrain(session.model(), state),
          meanStress(session.model(), state)};
}

std::shared_ptr<const Model> modelFor(Scene scene, const OutcomeTrial& trial, double pressure) {
  scene.geometry.particles = trial.particles;
  scene.gas->regulated_pressure = pressure;
  scene.gas->flow_limit = kFlow;
  scene.suture->cinch_tension = trial.tension;
  scene.suture->thread_friction = trial.thread_friction;
  scene.suture->loose_tension = std::min(scene.suture->loose_tension, 0.5 * trial.tension);
  if (!trial.foundation) scene.foundation.reset();
  return buildModel(scene, readTextFile(resolveAddress(scene.scope->urdf), "URDF"));
}

std::vector<WallPoint> placesOf(const OutcomeTrial& trial, double along, const AnatomicalMap& map) {
  const WallPoint centre = map.at(along, 0);
  std::vector<WallPoint> places;
  for (const Eigen::Vector2d& place : suturePattern(trial.pattern, kOutcomeBites, kOutcomeLength, kOutcomeWidth)) {
    places.push_back(map.walk(centre, place.x(), place.y()));
  }
  return places;
}

std::vector<std::vector<WallPoint>> planSleeve(const OutcomeTrial& trial, const SutureSession& session) {
  const SurfaceView wall = session.wall();
  std::vector<Eigen::Vector3d> vertices;
  for (int v = 0; v < session.model().particle_count; ++v) vertices.push_back(wall.position(v));
  const AnatomicalMap map(session.model().organ, vertices);
  std::vector<std::vector<WallPoint>> sets;
  for (int k = 0; k < kOutcomeSets; ++k)
    sets.push_back(placesOf(trial, kOutcomeFrom + (kOutcomeTo - kOutcomeFrom) * k / (kOutcomeSets - 1), map));
  return sets;
}

/// Largest tension of a set: segments between bites that have met bear none.
double tensionOf(const Suture& suture) {
  return suture.tension.empty() ? 0 : *std::max_element(suture.tension.begin(), suture.tension.end());
}

double meanTension(const State& state) {
  double sum = 0;
  for (const Suture& suture : state.procedure.sutures) sum += tensionOf(suture);
  return state.procedure.sutures.empty() ? 0 : sum / static_cast<double>(state.procedure.sutures.size());
}

/// Waits until the measures hold still.
void settle(SutureSession& session, OrganRuler& ruler, OutcomeRow& row) {
  const double begin = session.state().time;
  const auto look = [&]() -> std::array<double, 4> {
    const OrganMeasures organ = ruler.measure(session.state().x, session.state().y, session.state().z);
    return {organ.volume, organ.mean_area.value_or(1), organ.length.value_or(1), meanTension(session.state()) + 1e-3};
  };
  std::array<double, 4> last = look();
  do {
    session.run(kOutcomeWindow);
    const std::array<double, 4> now = look();
    row.change = 0;
    for (std::size_t k = 0; k < now.size(); ++k) row.change = std::max(row.change, std::abs(now[k] / last[k] - 1));
    last = now;
    row.settled = session.state().time - begin;
  } while (row.change > kOutcomeChange && row.settled < kLongest);
}

void noteSets(const State& state, OutcomeRow& row) {
  row.mean_tension = meanTension(state);
  row.min_tension = row.mean_tension;
  for (const Suture& suture : state.procedure.sutures) {
    row.min_tension = std::min(row.min_tension, tensionOf(suture));
    row.recognised += suture.technique == static_cast<int>(row.trial.pattern) ? 1 : 0;
  }
}

}  // namespace

SutureSession OutcomeStudy::atRest(const OutcomeTrial& trial, double pressure) {
  const Key key{trial.particles, pressure, trial.foundation};
  SutureSession session(modelFor(scene_, trial, pressure));
  const auto known = rest_.find(key);
  if (known != rest_.end()) {
    session.resume(known->second);
  } else {
    session.settle();
    rest_.emplace(key, session.state());
  }
  return session;
}

OutcomeRow OutcomeStudy::run(const OutcomeTrial& trial) {
  OutcomeRow row;
  row.trial = trial;
  const SutureSession untouched = atRest(trial, trial.pressure);
  OrganRuler ruler(untouched.model().organ);
  row.before = measure(untouched, ruler);
  SutureSession sewing = atRest(trial, trial.sewn_at);
  for (const auto& set : planSleeve(trial, sewing)) {
    const SewnSet sewn = sewing.sew(set, 0.5, trial.drawn);
    row.drawn += sewn.drawn, row.torn_out += sewn.tear_outs, row.broken += sewn.breaks, row.loose += sewn.loose;
  }
  SutureSession session(modelFor(scene_, trial, trial.pressure));
  session.resume(sewing.state());
  settle(session, ruler, row);
  row.after = measure(session, ruler);
  noteSets(session.state(), row);
  row.crossed = wallsCross(session.model(), session.state());
  return row;
}

std::vector<OutcomeTrial> outcomeTrials(const Scene& scene, bool quick) {
  std::vector<OutcomeTrial> trials;
  const auto add = [&](const std::string& name, const std::vector<Technique>& patterns, const auto& change) {
    for (const Technique pattern : patterns) {
      OutcomeTrial trial;
      trial.name = name, trial.pattern = pattern, trial.particles = scene.geometry.particles;
      trial.pressure = trial.sewn_at = 15 * kMillimetreOfMercury;
      trial.tension = scene.suture->cinch_tension, trial.thread_friction = scene.suture->thread_friction;
      trial.foundation = scene.foundation.has_value();
      change(trial);
      trials.push_back(trial);
    }
  };
  const std::vector<Technique> all{Technique::C, Technique::U, Technique::Z};
  add("as_cinched", all, [](OutcomeTrial&) {});
  if (quick) return trials;
  const double pressure = scene.gas->regulated_pressure, tension = scene.suture->cinch_tension;
  add("tight", {Technique::U}, [&](OutcomeTrial& t) { t.pressure = t.sewn_at = pressure; });
  add("loose", {Technique::U}, [&](OutcomeTrial& t) { t.pressure = t.sewn_at = pressure, t.tension = 0.3 * tension; });
  add("sewn_empty", all, [](OutcomeTrial& t) { t.sewn_at = 1 * kMillimetreOfMercury; });
  add("same_thread", all, [&](OutcomeTrial& t) { t.drawn = 35e-3, t.tension = 2 * tension; });
  add("fine_mesh", all, [](OutcomeTrial& t) { t.particles *= 2; });
  add("no_friction", all, [](OutcomeTrial& t) { t.thread_friction = 0; });
  add("no_foundation", all, [](OutcomeTrial& t) { t.foundation = false; });
  return trials;
}

void writeOutcomes(const std::vector<OutcomeRow>& rows, std::ostream& out) {
  out << "trial,pattern,particles,pressure,sewn_at,cinch_tension,thread_friction,foundation,volume_before,volume,"
         "length_before,length,curvature_before,curvature,area_before,area,least_area_before,least_area,strain_before,"
         "strain,stress_before,stress,mean_tension,least_tension,drawn,settled,change,recognised,torn_out,broken,loose,"
         "crossed\n";
  for (const OutcomeRow& row : rows) {
    const OutcomeTrial& trial = row.trial;
    const OrganMeasures &a = row.before.organ, &b = row.after.organ;
    out << trial.name << ',' << toString(trial.pattern) << ',' << trial.particles;
    for (const double value : {trial.pressure,
                               trial.sewn_at,
                               trial.tension,
                               trial.thread_friction,
                               trial.foundation ? 1.0 : 0.0,
                               a.volume,
                               b.volume,
                               a.length.value_or(0),
                               b.length.value_or(0),
                               a.greater_curvature.value_or(0),
                               b.greater_curvature.value_or(0),
                               a.mean_area.value_or(0),
                               b.mean_area.value_or(0),
                               a.min_area.value_or(0),
                               b.min_area.value_or(0),
                               row.before.mean_strain,
                               row.after.mean_strain,
                               row.before.mean_stress,
                               row.after.mean_stress,
                               row.mean_tension,
                               row.min_tension,
                               row.drawn,
                               row.settled,
                               row.change}) {
      out << formatted(",%.6g", value);
    }
    out << ',' << row.recognised << ',' << row.torn_out << ',' << row.broken << ',' << row.loose << ','
        << (row.crossed ? 1 : 0) << '\n';
  }
}

}  // namespace vibe::benchmarks
