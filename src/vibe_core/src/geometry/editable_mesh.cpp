#include "geometry/remesh.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "geometry/triangle_distance.hpp"

namespace vibe {

namespace {

constexpr int kMinValence = 4;
constexpr int kMaxValence = 9;

Eigen::Vector3d cross3(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c) {
  return (b - a).cross(c - a);
}

/// Whether the angle between the two area vectors is below 60 degrees.
bool sameSide(const Eigen::Vector3d& before, const Eigen::Vector3d& after) {
  return before.dot(after) > 0.5 * before.norm() * after.norm();
}

}  // namespace

EditableMesh::EditableMesh(const SurfaceMesh& mesh)
    : positions_(mesh.vertices), triangles_(mesh.triangles), around_(mesh.vertices.size()) {
  for (int t = 0; t < static_cast<int>(triangles_.size()); ++t) {
    for (const int v : triangles_[t]) around_[v].push_back(t);
  }
  for (const auto& list : around_) alive_count_ += list.empty() ? 0 : 1;
}

std::vector<EditableMesh::Edge> EditableMesh::edges() const {
  std::vector<Edge> list;
  list.reserve(triangles_.size() * 3 / 2);
  for (const auto& t : triangles_) {
    if (t[0] < 0) continue;
    for (int k = 0; k < 3; ++k) {
      if (t[k] < t[(k + 1) % 3]) list.emplace_back(t[k], t[(k + 1) % 3]);  // the other triangle has the edge in reverse
    }
  }
  std::sort(list.begin(), list.end());
  return list;
}

std::array<int, 2> EditableMesh::trianglesOf(int a, int b) const {
  std::array<int, 2> found{-1, -1};
  for (const int number : around_[a]) {
    const auto& t = triangles_[number];
    for (int k = 0; k < 3; ++k) {
      if (t[k] == a && t[(k + 1) % 3] == b) found[0] = number;
      if (t[k] == b && t[(k + 1) % 3] == a) found[1] = number;
    }
  }
  return found;
}

bool EditableMesh::isEdge(int a, int b) const {
  return std::any_of(around_[a].begin(), around_[a].end(),
                     [&](int number) { return hasVertex(triangles_[number], b); });
}

std::array<int, 2> EditableMesh::wings(int a, int b) const {
  const auto sides = trianglesOf(a, b);
  std::array<int, 2> opposite{-1, -1};
  for (int s = 0; s < 2; ++s) {
    if (sides[s] < 0) continue;
    for (const int v : triangles_[sides[s]]) {
      if (v != a && v != b) opposite[s] = v;
    }
  }
  return opposite;
}

Eigen::Vector3d EditableMesh::areaVector(int triangle) const {
  const auto& t = triangles_[triangle];
  return cross3(positions_[t[0]], positions_[t[1]], positions_[t[2]]);
}

void EditableMesh::addTriangle(int a, int b, int c) {
  const int number = static_cast<int>(triangles_.size());
  triangles_.push_back({a, b, c});
  for (const int v : {a, b, c}) around_[v].push_back(number);
}

void EditableMesh::removeFrom(int vertex, int triangle) {
  auto& list = around_[vertex];
  list.erase(std::find(list.begin(), list.end(), triangle));
}

void EditableMesh::replaceVertex(int triangle, int from, int to) {
  for (int& v : triangles_[triangle]) {
    if (v == from) v = to;
  }
  removeFrom(from, triangle);
  around_[to].push_back(triangle);
}

int EditableMesh::split(int a, int b, const Eigen::Vector3d& position) {
  const auto sides = trianglesOf(a, b);
  const auto opposite = wings(a, b);
  const int middle = static_cast<int>(positions_.size());
  positions_.push_back(position);
  around_.emplace_back();
  ++alive_count_;
  // both triangles keep a; their halves at b are new
  for (const int side : sides) replaceVertex(side, b, middle);
  addTriangle(middle, b, opposite[0]);
  addTriangle(b, middle, opposite[1]);
  return middle;
}

bool EditableMesh::staysUpright(int moved, int other, const Eigen::Vector3d& position, double longest) const {
  for (const int number : around_[moved]) {
    const auto& t = triangles_[number];
    if (hasVertex(t, other)) continue;  // this triangle vanishes
    std::array<Eigen::Vector3d, 3> corner;
    for (int k = 0; k < 3; ++k) {
      corner[k] = t[k] == moved ? position : positions_[t[k]];
      if (t[k] != moved && (positions_[t[k]] - position).norm() > longest) return false;
    }
    if (!sameSide(areaVector(number), cross3(corner[0], corner[1], corner[2]))) return false;
  }
  return true;
}

bool EditableMesh::mayCollapse(int a, int b, const Eigen::Vector3d& position, double longest) const {
  const auto opposite = wings(a, b);
  const int merged = valence(a) + valence(b) - 4;
  if (merged < kMinValence || merged > kMaxValence) return false;
  if (valence(opposite[0]) <= kMinValence || valence(opposite[1]) <= kMinValence) return false;
  return staysUpright(a, b, position, longest) && staysUpright(b, a, position, longest);
}

bool EditableMesh::collapse(int a, int b, const Eigen::Vector3d& position, bool gently, double longest) {
  const auto sides = trianglesOf(a, b);
  const auto opposite = wings(a, b);
  // link condition: the two vertices share no neighbours except the wings; otherwise two sheets would be joined
  int shared = 0;
  for (const int number : around_[b]) {
    const auto& t = triangles_[number];
    for (int k = 0; k < 3; ++k) {
      if (t[k] == b && t[(k + 1) % 3] != a && isEdge(a, t[(k + 1) % 3])) ++shared;  // each neighbour follows b once
    }
  }
  if (shared != 2 || valence(opposite[0]) <= 3 || valence(opposite[1]) <= 3) return false;
  if (valence(a) + valence(b) - 4 < 3) return false;
  if (gently && !mayCollapse(a, b, position, longest)) return false;

  for (const int side : sides) {
    for (const int v : triangles_[side]) removeFrom(v, side);
    triangles_[side] = {-1, -1, -1};
  }
  const std::vector<int> moved = around_[b];
  for (const int number : moved) replaceVertex(number, b, a);
  positions_[a] = position;
  --alive_count_;
  return true;
}

bool EditableMesh::flip(int a, int b) {
  const auto sides = trianglesOf(a, b);
  const auto [left, right] = wings(a, b);
  if (left == right || isEdge(left, right)) return false;
  if (valence(a) <= kMinValence || valence(b) <= kMinValence) return false;
  const Eigen::Vector3d first = cross3(positions_[right], positions_[left], positions_[a]);
  const Eigen::Vector3d second = cross3(positions_[left], positions_[right], positions_[b]);
  const Eigen::Vector3d before = areaVector(sides[0]) + areaVector(sides[1]);
  if (!sameSide(before, first) || !sameSide(before, second)) return false;

  replaceVertex(sides[0], b, right);  // (a, b, left) -> (a, right, left)
  replaceVertex(sides[1], a, left);   // (b, a, right) -> (b, left, right)
  return true;
}

SurfaceMesh EditableMesh::toMesh() const {
  SurfaceMesh mesh;
  std::vector<int> number(positions_.size(), -1);
  for (int v = 0; v < vertexEnd(); ++v) {
    if (!alive(v)) continue;
    number[v] = static_cast<int>(mesh.vertices.size());
    mesh.vertices.push_back(positions_[v]);
  }
  for (const auto& t : triangles_) {
    if (t[0] >= 0) mesh.triangles.push_back({number[t[0]], number[t[1]], number[t[2]]});
  }
  return mesh;
}

}  // namespace vibe
