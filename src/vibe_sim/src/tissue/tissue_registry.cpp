#include "vibe_sim/tissue/tissue_registry.hpp"

#include "vibe_sim/error.hpp"
#include "vibe_sim/solver/xpbd_solver.hpp"
#include "vibe_sim/tissue/shape_matching.hpp"

namespace vibe {

namespace {

using Factory = TissueAndSolver (*)(Scene&, const Organ&, const std::vector<double>&, const std::vector<double>&, int);

TissueAndSolver makeShapeMatching(Scene& scene, const Organ& organ, const std::vector<double>& masses,
                                  const std::vector<double>& areas, int at_least) {
  auto tissue = std::make_shared<const ShapeMatching>(organ, scene.tissue, masses, areas, scene.step_period, at_least);
  scene.tissue.substeps = tissue->substeps();
  return {tissue, std::make_shared<const XpbdSolver>(tissue)};
}

struct Entry {
  const char* name;
  Factory make;
};

// A new tissue model is one line here, its own two files, and a test.
constexpr Entry kEntries[] = {{"shape_matching", makeShapeMatching}};

}  // namespace

std::vector<std::string> tissueModelNames() {
  std::vector<std::string> names;
  for (const Entry& entry : kEntries) names.emplace_back(entry.name);
  return names;
}

TissueAndSolver makeTissue(Scene& scene, const Organ& organ, const std::vector<double>& masses,
                           const std::vector<double>& areas, int at_least) {
  std::string known;
  for (const Entry& entry : kEntries) {
    if (scene.tissue.model == entry.name) return entry.make(scene, organ, masses, areas, at_least);
    known += (known.empty() ? "" : ", ") + std::string(entry.name);
  }
  throw Error("tissue.model '" + scene.tissue.model + "' is unknown; use one of: " + known + ".");
}

}  // namespace vibe
