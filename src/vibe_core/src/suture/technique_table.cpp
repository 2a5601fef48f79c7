#include "vibe_core/suture/technique_table.hpp"

#include <algorithm>
#include <cstdio>

#include "vibe_core/suture/technique_patterns.hpp"

namespace vibe {
namespace {

constexpr double kNoises[] = {0, 0.15};

bool sameAnswer(int a, int b, bool three_way) {
  const auto fold = [&](int t) { return three_way && t > static_cast<int>(Technique::Z) ? 0 : t; };
  return fold(a) == fold(b);
}

/// Per cent; never rounded up to 100.
std::string percent(double share) {
  char text[16];
  std::snprintf(text, sizeof text, "%.1f", share < 1 ? std::min(100 * share, 99.9) : 100.0);
  return text;
}

const char* ruleName(TechniqueRule rule) {
  return rule == TechniqueRule::Printed ? "printed" : "corrected";
}

std::string summary(const TechniqueTable& table, TechniqueRule rule, double noise) {
  std::string text;
  for (const bool three_way : {true, false}) {
    if (!three_way && rule == TechniqueRule::Printed) continue;  // this rule distinguishes only three answers
    text += std::string("| ") + ruleName(rule) + " | " + percent(noise) + " | " + (three_way ? "3" : "6") + " |";
    for (int n = kTableMinBites; n <= kTableMaxBites; ++n) text += " " + percent(table.right(three_way, n)) + " |";
    text += " **" + percent(table.right(three_way)) + "** |\n";
  }
  return text;
}

std::string confusion(const TechniqueTable& table, TechniqueRule rule, double noise) {
  std::string text = std::string("\nRule ") + ruleName(rule) + ", noise " + percent(noise) +
                     " %: rows are what was drawn, columns what was recognised [%]\n\n| drawn |";
  const int columns = rule == TechniqueRule::Printed ? 3 : kTechniqueCount;
  for (int to = 0; to < columns; ++to) text += std::string(" ") + toString(static_cast<Technique>(to)) + " |";
  text += "\n|---|";
  for (int to = 0; to < columns; ++to) text += "---|";
  for (int from = 1; from < kTechniqueCount; ++from) {
    text += std::string("\n| ") + toString(static_cast<Technique>(from)) + " |";
    for (int to = 0; to < columns; ++to) {
      int sum = 0;
      for (const auto& by_bites : table.count) sum += by_bites[from][to];
      text += " " + percent(static_cast<double>(sum) / table.drawn(static_cast<Technique>(from))) + " |";
    }
  }
  return text + "\n";
}

}  // namespace

double TechniqueTable::right(bool three_way, int bite_count) const {
  double right = 0, all = 0;
  const auto& cell = count[bite_count - kTableMinBites];
  for (int from = 0; from < kTechniqueCount; ++from)
    for (int to = 0; to < kTechniqueCount; ++to) {
      all += cell[from][to];
      if (sameAnswer(from, to, three_way)) right += cell[from][to];
    }
  return all > 0 ? right / all : 0;
}

double TechniqueTable::right(bool three_way) const {
  double right = 0, all = 0;
  for (const auto& cell : count)
    for (int from = 0; from < kTechniqueCount; ++from)
      for (int to = 0; to < kTechniqueCount; ++to) {
        all += cell[from][to];
        if (sameAnswer(from, to, three_way)) right += cell[from][to];
      }
  return all > 0 ? right / all : 0;
}

int TechniqueTable::drawn(Technique technique) const {
  int sum = 0;
  for (const auto& cell : count)
    for (const int answers : cell[static_cast<int>(technique)]) sum += answers;
  return sum;
}

TechniqueTable measureTechnique(TechniqueRule rule, double noise, int per_cell, std::uint64_t seed) {
  TechniqueTable table;
  for (int n = kTableMinBites; n <= kTableMaxBites; ++n)
    for (int t = 1; t < kTechniqueCount; ++t) {
      const Technique technique = static_cast<Technique>(t);
      if (n < fewestBites(technique)) continue;
      for (int k = 0; k < per_cell; ++k) {
        const std::uint64_t own_seed = seed + 1000003ULL * static_cast<std::uint64_t>(k * 100 + n * 10 + t);
        const TechniquePattern pattern = drawTechniquePattern(technique, n, noise, own_seed);
        ++table.count[n - kTableMinBites][t][static_cast<int>(recogniseTechnique(pattern.bites, rule).technique)];
      }
    }
  return table;
}

std::string techniqueReport(int per_cell, std::uint64_t seed) {
  std::string head = "Right answers [%] by number of bites\n\n| rule | noise [%] | answers |";
  std::string line = "\n|---|---|---|", rows, tables;
  for (int n = kTableMinBites; n <= kTableMaxBites; ++n) head += " " + std::to_string(n) + " |", line += "---|";
  for (const TechniqueRule rule : {TechniqueRule::Corrected, TechniqueRule::Printed})
    for (const double noise : kNoises) {
      const TechniqueTable table = measureTechnique(rule, noise, per_cell, seed);
      rows += summary(table, rule, noise);
      tables += confusion(table, rule, noise);
    }
  return head + " all |" + line + "---|\n" + rows + tables;
}

}  // namespace vibe
