#include "geometry/surface_check.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iterator>
#include <numeric>
#include <tuple>
#include <utility>
#include <vector>

#include "vibe_core/files/number_text.hpp"
#include "vibe_core/geometry/triangle_tree.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe {

namespace {

constexpr double kFlattest = 1e-9;  // height of a triangle over its longest edge
constexpr double kThinnest =
    1e-6;  // volume over the cube of the largest side; 1e-4 for a tube 100 times as long as wide
constexpr double kFarthest = 1e100;  // coordinates beyond have volumes that are not finite, in any unit

/// A side of a triangle, under its undirected edge.
struct Side {
  int low, high;
  bool forward;  ///< runs from low to high
};

std::string place(const Eigen::Vector3d& p) {
  return formatted("(%.6g, %.6g, %.6g)", p.x(), p.y(), p.z());
}

std::string counted(int count, const char* one, const char* many) {
  return std::to_string(count) + " " + (count == 1 ? one : many);
}

/// Disjoint sets of vertices.
class Groups {
 public:
  explicit Groups(std::size_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0); }
  int find(int v) {
    while (parent_[v] != v) v = parent_[v] = parent_[parent_[v]];
    return v;
  }
  void join(int a, int b) { parent_[std::max(find(a), find(b))] = std::min(find(a), find(b)); }

 private:
  std::vector<int> parent_;
};

std::vector<Side> sortedSides(const SurfaceMesh& mesh) {
  std::vector<Side> sides;
  sides.reserve(mesh.triangles.size() * 3);
  for (const auto& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(t[k], t[(k + 1) % 3]);
      sides.push_back({low, high, t[k] == low});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.low, a.high, a.forward) < std::tie(b.low, b.high, b.forward);
  });
  return sides;
}

/// Calls visit(begin, end) for the sides of every edge.
void forEachEdge(const std::vector<Side>& sides, const std::function<void(std::size_t, std::size_t)>& visit) {
  for (std::size_t begin = 0; begin < sides.size();) {
    std::size_t end = begin + 1;
    while (end < sides.size() && sides[end].low == sides[begin].low && sides[end].high == sides[begin].high) ++end;
    visit(begin, end);
    begin = end;
  }
}

void checkAreas(const SurfaceMesh& mesh, const std::string& name) {
  int count = 0, first = -1;
  for (int k = static_cast<int>(mesh.triangles.size()) - 1; k >= 0; --k) {
    const auto& t = mesh.triangles[k];
    const Eigen::Vector3d ab = mesh.vertices[t[1]] - mesh.vertices[t[0]];
    const Eigen::Vector3d ac = mesh.vertices[t[2]] - mesh.vertices[t[0]];
    const double longest = std::max({ab.squaredNorm(), ac.squaredNorm(), (ac - ab).squaredNorm()});
    if (ab.cross(ac).norm() > kFlattest * longest) continue;
    ++count;
    first = k;
  }
  if (count == 0) return;
  throw Error(name + " has " + counted(count, "triangle", "triangles") + " without area, the first is number " +
              std::to_string(first) + " at " + place(mesh.vertices[mesh.triangles[first][0]]) +
              "; remove degenerate faces in the modelling program");
}

void checkManifoldEdges(const SurfaceMesh& mesh, const std::vector<Side>& sides, const std::string& name) {
  int count = 0;
  const Side* first = nullptr;
  forEachEdge(sides, [&](std::size_t begin, std::size_t end) {
    if (end - begin <= 2) return;
    if (count++ == 0) first = &sides[begin];
  });
  if (count == 0) return;
  throw Error(name + " has " + counted(count, "edge", "edges") + " with more than two triangles, the first at " +
              place(mesh.vertices[first->low]) + "; keep one closed sheet without inner walls or doubled faces");
}

