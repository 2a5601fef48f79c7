#pragma once
#include <map>
#include <optional>
#include <ostream>
#include <string>
#include <tuple>
#include <vector>

#include "suture/suture_session.hpp"
#include "vibe_core/metrics/organ_measures.hpp"
#include "vibe_core/scene/scene.hpp"
#include "vibe_core/suture/technique.hpp"

namespace vibe::benchmarks {

/// The stomach at one moment, at equilibrium at a pressure.
struct WallMeasures {
  OrganMeasures organ;
  double mean_strain = 0;  ///< in-plane, over the wall's area
  /// Mean over the wall of half the sum of the two principal stresses [Pa]. By the virial theorem this is -1/2 of the
  /// sum of elastic force times position, divided by the volume of the wall. Where ends are held, the holding forces
  /// make it depend on the origin, which is the centre of the particles.
  double mean_stress = 0;
};

/// One idealised sleeve: where its bites are and how it is cinched.
struct OutcomeTrial {
  std::string name;  ///< of the group of trials that are compared with each other
  Technique pattern = Technique::U;
  int particles = 3618;
  double pressure = 2000;         ///< at which the stomach is measured [Pa]
  double sewn_at = 2000;          ///< pressure at which the bites are made and the threads are cinched [Pa]
  double tension = 3;             ///< at which the cinch stops drawing [N]
  double thread_friction = 0.15;  ///< ratio
  std::optional<double> drawn;    ///< of every set, at most [m]
  bool foundation = true;         ///< neighbouring organs
};

/// Before and after it at the same pressure.
struct OutcomeRow {
  OutcomeTrial trial;
  WallMeasures before, after;
  double mean_tension = 0, min_tension = 0;  ///< over the sets, of the largest in each at rest [N]
  double drawn = 0;                          ///< thread drawn by all sets [m]
  double settled = 0;                        ///< time after the last set until `after` is measured [s]
  /// Largest relative change of volume, mean area, length and tension in the last kOutcomeWindow of it.
  double change = 0;
  int recognised = 0;  ///< sets of the technique that was sewn
  int torn_out = 0, broken = 0, loose = 0;
  bool crossed = false;
};

constexpr int kOutcomeSets = 6, kOutcomeBites = 7;
constexpr double kOutcomeLength = 13e-3, kOutcomeWidth = 60e-3;  // of a set: those of trainees/expert.yaml [m]
constexpr double kOutcomeFrom = 0.63, kOutcomeTo = 0.18;         // of the axis: about the same
constexpr double kOutcomeWindow = 4;                             // [s]
constexpr double kOutcomeChange = 1e-3;                          // allowed within that window

/// Sews idealised sleeves. Stomachs at rest are kept, so that patterns in the same stomach share it.
class OutcomeStudy {
 public:
  explicit OutcomeStudy(const Scene& scene) : scene_(scene) {}

  /// Sews the sets of a sleeve at the places of trainee/suture_pattern, found by anatomy on the stomach at the pressure
  /// at which it is sewn, cinches them one after the other, brings the stomach to the pressure at which it is measured,
  /// and waits until nothing that is measured changes by more than kOutcomeChange within kOutcomeWindow.
  /// @throws Error as SutureSession and AnatomicalMap
  OutcomeRow run(const OutcomeTrial& trial);

 private:
  using Key = std::tuple<int, double, bool>;  // particles, pressure, foundation

  /// A session of the trial's stomach at rest at a pressure, without sutures.
  SutureSession atRest(const OutcomeTrial& trial, double pressure);

  Scene scene_;
  std::map<Key, State> rest_;
};

/// The trials of docs/accuracy.md: C, U and Z at 15 mmHg on two meshes, at the pressure of the scene with a tight and a
/// loose cinch, and with one modelling choice changed at a time. Quick: only the first three.
std::vector<OutcomeTrial> outcomeTrials(const Scene& scene, bool quick);

void writeOutcomes(const std::vector<OutcomeRow>& rows, std::ostream& out);  ///< CSV

}  // namespace vibe::benchmarks
