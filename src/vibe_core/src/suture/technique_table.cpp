#include "vibe_core/suture/technique_table.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

#include "vibe_core/files/csv_row.hpp"
#include "vibe_core/files/number_text.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/suture/technique_patterns.hpp"

namespace vibe {

namespace {

using Fields = std::vector<std::string>;

class Reader {
 public:
  explicit Reader(const std::string& name) : name_(name) {}

  void take(std::string line) {
    if (++number_ == 1 && line.compare(0, 3, "\xef\xbb\xbf") == 0) line.erase(0, 3);  // byte order mark
    const bool blank = trimmed(line).empty();
    const std::string row(trimmed(line.substr(0, line.find('#'))));
    if (!row.empty()) return takeRow(cellsOf(row));
    if (blank && !sets_.empty() && !sets_.back().empty()) sets_.emplace_back();
  }

  std::vector<std::vector<Eigen::Vector3d>> finish() {
    if (!sets_.empty() && sets_.back().empty()) sets_.pop_back();
    if (sets_.empty()) throw Error(name_ + " holds no bite; give it a row x,y,z per bite.");
    return std::move(sets_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(name_ + ":" + std::to_string(number_) + ": " + what);
  }

  void takeRow(const Fields& fields) {
    const bool first = columns_.empty();
    if (first) {
      bool header = true;
      for (const std::string& field : fields)
        header = header && !field.empty() && std::isalpha(static_cast<unsigned char>(field[0])) != 0 &&
                 !numberOf(field);  // "nan" and "infinity" begin with letters
      column_count_ = header ? fields.size() : 3;
      columns_ = header ? namedColumns(fields) : std::vector<std::size_t>{0, 1, 2};
      if (header) return;
    }
    if (fields.size() != column_count_)
      fail("the row has " + std::to_string(fields.size()) + " columns instead of " + std::to_string(column_count_) +
           "; write x,y,z with commas between them.");
    if (sets_.empty()) sets_.emplace_back();
    sets_.back().push_back({number(fields, 0), number(fields, 1), number(fields, 2)});
  }

  std::vector<std::size_t> namedColumns(const Fields& names) const {
    std::vector<std::size_t> columns;
    for (const char axis : {'x', 'y', 'z'}) {
      std::size_t found = names.size();
      for (std::size_t k = names.size(); k-- > 0;) {
        const bool alone = names[k].size() == 1 || std::isalnum(static_cast<unsigned char>(names[k][1])) == 0;
        if (alone && std::tolower(static_cast<unsigned char>(names[k][0])) == axis) found = k;
      }
      if (found == names.size()) fail(std::string("the header names no column '") + axis + "'; name x, y and z.");
      columns.push_back(found);
    }
    return columns;
  }

  double number(const Fields& fields, std::size_t axis) const {
    const std::string& text = fields[columns_[axis]];
    const std::string where = std::string(1, "xyz"[axis]) + " '" + text.substr(0, 40) + "'";
    const std::optional<double> value = numberOf(text);
    if (!value) fail(where + " is not a number; write it like 0.012 or 1.2e-2.");
    if (!std::isfinite(*value)) fail(where + " is not finite; correct the position or leave the bite out.");
    return *value;
  }

  std::string name_;
  std::size_t number_ = 0;
  std::vector<std::size_t> columns_;  // of x, y and z; empty before the first row
  std::size_t column_count_ = 3;
  std::vector<std::vector<Eigen::Vector3d>> sets_;
};

}  // namespace

std::vector<std::vector<Eigen::Vector3d>> readTechniqueCsv(std::istream& in, const std::string& name) {
  Reader reader(name);
  for (std::string line; std::getline(in, line);) reader.take(std::move(line));
  if (in.bad()) throw Error(name + " could not be read to its end; check that it is a file that you may read.");
  return reader.finish();
}

namespace {

constexpr double kNoises[] = {0, 0.15};

bool sameAnswer(int a, int b, bool three_way) {
  const auto fold = [&](int t) { return three_way && t > static_cast<int>(Technique::Z) ? 0 : t; };
  return fold(a) == fold(b);
}

/// Per cent; never rounded up to 100.
std::string percent(double share) {
  return formatted("%.1f", share < 1 ? std::min(100 * share, 99.9) : 100.0);
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

double TechniqueTable::right(bool three_way, std::optional<int> bite_count) const {
  double right = 0, all = 0;
  for (int n = bite_count.value_or(kTableMinBites); n <= bite_count.value_or(kTableMaxBites); ++n)
    for (int from = 0; from < kTechniqueCount; ++from)
      for (int to = 0; to < kTechniqueCount; ++to) {
        const double answers = count[n - kTableMinBites][from][to];
        all += answers;
        if (sameAnswer(from, to, three_way)) right += answers;
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