void checkHoles(const SurfaceMesh& mesh, const std::vector<Side>& sides, const std::string& name) {
  Groups groups(mesh.vertices.size());
  std::vector<int> open;
  forEachEdge(sides, [&](std::size_t begin, std::size_t end) {
    if (end - begin != 1) return;
    groups.join(sides[begin].low, sides[begin].high);
    open.push_back(sides[begin].low);
  });
  if (open.empty()) return;
  std::vector<int> loops;
  loops.reserve(open.size());
  for (const int v : open) loops.push_back(groups.find(v));
  std::sort(loops.begin(), loops.end());
  loops.erase(std::unique(loops.begin(), loops.end()), loops.end());
  throw Error(name + " is not closed: it has " + counted(static_cast<int>(loops.size()), "hole", "holes") + " with " +
              counted(static_cast<int>(open.size()), "open edge", "open edges") + ", the first at " +
              place(mesh.vertices[loops.front()]) +
              "; fill the holes, or merge the vertices along seams, in the modelling program");
}

void checkOrientation(const SurfaceMesh& mesh, const std::vector<Side>& sides, const std::string& name) {
  int count = 0, first = -1;
  forEachEdge(sides, [&](std::size_t begin, std::size_t end) {
    if (end - begin != 2 || sides[begin].forward != sides[begin + 1].forward) return;
    if (count++ == 0) first = sides[begin].low;
  });
  if (count == 0) return;
  throw Error(name + " has " + counted(count, "edge", "edges") +
              " between triangles that face opposite sides, the first at " + place(mesh.vertices[first]) +
              "; make the orientation of the faces consistent");
}

/// Two triangles on the same three vertices close each other's edges but enclose nothing.
void checkPockets(const SurfaceMesh& mesh, const std::string& name) {
  std::vector<std::pair<std::array<int, 3>, int>> faces;
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    std::array<int, 3> corners{mesh.triangles[t][0], mesh.triangles[t][1], mesh.triangles[t][2]};
    std::sort(corners.begin(), corners.end());
    faces.emplace_back(corners, t);
  }
  std::sort(faces.begin(), faces.end());
  const auto same =
      std::adjacent_find(faces.begin(), faces.end(), [](const auto& a, const auto& b) { return a.first == b.first; });
  if (same == faces.end()) return;
  throw Error(name + " has two triangles back to back, numbers " + std::to_string(same->second) + " and " +
              std::to_string(std::next(same)->second) + " at " + place(mesh.vertices[same->first[0]]) +
              "; remove both, or keep one closed sheet with a volume");
}

/// In a mesh with closed edges, a vertex where two sheets touch has more than one fan of triangles.
void checkManifoldVertices(const SurfaceMesh& mesh, const std::string& name) {
  std::vector<std::vector<int>> around(mesh.vertices.size());
  for (int t = 0; t < static_cast<int>(mesh.triangles.size()); ++t) {
    for (const int v : mesh.triangles[t]) around[v].push_back(t);
  }
  for (std::size_t v = 0; v < around.size(); ++v) {
    if (around[v].empty()) continue;
    const auto next = [&](int from) {
      for (const int number : around[v]) {
        const auto& t = mesh.triangles[number];
        for (int k = 0; k < 3; ++k) {
          if (t[k] == static_cast<int>(v) && t[(k + 1) % 3] == from) return t[(k + 2) % 3];
        }
      }
      return -1;
    };
    const auto& t = mesh.triangles[around[v][0]];
    const int start = t[0] == static_cast<int>(v) ? t[1] : t[1] == static_cast<int>(v) ? t[2] : t[0];
    std::size_t fan = 1;
    for (int at = next(start); at != start && at >= 0 && fan <= around[v].size(); at = next(at)) ++fan;
    if (fan == around[v].size()) continue;
    throw Error(name + " touches itself at vertex " + std::to_string(v) + " at " + place(mesh.vertices[v]) +
                "; separate the sheets that meet in this point");
  }
}

void checkOnePart(const SurfaceMesh& mesh, const std::string& name) {
  Groups groups(mesh.vertices.size());
  for (const auto& t : mesh.triangles) {
    groups.join(t[0], t[1]);
    groups.join(t[1], t[2]);
  }
  std::vector<int> size(mesh.vertices.size(), 0), sizes;
  for (const auto& t : mesh.triangles) ++size[groups.find(t[0])];
  std::copy_if(size.begin(), size.end(), std::back_inserter(sizes), [](int s) { return s > 0; });
  if (sizes.size() <= 1) return;
  std::sort(sizes.rbegin(), sizes.rend());
  std::string list;
  for (std::size_t k = 0; k < std::min<std::size_t>(sizes.size(), 5); ++k) {
    list += (k > 0 ? ", " : "") + std::to_string(sizes[k]);
  }
  throw Error(name + " has " + std::to_string(sizes.size()) + " separate parts (with " + list +
              (sizes.size() > 5 ? " ..." : "") + " triangles); keep the one that is the organ's wall");
}

