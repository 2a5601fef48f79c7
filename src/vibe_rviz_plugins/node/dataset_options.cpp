#include "dataset_options.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <map>
#include <set>
#include <vector>

#include "dataset/variation.hpp"

namespace vibe {
namespace {

constexpr int kUsage = 2;
constexpr double kDegree = 3.14159265358979323846 / 180;

/// Switches on what is listed and the rest off.
/// @return a sentence if a word is unknown
std::string choose(const std::vector<std::string>& words, DatasetOptions& options) {
  const std::map<std::string, bool*> known{{"depth", &options.depth},         {"normals", &options.normals},
                                           {"labels", &options.labels},       {"flow", &options.flow},
                                           {"particles", &options.particles}, {"sutures", &options.sutures}};
  for (const auto& [name, on] : known) *on = false;
  for (const std::string& word : words) {
    const auto found = known.find(word);
    if (found == known.end())
      return "--content knows depth, normals, labels, flow, particles and sutures, not '" + word + "'.";
    *found->second = true;
  }
  return "";
}

void vary(DatasetOptions& options) {
  if (options.seed == 0) return;
  const CameraVariation variation = variationOf(static_cast<std::uint32_t>(options.seed), options.round.field_of_view);
  options.round.field_of_view = variation.field_of_view;
  options.sensor = variation.sensor;
  options.roll = variation.roll, options.pitch = variation.pitch, options.yaw = variation.yaw;
}

struct Words {
  std::string lens = "equidistant";
  double degrees = 140;
  std::vector<std::string> content;
};

void describe(CLI::App& app, DatasetOptions& options, Words& words) {
  app.add_option("BAG", options.bag, "whole recording, as vibe_replay --fill writes it")->required();
  app.add_option("--output", options.output, "empty or new folder")->required();
  app.add_flag("--check", options.check, "check the options and end");
  app.add_option("--name", options.name, "name of the recording, for the data sheet");
  app.add_option("--rate", options.rate, "images per second of simulated time; 0: every state")
      ->check(CLI::Range(0., 1000.));
  app.add_option("--every", options.every, "of these images, one in this many")->check(CLI::Range(1, 100000));
  app.add_option("--from", options.from, "begin at this time [s]")->check(CLI::NonNegativeNumber);
  app.add_option("--to", options.to, "end at this time [s]")->check(CLI::NonNegativeNumber);
  app.add_option("--width", options.round.width, "of the images [px]")->check(CLI::Range(16, 4096));
  app.add_option("--height", options.round.height, "of the images [px]")->check(CLI::Range(16, 4096));
  app.add_option("--lens", words.lens)->check(CLI::IsMember({"equidistant", "rectilinear"}));
  app.add_option("--field-of-view", words.degrees, "across the circle [degrees]")->check(CLI::Range(10., 170.));
  app.add_flag("--stereo", options.stereo, "a pair of lenses");
  app.add_option("--baseline", options.baseline, "between the lenses [m]")->check(CLI::Range(0.0001, 0.1));
  app.add_flag("!--no-smoke", options.smoke, "no smoke of the argon beam");
  app.add_option("--seed", options.seed, "of the variation of lens and sensor; 0: none")
      ->check(CLI::Range(0, 2147483647));
  app.add_option("--content", words.content, "beside the images")->delimiter(',');
}

}  // namespace

int readDatasetOptions(int argc, char** argv, DatasetOptions& options) {
  CLI::App app("Writes images with their truth from a whole recording of a session.", "vibe_dataset");
  Words words;
  describe(app, options, words);
  try {
    app.parse(argc, argv);
  } catch (const CLI::CallForHelp&) {
    std::fputs(app.help().c_str(), stdout);
    return 0;
  } catch (const CLI::ParseError& error) {
    std::fprintf(stderr, "vibe_dataset: %s (--help lists what there is)\n", error.what());
    return kUsage;
  }
  const std::string problem = words.content.empty() ? "" : choose(words.content, options);
  if (!problem.empty()) {
    std::fprintf(stderr, "vibe_dataset: %s\n", problem.c_str());
    return kUsage;
  }
  options.round.lens = words.lens == "rectilinear" ? LensKind::Rectilinear : LensKind::Equidistant;
  options.round.field_of_view = words.degrees * kDegree;
  if (options.name.empty()) options.name = options.bag;
  vary(options);
  return -1;
}

}  // namespace vibe
