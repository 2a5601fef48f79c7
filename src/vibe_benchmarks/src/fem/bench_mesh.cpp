#include "fem/bench_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

#include "vibe_core/program/error.hpp"
#include "vibe_core/scene/unit.hpp"
#include "vibe_core/scene/words.hpp"

namespace vibe::benchmarks {
namespace {

std::string placeOf(const std::string& file, int line) {
  return file + ":" + std::to_string(line) + ": ";
}

/// Calls `take(words, line)` for every line that is neither empty nor a comment.
template <class Take>
void readLines(const std::string& file, const Take& take) {
  std::ifstream stream(file);
  if (!stream) throw Error(file + ": cannot be opened; give the path of a readable text file of the mesh.");
  std::string text;
  for (int line = 1; std::getline(stream, text); ++line) {
    if (!text.empty() && text.back() == '\r') text.pop_back();
    if (text.empty() || text[0] == '#') continue;
    take(text, line);
  }
}

std::vector<std::string> words(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> found;
  for (std::string word; stream >> word;) found.push_back(word);
  return found;
}

double number(const std::string& word, const std::string& place) {
  const Quantity value = parseNumber(word);
  if (!value.problem.empty()) throw Error(place + "'" + word.substr(0, 40) + "' is no number; write a finite one.");
  return value.value;
}

int nodeNumber(const std::string& word, int node_count, const std::string& place) {
  const double value = number(word, place);
  if (value != std::floor(value) || value < 0 || value >= node_count)
    throw Error(place + "'" + word + "' is no node; write a number from 0 to " + std::to_string(node_count - 1) + ".");
  return static_cast<int>(value);
}

}  // namespace

std::vector<Eigen::Vector3d> readNodes(const std::string& file) {
  std::vector<Eigen::Vector3d> nodes;
  readLines(file, [&](const std::string& text, int line) {
    const auto entries = words(text);
    if (entries.size() != 3) throw Error(placeOf(file, line) + "has not three numbers; write 'x y z' in metres.");
    Eigen::Vector3d node;
    for (int k = 0; k < 3; ++k) node[k] = number(entries[k], placeOf(file, line));
    nodes.push_back(node);
  });
  if (nodes.empty()) throw Error(file + ": has no node; write 'x y z' lines.");
  return nodes;
}

std::vector<int> readElements(const std::string& file, int size, int node_count) {
  std::vector<int> numbers;
  readLines(file, [&](const std::string& text, int line) {
    const auto entries = words(text);
    if (static_cast<int>(entries.size()) != size) {
      throw Error(placeOf(file, line) + "has " + std::to_string(entries.size()) + " numbers; write the " +
                  std::to_string(size) + " nodes of one element.");
    }
    for (const std::string& entry : entries) numbers.push_back(nodeNumber(entry, node_count, placeOf(file, line)));
  });
  if (numbers.empty()) throw Error(file + ": has no element; write lines of node numbers.");
  return numbers;
}

std::map<std::string, std::vector<int>> readSets(const std::string& file, int node_count) {
  std::map<std::string, std::vector<int>> sets;
  readLines(file, [&](const std::string& text, int line) {
    const auto colon = text.find(':');
    if (colon == std::string::npos || colon == 0)
      throw Error(placeOf(file, line) + "has no name; write 'name: node numbers'.");
    std::vector<int> nodes;
    for (const std::string& entry : words(text.substr(colon + 1)))
      nodes.push_back(nodeNumber(entry, node_count, placeOf(file, line)));
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    if (!sets.emplace(text.substr(0, colon), nodes).second)
      throw Error(placeOf(file, line) + "repeats the set '" + text.substr(0, colon) + "'; keep one of the two.");
  });
  return sets;
}

int NumberTable::column(const std::string& name) const {
  const auto found = std::find(columns.begin(), columns.end(), name);
  if (found == columns.end()) throw Error(file + ": has no column '" + name + "'; " + suggestKey(name, columns));
  return static_cast<int>(found - columns.begin());
}

NumberTable readTable(const std::string& file) {
  NumberTable table;
  table.file = file;
  readLines(file, [&](const std::string& text, int line) {
    std::vector<std::string> entries(1);
    for (const char c : text) {
      if (c == ',')
        entries.emplace_back();
      else
        entries.back() += c;
    }
    if (table.columns.empty()) {
      table.columns = entries;
      return;
    }
    if (entries.size() != table.columns.size())
      throw Error(placeOf(file, line) + "has another number of entries than the first line; make them equal.");
    std::vector<double> row;
    for (const std::string& entry : entries)
      row.push_back(entry.empty() ? std::numeric_limits<double>::quiet_NaN() : number(entry, placeOf(file, line)));
    table.rows.push_back(row);
  });
  if (table.rows.empty()) throw Error(file + ": has no row of numbers; write a header and rows.");
  return table;
}

}  // namespace vibe::benchmarks
