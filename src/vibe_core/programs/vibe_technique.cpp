// Says which suture techniques the bites in a file are, for logs of any simulator or tracker.
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include "vibe_core/program/command_line.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/suture/technique.hpp"
#include "vibe_core/suture/technique_table.hpp"

namespace {

using namespace vibe;

const char kAbout[] =
    "Prints which technique each suture set of a file is: u, z, triangular, square, running, c or other.\n"
    "FILE has a row x,y,z per bite, in the order of the bites and in any unit of length, and a blank line between\n"
    "sets; '#' begins a comment, and the first row may be a header. '-' reads standard input.\n"
    "The columns of the output are set,bites,technique,margin; the margin is 0 (could be another technique) to 1.\n"
    "The exit status is 2 on bad input.";

struct Options {
  std::vector<std::string> files;
  std::string rule = "corrected";
  int table = 0;  // patterns per cell; 0: read a file
  std::uint64_t seed = 1;
};

void addOptions(OptionList& line, Options& o) {
  line.option("FILE", o.files, "bites (CSV)").typeName("");
  line.option("--rule", o.rule, "corrected (default) or printed (equations 1 to 4 of the ViBE paper: u, z or other)")
      .typeName("RULE")
      .check(oneOf({"corrected", "printed"}).hidden());
  line.option("--table", o.table,
              "instead of reading a file, measure both rules on N random patterns per technique and number of bites")
      .typeName("[N]")
      .expected(0, 1)
      .withoutValue("500")
      .check(wholeFrom(1, 100000));
  line.option("--seed", o.seed, "seed of the patterns of --table (default: 1)")
      .typeName("N")
      .check(wholeFrom(1, 1000000000));
}

void checkFiles(const Options& o) {
  if (o.table > 0 && !o.files.empty())
    throw Error("--table reads no file, but '" + o.files.front() + "' is named; leave out one.");
  if (o.table == 0 && o.files.size() != 1)
    throw Error("Name one file (or '-' for standard input), not " + std::to_string(o.files.size()) + "; see --help.");
}

std::vector<std::vector<Eigen::Vector3d>> read(const std::string& file) {
  if (file == "-") return readTechniqueCsv(std::cin, "standard input");
  std::ifstream in(file);
  if (!in) throw Error(file + " cannot be opened (" + std::strerror(errno) + "); check its name.");
  return readTechniqueCsv(in, file);
}

void run(const Options& o) {
  checkFiles(o);
  if (o.table > 0) {
    std::cout << techniqueReport(o.table, o.seed);
    return;
  }
  const auto sets = read(o.files.front());  // before anything is printed: bad input prints nothing else
  const TechniqueRule rule = o.rule == "printed" ? TechniqueRule::Printed : TechniqueRule::Corrected;
  std::printf("set,bites,technique,margin\n");
  int number = 0;
  for (const auto& bites : sets) {
    const TechniqueResult result = recogniseTechnique(bites, rule);
    std::printf("%d,%zu,%s,%.3f\n", ++number, bites.size(), toString(result.technique), result.margin);
  }
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CommandLine line{kAbout, "vibe_technique"};
  addOptions(line, options);
  return runProgram(line, argc, argv, [&] { run(options); });
}
