#include "contact/hard_cases.hpp"

#include <algorithm>
#include <functional>
#include <map>
#include <ostream>

#include "contact/bench_tools.hpp"
#include "suture/suture_session.hpp"
#include "vibe_core/files/files.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/trainee/trainee_script.hpp"

namespace vibe::benchmarks {

const std::vector<std::string>& hardCaseNames() {
  static const std::vector<std::string> kNames{"ram_0.15", "ram_0.3",  "ram_0.5", "ram_1",      "random",
                                               "jump",     "wind",     "across",  "desufflate", "sets_20",
                                               "over_set", "pressure", "sleeve",  "8x7",        "14x4"};
  return kNames;
}

std::string describeHardCases() {
  return "  ram_V       the scope, straight, is pushed 60 mm into the wall at V m/s and withdrawn\n"
         "  random      all joints go to random places within their limits and speeds, buttons are pressed at random,\n"
         "              for 30 s\n"
         "  jump        wound in and holding, all joints go at their own speeds to random limits every 0.2 s, for 20 "
         "s\n"
         "  wind        the helix, turned 20 times while it holds, is turned by half a turn and pulled by 60 mm\n"
         "  across      two bites 150 mm apart are cinched with 8 N, then the thread is removed\n"
         "  desufflate  two sets, then the gas is let out and in again\n"
         "  sets_20     20 sets of 4 bites\n"
         "  over_set    a set of 7 bites over one of 7\n"
         "  pressure    5, 45 and 5 mmHg, 1 s each, five times\n"
         "  sleeve      three wide sets are cinched around the scope, which is withdrawn and inserted again\n"
         "  8x7, 14x4   8 sets of 7 bites, 14 sets of 4\n";
}

HardCases::HardCases(const Scene& scene, std::string urdf, bool brief, std::ostream& log)
    : model_(buildModel(scene, urdf)), urdf_(std::move(urdf)), brief_(brief) {
  log << "insufflation" << std::endl;
  SutureSession session(model_);
  session.settle();
  settled_ = session.state();
  startClock(settled_);
}

HardCase HardCases::prepare(const std::string& name, std::uint64_t seed) {
  const std::map<std::string, std::function<HardCase()>> makers{
      {"random", [&] { return random(seed); }},
      {"jump", [&] { return jump(seed); }},
      {"wind", [&] { return wind(); }},
      {"across", [&] { return cinchAcross(); }},
      {"desufflate", [&] { return desufflate(); }},
      {"sets_20", [&] { return manySets(20, 4); }},
      {"8x7", [&] { return manySets(8, 7); }},
      {"14x4", [&] { return manySets(14, 4); }},
      {"over_set", [&] { return setOverSet(); }},
      {"pressure", [&] { return pressureSteps(); }},
      {"sleeve", [&] { return sleeve(); }},
  };
  const auto maker = makers.find(name);
  const bool rams = name.rfind("ram_", 0) == 0;
  if (!rams && maker == makers.end())
    throw Error("There is no hard case '" + name + "'; the program's help names those there are.");
  HardCase hard = rams ? ram(std::stod(name.substr(4))) : maker->second();
  hard.name = name == "random" || name == "jump" ? name + "_" + std::to_string(seed) : name;
  return hard;
}

HardCase HardCases::session(const std::string& script, double longest) const {
  const auto trainee = std::make_shared<const TraineeScript>(TraineeScript::load(resolveAddress(script)));
  HardCase hard;
  hard.name = trainee->name();
  hard.model = model_;
  hard.start = hard.home = initialState(*model_, model_->scene.seed);
  hard.returns = false;
  const double step = model_->scene.step_period;
  hard.phases.push_back(phaseOf("session", std::min(longest, trainee->duration()),
                                [trainee, step](double end) { return trainee->at(end - step); }));
  return hard;
}

HardCase HardCases::begin() const {
  HardCase hard;
  hard.model = model_;
  hard.start = hard.home = settled_;
  return hard;
}

}  // namespace vibe::benchmarks
