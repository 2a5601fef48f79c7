// Says which suture techniques the bites in a file are, for logs of any simulator or tracker.
#include <getopt.h>

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include "vibe_core/common/error.hpp"
#include "vibe_core/suture/technique.hpp"
#include "vibe_core/suture/technique_csv.hpp"
#include "vibe_core/suture/technique_table.hpp"

namespace {

using namespace vibe;

const char kHelp[] =
    "usage: vibe_technique [options] FILE.csv\n"
    "Says which technique each suture set of a file is: u, z, triangular, square, running, c or other.\n"
    "FILE has a row x,y,z per bite, in the order the bites were made and in any unit of length, and a blank line\n"
    "between sets; '#' begins a comment, the first row may be a header. '-' reads standard input.\n"
    "Prints set,bites,technique,margin; margin is 0 (could be another technique) to 1. Ends with 2 on bad input.\n"
    "  --rule RULE   corrected (default) or printed (equations 1 to 4 of the ViBE paper: u, z or other)\n"
    "  --table [N]   instead of reading a file, measure both rules on N drawn patterns per technique and number of\n"
    "                bites (default 500) and print the tables\n"
    "  --seed N      of the patterns of --table (default 1)\n"
    "  --help        this text\n";

struct Options {
  std::string file;
  TechniqueRule rule = TechniqueRule::Corrected;
  int table = 0;  // patterns per cell; 0: read a file
  std::uint64_t seed = 1;
};

long toWhole(const std::string& option, const std::string& text, long max) {
  char* end = nullptr;
  const long value = std::strtol(text.c_str(), &end, 10);
  if (text.empty() || *end != '\0' || value < 1 || value > max)
    throw Error("--" + option + " '" + text + "' is no whole number from 1 to " + std::to_string(max) +
                "; see --help.");
  return value;
}

TechniqueRule toRule(const std::string& text) {
  if (text == "corrected") return TechniqueRule::Corrected;
  if (text == "printed") return TechniqueRule::Printed;
  throw Error("--rule '" + text + "' is unknown; write corrected or printed.");
}

Options parse(int argc, char** argv) {
  static const option kOptions[] = {{"rule", 1, nullptr, 'r'},
                                    {"table", 2, nullptr, 't'},
                                    {"seed", 1, nullptr, 's'},
                                    {"help", 0, nullptr, 'h'},
                                    {nullptr, 0, nullptr, 0}};
  Options o;
  opterr = 0;
  for (int c; (c = getopt_long(argc, argv, "", kOptions, nullptr)) != -1;) {
    const std::string value = optarg == nullptr ? "" : optarg;
    if (c == 'r') {
      o.rule = toRule(value);
    } else if (c == 't') {
      const bool apart = optarg == nullptr && optind < argc && argv[optind][0] != '-';
      o.table = static_cast<int>(toWhole("table", apart ? argv[optind++] : optarg == nullptr ? "500" : value, 100000));
    } else if (c == 's') {
      o.seed = static_cast<std::uint64_t>(toWhole("seed", value, 1000000000));
    } else if (c == 'h') {
      std::cout << kHelp;
      std::exit(0);
    } else {
      throw Error("Option '" + std::string(argv[optind - 1]) + "' is unknown or lacks its value; see --help.");
    }
  }
  if (o.table > 0 && optind < argc)
    throw Error("--table reads no file, but '" + std::string(argv[optind]) + "' is named; leave out one.");
  if (o.table == 0 && optind + 1 != argc)
    throw Error("Name one file (or '-' for standard input), not " + std::to_string(argc - optind) + "; see --help.");
  if (o.table == 0) o.file = argv[optind];
  return o;
}

std::vector<std::vector<Eigen::Vector3d>> read(const std::string& file) {
  if (file == "-") return readTechniqueCsv(std::cin, "standard input");
  std::ifstream in(file);
  if (!in) throw Error(file + " cannot be opened (" + std::strerror(errno) + "); check its name.");
  return readTechniqueCsv(in, file);
}

void run(const Options& o) {
  if (o.table > 0) {
    std::cout << techniqueReport(o.table, o.seed);
    return;
  }
  const auto sets = read(o.file);  // before anything is printed: bad input prints nothing else
  std::printf("set,bites,technique,margin\n");
  int number = 0;
  for (const auto& bites : sets) {
    const TechniqueResult result = recogniseTechnique(bites, o.rule);
    std::printf("%d,%zu,%s,%.3f\n", ++number, bites.size(), toString(result.technique), result.margin);
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    run(parse(argc, argv));
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "vibe_technique: %s\n", error.what());
    return 2;
  }
}
