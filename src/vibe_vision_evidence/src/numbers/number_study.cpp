#include "numbers/number_study.hpp"

#include <algorithm>
#include <cmath>

#include "vibe_core/program/error.hpp"

namespace vibe::vision::evidence {
namespace {

constexpr std::size_t kSearchStride = 4;

/// The defaults first, then each number with each factor, without anything measured.
std::vector<NumberEffect> shiftsOf(const StudyOptions& options) {
  std::vector<NumberEffect> shifts(1);
  const auto& wanted = options.numbers;
  for (const TrackerNumber& number : trackerNumbers()) {
    if (!wanted.empty() && std::find(wanted.begin(), wanted.end(), number.name) == wanted.end()) continue;
    for (const double factor : options.factors) {
      shifts.emplace_back();
      shifts.back().number = &number;
      shifts.back().factor = factor;
    }
  }
  const std::size_t named = (shifts.size() - 1) / std::max<std::size_t>(options.factors.size(), 1);
  if (!wanted.empty() && named != wanted.size())
    throw Error("--number: one of the names is no number of the tracker; --list shows all");
  return shifts;
}

TrackerPolicy policyOf(const NumberEffect& shift) {
  TrackerPolicy policy;
  if (shift.number != nullptr) shift.number->scale(policy, shift.factor);
  return policy;
}

Score scoreOf(const BenchScene& scene, const std::vector<RenderedFrame>& frames, bool sleeve,
              const TrackerPolicy& policy) {
  const auto method = makeOwnMethod(sleeve, policy, kSearchStride);
  Scorer scorer(*method, {});
  scorer.add(scene, frames, method->run(scene, frames), {});
  return scorer.score();
}

void addDifference(const Score& score, const Score& before, const std::string& where, NumberEffect& effect) {
  effect.tracked += score.tracked - before.tracked;
  effect.search_found += score.search_found - before.search_found;
  effect.wrong += score.wrong + score.search_wrong - before.wrong - before.search_wrong;
  effect.phantom += score.phantom - before.phantom;
  effect.doubted += score.doubted - before.doubted;
  const double change = score.rms / before.rms - 1;
  if (!std::isfinite(change) || std::abs(change) <= std::abs(effect.error)) return;
  effect.error = change;
  effect.error_where = where;
}

}  // namespace

std::vector<std::string> studyScenes() {
  std::vector<std::string> scenes = sceneNames();
  for (const char* harder : {"stops", "spin", "twins", "decoys", "spoilt_frames", "parked_bar", "rolling", "60_hz"})
    scenes.emplace_back(harder);
  return scenes;
}

std::vector<NumberEffect> studyNumbers(const StudyOptions& options, const std::function<void(std::string)>& progress) {
  std::vector<NumberEffect> effects = shiftsOf(options);
  for (const std::string& name : options.scenes) {
    progress(name);
    const Cell cell{name};
    const BenchScene scene = makeBenchScene(cell, 1);
    const std::vector<RenderedFrame> frames = renderFrames(scene, cell, options.frames);
    for (const bool sleeve : {false, true}) {
      const Score before = scoreOf(scene, frames, sleeve, {});
      for (auto effect = effects.begin() + 1; effect != effects.end(); ++effect)
        addDifference(scoreOf(scene, frames, sleeve, policyOf(*effect)), before,
                      name + (sleeve ? ", sleeve" : ", ring"), *effect);
    }
  }
  effects.erase(effects.begin());
  return effects;
}

void writeEffects(std::ostream& out, const std::vector<NumberEffect>& effects) {
  out << "section,number,default,unit,meaning,reason,factor,tracked,search_found,wrong,phantom,doubted,error,"
         "error_where\n";
  for (const NumberEffect& e : effects) {
    const TrackerNumber& n = *e.number;
    out << '"' << n.section << "\"," << n.name << ',' << n.of({}) << ',' << n.unit << ",\"" << n.meaning << "\",\""
        << n.reason << "\"," << e.factor << ',' << e.tracked << ',' << e.search_found << ',' << e.wrong << ','
        << e.phantom << ',' << e.doubted << ',' << e.error << ",\"" << e.error_where << "\"\n";
  }
}

}  // namespace vibe::vision::evidence
