// Speed beside error: every method and setting on one scenario, and cases with reference solutions.
#include <dirent.h>
#include <getopt.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include "fem/case_runner.hpp"
#include "fem/fem_case.hpp"
#include "method/method_table.hpp"
#include "output/result_row.hpp"
#include "pulling/pulling_table.hpp"
#include "vibe_core/common/error.hpp"
#include "vibe_core/common/package_path.hpp"

namespace {

using namespace vibe;

const char kHelp[] =
    "usage: vibe_bench [options]\n"
    "Prints time per step beside errors, for every method and setting and for cases with reference solutions.\n"
    "  --case FILE...   only these cases (YAML), no method table\n"
    "  --methods        only the method table\n"
    "  --pulling        only the ways of pulling two bites together\n"
    "  --profile FILE   with --pulling: write the mid-line of each way there (CSV)\n"
    "  --quick          fewer repeats and sizes: about 50 seconds\n"
    "  --csv FILE       write the rows there (- for standard output)\n"
    "  --list           names the shipped cases and ends\n"
    "  --help           this text\n";

struct Options {
  std::vector<std::string> cases;
  std::string csv, profile;
  bool quick = false, list = false, methods_only = false, pulling_only = false;
};

Options parse(int argc, char** argv) {
  static const option kOptions[] = {{"case", required_argument, nullptr, 'c'},
                                    {"quick", no_argument, nullptr, 'q'},
                                    {"csv", required_argument, nullptr, 'o'},
                                    {"list", no_argument, nullptr, 'l'},
                                    {"methods", no_argument, nullptr, 'm'},
                                    {"pulling", no_argument, nullptr, 'p'},
                                    {"profile", required_argument, nullptr, 'f'},
                                    {"help", no_argument, nullptr, 'h'},
                                    {nullptr, 0, nullptr, 0}};
  Options options;
  for (int c; (c = getopt_long(argc, argv, "", kOptions, nullptr)) != -1;) {
    if (c == 'p') options.pulling_only = true;
    if (c == 'f') options.profile = optarg;
    if (c == 'm') options.methods_only = true;
    if (c == 'c') options.cases.push_back(optarg);
    if (c == 'o') options.csv = optarg;
    if (c == 'q') options.quick = true;
    if (c == 'l') options.list = true;
    if (c == 'h') {
      std::cout << kHelp;
      std::exit(0);
    }
    if (c == '?') throw Error("vibe_bench: unknown option; see --help.");
  }
  // more files may follow the first of --case
  for (int i = optind; i < argc; ++i) {
    if (options.cases.empty()) throw Error("vibe_bench: '" + std::string(argv[i]) + "' is no option; see --help.");
    options.cases.push_back(argv[i]);
  }
  return options;
}

std::vector<std::string> shippedCases() {
  const std::string folder = resolveAddress("package://vibe_benchmarks/cases");
  std::vector<std::string> files;
  DIR* const listing = opendir(folder.c_str());
  if (listing == nullptr) throw Error(folder + ": cannot be read; is vibe_sim installed completely?");
  while (const dirent* entry = readdir(listing)) {
    const std::string name = entry->d_name;
    if (name.size() > 5 && name.substr(name.size() - 5) == ".yaml") files.push_back(folder + "/" + name);
  }
  closedir(listing);
  std::sort(files.begin(), files.end());
  return files;
}

void writeRows(const std::string& file, const std::vector<ResultRow>& rows) {
  if (file == "-") return writeCsv(rows, std::cout);
  std::ofstream out(file);
  writeCsv(rows, out);
  out.close();
  if (!out) throw Error(file + ": cannot be written; give --csv a path in a writable folder.");
}

int run(int argc, char** argv) {
  const Options options = parse(argc, argv);
  if (options.pulling_only) {
    const std::vector<ResultRow> ways = runPulling(options.profile, std::cerr);
    printTable(ways, std::cerr);
    if (!options.csv.empty()) writeRows(options.csv, ways);
    return 0;
  }
  std::vector<std::string> files = options.cases;
  if (files.empty() && !options.methods_only) files = shippedCases();
  if (options.list) {
    for (const std::string& file : files) std::cout << file << "\n";
    return 0;
  }
  std::vector<ResultRow> rows;
  if (options.cases.empty()) rows = runMethods(options.quick, std::cerr);
  for (const std::string& file : files) {
    const FemCase bench_case = readCase(file);
    if (options.quick && options.cases.empty() && bench_case.slow) continue;
    const auto more = runCase(bench_case, std::cerr);
    rows.insert(rows.end(), more.begin(), more.end());
  }
  printTable(rows, std::cerr);
  if (!options.csv.empty()) writeRows(options.csv, rows);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 2;
  }
}