void checkHandles(const SurfaceMesh& mesh, const std::vector<Side>& sides, const std::string& name) {
  std::vector<bool> used(mesh.vertices.size(), false);
  for (const auto& t : mesh.triangles) {
    for (const int v : t) used[v] = true;
  }
  const auto vertices = std::count(used.begin(), used.end(), true);
  const auto euler = vertices - static_cast<long>(sides.size() / 2) + static_cast<long>(mesh.triangles.size());
  if (euler == 2) return;
  throw Error(name + " has " + counted(static_cast<int>((2 - euler) / 2), "handle", "handles") +
              " like a ring, but an organ's wall is shaped like a sphere; cut the handles and close the cuts");
}

void checkCrossings(const SurfaceMesh& mesh, const std::string& name) {
  const auto [a, b] = findSelfIntersection(TriangleTree(mesh));
  if (a < 0) return;
  throw Error(name + " passes through itself: triangles " + std::to_string(a) + " and " + std::to_string(b) +
              " cross near " + place(mesh.vertices[mesh.triangles[a][0]]) + "; move the sheets apart");
}

/// A surface without thickness is closed, and two sheets that coincide do not cross.
void checkVolume(const SurfaceMesh& mesh, const std::string& name) {
  Eigen::AlignedBox3d box;
  for (const auto& t : mesh.triangles)
    for (const int v : t) box.extend(mesh.vertices[v]);
  const double side = box.sizes().maxCoeff(), volume = std::abs(enclosedVolume(mesh));
  if (volume > kThinnest * side * side * side) return;
  const std::string sizes = formatted("%.3g cubic units, with a largest side of %.4g units", volume, side);
  throw Error(name + " encloses next to nothing, " + sizes +
              "; it may have been flattened, as by a scale of 0: give it its thickness back");
}

}  // namespace

void checkNumbers(const SurfaceMesh& mesh, const std::string& name) {
  if (mesh.triangles.empty())
    throw Error(name + " has no faces, only points or lines, or nothing; export the surface with its faces");
  const int vertices = static_cast<int>(mesh.vertices.size());
  for (std::size_t k = 0; k < mesh.triangles.size(); ++k) {
    for (const int v : mesh.triangles[k]) {
      if (v >= 0 && v < vertices) continue;
      throw Error(name + " has a triangle (number " + std::to_string(k) + ") with vertex " + std::to_string(v) +
                  ", but only " + std::to_string(vertices) + " vertices; write the file anew");
    }
  }
  const auto finite = [](const Eigen::Vector3d& p) { return p.allFinite() && p.cwiseAbs().maxCoeff() < kFarthest; };
  std::vector<bool> bad(mesh.vertices.size(), false);
  for (const auto& t : mesh.triangles)
    for (const int v : t) bad[v] = !finite(mesh.vertices[v]);
  const auto first = std::find(bad.begin(), bad.end(), true);
  if (first == bad.end()) return;
  const auto count = static_cast<int>(std::count(bad.begin(), bad.end(), true));
  throw Error(name + " has " + counted(count, "vertex", "vertices") +
              " whose position is not a finite number below 1e100, the first is number " +
              std::to_string(first - bad.begin()) + " (counted from 0); correct the positions, or write the file anew");
}

void checkSurface(const SurfaceMesh& mesh, const std::string& name) {
  checkNumbers(mesh, name);
  checkAreas(mesh, name);
  const std::vector<Side> sides = sortedSides(mesh);
  checkManifoldEdges(mesh, sides, name);
  checkPockets(mesh, name);
  checkHoles(mesh, sides, name);
  checkOrientation(mesh, sides, name);
  checkManifoldVertices(mesh, name);
  checkOnePart(mesh, name);
  checkHandles(mesh, sides, name);
  checkCrossings(mesh, name);
  checkVolume(mesh, name);
}

bool orientOutwards(SurfaceMesh& mesh) {
  if (enclosedVolume(mesh) >= 0.0) return false;
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  return true;
}

}  // namespace vibe
