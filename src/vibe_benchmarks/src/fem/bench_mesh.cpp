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

namespace {

using Corner = std::array<int, 3>;

// corner paths 000 -> 111 of the six tetrahedra; odd permutations are reversed for positive orientation
constexpr int kPaths[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {1, 0, 2}, {0, 2, 1}, {2, 1, 0}};

std::vector<std::array<Corner, 4>> sixTets() {
  std::vector<std::array<Corner, 4>> tets;
  for (int p = 0; p < 6; ++p) {
    Corner a{0, 0, 0}, b = a;
    b[kPaths[p][0]] = 1;
    Corner c = b;
    c[kPaths[p][1]] = 1;
    const Corner d{1, 1, 1};
    tets.push_back(p < 3 ? std::array<Corner, 4>{a, b, c, d} : std::array<Corner, 4>{a, c, b, d});
  }
  return tets;
}

/// Corner tetrahedra at 000, 110, 101, 011 around a middle one, or the mirror image in x.
std::vector<std::array<Corner, 4>> fiveTets(bool mirrored) {
  std::vector<std::array<Corner, 4>> tets = {{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}},
                                             {{{1, 1, 0}, {0, 1, 0}, {1, 0, 0}, {1, 1, 1}}},
                                             {{{1, 0, 1}, {0, 0, 1}, {1, 1, 1}, {1, 0, 0}}},
                                             {{{0, 1, 1}, {1, 1, 1}, {0, 0, 1}, {0, 1, 0}}},
                                             {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 1, 1}}}};
  if (!mirrored) return tets;
  for (auto& tet : tets) {
    for (Corner& corner : tet) corner[0] = 1 - corner[0];
    std::swap(tet[1], tet[2]);
  }
  return tets;
}

void nameFaces(const std::array<int, 3>& cells, BenchMesh& mesh) {
  const char* const axes[3] = {"x", "y", "z"};
  int node = 0;
  for (int i = 0; i <= cells[0]; ++i) {
    for (int j = 0; j <= cells[1]; ++j) {
      for (int k = 0; k <= cells[2]; ++k, ++node) {
        const int at[3] = {i, j, k};
        for (int a = 0; a < 3; ++a) {
          if (at[a] == 0) mesh.sets[std::string(axes[a]) + "_min"].push_back(node);
          if (at[a] == cells[a]) mesh.sets[std::string(axes[a]) + "_max"].push_back(node);
        }
      }
    }
  }
}

}  // namespace

BenchMesh makeBox(const Eigen::Vector3d& origin, const Eigen::Vector3d& size, const std::array<int, 3>& cells,
                  int tets_per_cell) {
  if (size.minCoeff() <= 0 || *std::min_element(cells.begin(), cells.end()) < 1)
    throw Error("mesh.box: a side or a number of cells is not positive; give three of each above 0.");
  if (tets_per_cell != 5 && tets_per_cell != 6)
    throw Error("mesh.box.tets_per_cell: " + std::to_string(tets_per_cell) + " is not possible; write 5 or 6.");
  BenchMesh mesh;
  const auto index = [&](int i, int j, int k) { return (i * (cells[1] + 1) + j) * (cells[2] + 1) + k; };
  for (int i = 0; i <= cells[0]; ++i) {
    for (int j = 0; j <= cells[1]; ++j) {
      for (int k = 0; k <= cells[2]; ++k) {
        const Eigen::Vector3d part(double(i) / cells[0], double(j) / cells[1], double(k) / cells[2]);
        mesh.nodes.push_back(origin + part.cwiseProduct(size));
      }
    }
  }
  const auto six = sixTets(), even = fiveTets(false), odd = fiveTets(true);
  for (int i = 0; i < cells[0]; ++i) {
    for (int j = 0; j < cells[1]; ++j) {
      for (int k = 0; k < cells[2]; ++k) {
        const auto& pattern = tets_per_cell == 6 ? six : (i + j + k) % 2 == 0 ? even : odd;
        for (const auto& tet : pattern) {
          std::array<int, 4> nodes;
          for (int n = 0; n < 4; ++n) nodes[n] = index(i + tet[n][0], j + tet[n][1], k + tet[n][2]);
          mesh.tets.push_back(nodes);
        }
      }
    }
  }
  nameFaces(cells, mesh);
  return mesh;
}

void growSets(const std::vector<std::array<int, 2>>& middles, int before, BenchMesh& mesh) {
  for (auto& set : mesh.sets) {
    std::vector<char> inside(before, 0);
    for (const int node : set.second) inside[node] = 1;
    for (std::size_t m = 0; m < middles.size(); ++m)
      if (inside[middles[m][0]] != 0 && inside[middles[m][1]] != 0) set.second.push_back(before + static_cast<int>(m));
  }
}

BenchMesh refineTriangles(const BenchMesh& mesh, const Eigen::Vector3d& project) {
  BenchMesh fine = mesh;
  fine.triangles.clear();
  std::map<std::array<int, 2>, int> middle_of;
  std::vector<std::array<int, 2>> middles;
  const auto middle = [&](int a, int b) {
    const std::array<int, 2> side{std::min(a, b), std::max(a, b)};
    const auto [entry, is_new] = middle_of.emplace(side, static_cast<int>(fine.nodes.size()));
    if (is_new) {
      Eigen::Vector3d node = 0.5 * (mesh.nodes[a] + mesh.nodes[b]);
      if (project.norm() > 0) node /= node.cwiseQuotient(project).norm();
      fine.nodes.push_back(node);
      middles.push_back(side);
    }
    return entry->second;
  };
  for (const auto& t : mesh.triangles) {
    const int ab = middle(t[0], t[1]), bc = middle(t[1], t[2]), ca = middle(t[2], t[0]);
    fine.triangles.insert(fine.triangles.end(), {{t[0], ab, ca}, {ab, t[1], bc}, {ca, bc, t[2]}, {ab, bc, ca}});
  }
  growSets(middles, static_cast<int>(mesh.nodes.size()), fine);
  return fine;
}

}  // namespace vibe::benchmarks
