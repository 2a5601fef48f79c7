#include "fem/bench_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <numeric>
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

constexpr int kFewest = 5;  // nodes of a ring

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

/// eta (from one pole to the other) at equal steps of the arc length of the ellipse; the total length comes last.
std::vector<double> equalSteps(double radius, double half_length, int rings) {
  constexpr int kFine = 20000;
  const double pi = std::acos(-1.0);
  std::vector<double> length(kFine + 1, 0.0);
  for (int i = 1; i <= kFine; ++i) {
    const double eta = pi * (i - 0.5) / kFine;
    length[i] = length[i - 1] + std::hypot(radius * std::cos(eta), half_length * std::sin(eta)) * pi / kFine;
  }
  std::vector<double> eta;
  for (int r = 0, i = 0; r < rings; ++r) {
    const double wanted = length[kFine] * (r + 1) / (rings + 1);
    while (length[i + 1] < wanted) ++i;
    eta.push_back(pi * (i + (wanted - length[i]) / (length[i + 1] - length[i])) / kFine);
  }
  eta.push_back(length[kFine]);
  return eta;
}

/// Number of nodes of each ring, proportional to its circumference, that add up to `nodes`.
std::vector<int> ringCounts(const std::vector<double>& circumference, int nodes) {
  const double total = std::accumulate(circumference.begin(), circumference.end(), 0.0);
  std::vector<int> count;
  for (const double c : circumference)
    count.push_back(std::max(kFewest, static_cast<int>(std::lround(c / total * nodes))));
  int missing = nodes - std::accumulate(count.begin(), count.end(), 0);
  // the longest rings are the least sensitive to one node more or less
  std::vector<int> order(count.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return circumference[a] > circumference[b]; });
  for (std::size_t k = 0; missing != 0; k = (k + 1) % order.size()) {
    if (missing < 0 && count[order[k]] <= kFewest) continue;
    count[order[k]] += missing > 0 ? 1 : -1;
    missing += missing > 0 ? -1 : 1;
  }
  return count;
}

/// Triangles between two rings of consecutive nodes; each step takes the shorter of the two possible sides.
void stitch(int first, int first_count, int second, int second_count, BenchMesh& mesh) {
  const auto a = [&](int i) { return first + i % first_count; };
  const auto b = [&](int i) { return second + i % second_count; };
  int start = 0;  // the node of the second ring nearest to the first node of the first ring
  for (int j = 1; j < second_count; ++j) {
    if ((mesh.nodes[b(j)] - mesh.nodes[a(0)]).norm() < (mesh.nodes[b(start)] - mesh.nodes[a(0)]).norm()) start = j;
  }
  for (int i = 0, j = 0; i < first_count || j < second_count;) {
    const double along = (mesh.nodes[a(i + 1)] - mesh.nodes[b(start + j)]).norm();
    const double across = (mesh.nodes[a(i)] - mesh.nodes[b(start + j + 1)]).norm();
    if (j == second_count || (i < first_count && along < across)) {
      mesh.triangles.push_back({a(i), b(start + j), a(i + 1)});
      ++i;
    } else {
      mesh.triangles.push_back({a(i), b(start + j), b(start + j + 1)});
      ++j;
    }
  }
}

void addRing(double radius, double z, int count, bool shifted, BenchMesh& mesh) {
  const double pi = std::acos(-1.0);
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * pi * (i + (shifted ? 0.5 : 0.0)) / count;
    mesh.nodes.emplace_back(radius * std::cos(angle), radius * std::sin(angle), z);
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

BenchMesh makeEllipsoid(double radius, double half_length, int nodes) {
  if (nodes < 14) throw Error("mesh.ellipsoid.nodes: " + std::to_string(nodes) + " is too few; give at least 14.");
  if (!(radius > 0) || !(half_length > 0))
    throw Error("mesh.ellipsoid: a semi-axis is not positive; give both in metres.");
  const double pi = std::acos(-1.0);
  // edge length of equilateral triangles on the surface: area / nodes = edge^2 sqrt(3)/2
  double area = 0;
  for (int i = 0; i < 2000; ++i) {
    const double eta = pi * (i + 0.5) / 2000;
    area +=
        2 * pi * radius * std::sin(eta) * std::hypot(radius * std::cos(eta), half_length * std::sin(eta)) * pi / 2000;
  }
  const double edge = std::sqrt(area / nodes / std::sqrt(0.75));
  const double length = equalSteps(radius, half_length, 1).back();
  const int wanted_rings = static_cast<int>(std::lround(length / (edge * std::sqrt(0.75)))) - 1;
  const int rings = std::clamp(wanted_rings, 2, (nodes - 2) / kFewest);
  const auto eta = equalSteps(radius, half_length, rings);
  std::vector<double> circumference;
  for (int r = 0; r < rings; ++r) circumference.push_back(2 * pi * radius * std::sin(eta[r]));
  const auto count = ringCounts(circumference, nodes - 2);

  BenchMesh mesh;
  mesh.nodes.emplace_back(0, 0, half_length);
  std::vector<int> first;
  for (int r = 0; r < rings; ++r) {
    first.push_back(static_cast<int>(mesh.nodes.size()));
    addRing(radius * std::sin(eta[r]), half_length * std::cos(eta[r]), count[r], r % 2 == 1, mesh);
  }
  mesh.nodes.emplace_back(0, 0, -half_length);
  const int last = static_cast<int>(mesh.nodes.size()) - 1;
  for (int i = 0; i < count[0]; ++i) mesh.triangles.push_back({0, first[0] + i, first[0] + (i + 1) % count[0]});
  for (int r = 0; r + 1 < rings; ++r) stitch(first[r], count[r], first[r + 1], count[r + 1], mesh);
  const int end = first[rings - 1], end_count = count[rings - 1];
  for (int i = 0; i < end_count; ++i) mesh.triangles.push_back({end + i, last, end + (i + 1) % end_count});
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
