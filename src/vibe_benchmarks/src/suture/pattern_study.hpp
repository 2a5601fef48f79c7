#pragma once
#include <optional>
#include <ostream>
#include <string>
#include <vector>

#include "suture/wall_plan.hpp"
#include "vibe_core/metrics/organ_measures.hpp"
#include "vibe_core/scene/scene.hpp"

namespace vibe::benchmarks {

constexpr double kMillimetreOfMercury = 133.322;  ///< [Pa]

/// The stomach at one moment, at equilibrium at a pressure.
struct PatternMeasures {
  OrganMeasures organ;
  double mean_strain = 0;  ///< in-plane, over the wall's area
  double high_strain = 0;  ///< exceeded by 5 % of the wall
  /// Mean over the wall of half the sum of the two principal stresses [Pa]. By the virial theorem this is -1/2 of the
  /// sum of elastic force times position, divided by the volume of the wall. Where ends are held, the holding forces
  /// make it depend on the origin, which is the centre of the particles.
  double mean_stress = 0;
  double elastic_energy = 0;  ///< [J]
};

class SutureSession;
PatternMeasures measurePattern(const SutureSession& session, OrganRuler& ruler);

/// One procedure: measures before and after it at the same pressure.
struct PatternRow {
  SetLayout layout;
  double pressure = 0, cinch_tension = 0;  ///< [Pa], [N]
  PatternMeasures before, after;
  double min_tension = 0, mean_tension = 0;  ///< of the first segments at the end [N]
  double drawn = 0;                          ///< thread drawn by all sets [m]
  int torn_out = 0, broken = 0, loose = 0, recoveries = 0;
  bool crossed = false;
  bool at_rest = true;  ///< false: still moving 10 s after the last set; `after` is the state at that time
  std::uint64_t state_hash = 0;
};

/// Insufflates a stomach, sews the sets with the insufflator on, and waits for equilibrium.
/// @throws Error as SutureSession and planSets
PatternRow runPattern(Scene scene, const SetLayout& layout, double pressure, double cinch_tension);

/// Patterns c, u and z at 15 mmHg with the same sets and bites. Unless quick, also complete procedures with u at the
/// pressure of the scene, narrow and wide, then the patterns with other tensions and wider. Each row is printed when it
/// is complete.
std::vector<PatternRow> studyPatterns(const Scene& scene, bool quick, std::ostream& log);

/// reduction() for a table: 0 where there is none [%].
inline double percentLess(std::optional<double> before, std::optional<double> now) {
  return 100 * reduction(before, now).value_or(0);
}

void printPatterns(const std::vector<PatternRow>& rows, std::ostream& out);
void writePatterns(const std::vector<PatternRow>& rows, std::ostream& out);  ///< CSV

}  // namespace vibe::benchmarks
