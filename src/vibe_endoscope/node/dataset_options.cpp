#include "dataset_options.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <utility>
#include <vector>

#include "dataset/variation.hpp"

namespace vibe::endoscope {
namespace {

constexpr int kUsage = 2;

using Switches = std::vector<std::pair<std::string, bool*>>;

/// Switches on what is listed and the rest off; without a list, nothing changes.
/// @return a sentence if a word is unknown
std::string choose(const std::string& option, const std::vector<std::string>& words, const Switches& known) {
  if (words.empty()) return "";
  std::string names;
  for (const auto& [name, on] : known) *on = false, names += (names.empty() ? "" : ", ") + name;
  for (const std::string& word : words) {
    const auto found = std::find_if(known.begin(), known.end(), [&](const auto& entry) { return entry.first == word; });
    if (found == known.end()) return option + " knows " + names + ", not '" + word + "'";
    *found->second = true;
  }
  return "";
}

void vary(DatasetOptions& options) {
  if (options.seed == 0) return;
  const Variation drawn = variationOf(static_cast<std::uint32_t>(options.seed), options.round.field_of_view);
  if (options.vary_lens) {
    options.round.field_of_view = drawn.field_of_view;
    options.roll = drawn.roll, options.pitch = drawn.pitch, options.yaw = drawn.yaw;
  }
  if (options.vary_sensor) options.sensor = drawn.sensor;
  if (options.vary_mucosa) options.mucosa = drawn.mucosa;
  if (options.vary_light) options.light = drawn.light;
}

struct Words {
  std::string lens = "equidistant";
  double degrees = 140;
  std::vector<std::string> content, varied;
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
  app.add_option("--seed", options.seed, "of the variation of lens, sensor, mucosa and light; 0: none")
      ->check(CLI::Range(0, 2147483647));
  app.add_option("--vary", words.varied, "what the seed varies, of: lens, sensor, mucosa, light")->delimiter(',');
  app.add_option("--content", words.content, "beside the images")->delimiter(',');
}

/// Reads the lists, and looks at what several options say together.
std::string readWords(const Words& words, DatasetOptions& options) {
  std::string problem = choose("--content", words.content,
                               {{"depth", &options.depth},
                                {"normals", &options.normals},
                                {"labels", &options.labels},
                                {"flow", &options.flow},
                                {"particles", &options.particles},
                                {"sutures", &options.sutures}});
  if (problem.empty())
    problem = choose("--vary", words.varied,
                     {{"lens", &options.vary_lens},
                      {"sensor", &options.vary_sensor},
                      {"mucosa", &options.vary_mucosa},
                      {"light", &options.vary_light}});
  if (!problem.empty()) return problem;
  if (options.from > options.to) return "--from is later than --to; exchange them";
  if (!words.varied.empty() && options.seed == 0) return "--vary without --seed varies nothing; give a seed from 1 on";
  return "";
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
  const std::string problem = readWords(words, options);
  if (!problem.empty()) {
    std::fprintf(stderr, "vibe_dataset: %s (--help lists what there is)\n", problem.c_str());
    return kUsage;
  }
  options.round.lens = words.lens == "rectilinear" ? graphics::LensKind::Rectilinear : graphics::LensKind::Equidistant;
  options.round.field_of_view = words.degrees * graphics::kDegree;
  if (options.name.empty()) options.name = options.bag;
  vary(options);
  return -1;
}

}  // namespace vibe::endoscope
