#include "self_contact/self_contact_search.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "geometry/triangle_distance.hpp"

namespace vibe {

namespace {

// Entries of a list for which there is memory from the start: those of a surface with a few folds. A list that is
// longer grows once.
constexpr std::size_t kPerTriangle = 4;
constexpr float kRoundedDown = 1 - 1e-6F, kRoundedUp = 1 + 1e-6F;  // of a distance in single precision

/// Distance between the parts of two triangles at one vertex that do not contain it [m].
double fanDistance(std::array<int, 3> a, std::array<int, 3> b, const std::vector<Eigen::Vector3d>& at) {
  // The common vertex comes first in both.
  for (std::array<int, 3>* t : {&a, &b}) {
    const std::array<int, 3>& other = t == &a ? b : a;
    while (std::find(other.begin(), other.end(), (*t)[0]) == other.end())
      std::rotate(t->begin(), t->begin() + 1, t->end());
  }
  // What is nearest is a vertex and the other triangle, or the two edges opposite to the common vertex and any others.
  const auto connect = [&](int p, const std::array<int, 3>& t) {
    return triangleFoot(at[p], at[t[0]], at[t[1]], at[t[2]]).away.squaredNorm();
  };
  double least = std::min(std::min(connect(a[1], b), connect(a[2], b)), std::min(connect(b[1], a), connect(b[2], a)));
  for (int k = 0; k < 3; ++k) {
    least = std::min(least, segmentConnection(at[a[1]], at[a[2]], at[b[k]], at[b[(k + 1) % 3]]).squaredNorm());
    least = std::min(least, segmentConnection(at[b[1]], at[b[2]], at[a[k]], at[a[(k + 1) % 3]]).squaredNorm());
  }
  return std::sqrt(least);
}

}  // namespace

SelfContactSearch::SelfContactSearch(const SurfaceMesh& rest, const Settings& settings)
    : triangles_(rest.triangles),
      walls_(settings.walls),
      cosine_(settings.cosine),
      floor_(settings.floor),
      carried_(settings.carried),
      rings_(triangles_, rest.vertices.size()),
      tree_(rest, rings_),
      bounds_(triangles_, tree_.parts(), settings.slack),
      vertex_off_(rest.vertices.size()),
      triangle_off_(triangles_.size()) {
  tree_.setWalls(walls_);
  for (Positions* positions : {&middle_start_, &middle_end_})
    for (std::vector<double>& component : *positions) component.resize(carried_ ? rest.vertices.size() : 0);
  for (std::vector<Near>* list : {&near_, &new_near_, &old_near_}) list->reserve(kPerTriangle * triangles_.size());
  for (std::vector<Meeting>* list : {&meetings_, &new_meetings_, &old_meetings_})
    list->reserve(kPerTriangle * triangles_.size());
}

bool SelfContactSearch::adapt(const NodeVectors& start, const NodeVectors& end, double distance) {
  if (!carried_) return renew(start, end, distance);
  const NodeVectors to = aboutMiddle(end, middle_end_);
  return renew(start == end ? to : aboutMiddle(start, middle_start_), to, distance);
}

SelfContactSearch::NodeVectors SelfContactSearch::aboutMiddle(const NodeVectors& at, Positions& out) {
  for (std::size_t k = 0; k < 3; ++k) {
    const Eigen::Map<const Eigen::ArrayXd> x(at[k], static_cast<Eigen::Index>(out[k].size()));
    double sum = 0;
    for (const double value : x) sum += value;
    Eigen::Map<Eigen::ArrayXd>(out[k].data(), x.size()) = x - sum / static_cast<double>(x.size());
  }
  return {out[0].data(), out[1].data(), out[2].data()};
}

bool SelfContactSearch::renew(const NodeVectors& start, const NodeVectors& end, double distance) {
  // The distance changes with the speed of the walls; the lists are made anew only where they are too short or far too
  // long.
  const bool all = distance > distance_ || distance < stepPolicy().search_too_far * distance_;
  if (all) bounds_.reset();
  if (!bounds_.adapt(start, end)) {
    distance_ = -1;
    return false;
  }
  if (bounds_.moved().empty() && bounds_.turned().empty()) return true;
  if (all) distance_ = stepPolicy().search_spare * distance;
  ++count_;
  tree_.adapt(bounds_, all);
  tree_.visitChanges([this](int t) { bounds_.setLoose(t, tree_.isRough(t)); });
  renewNear();
  renewMeetings();
  return true;
}

// Entries of parts that have not changed stay; the tree visits all others again.
void SelfContactSearch::renewNear() {
  old_near_.clear();
  for (const Near& near : near_)
    if (!tree_.hasNewBall(near.vertex) && !tree_.hasNewBox(near.triangle)) old_near_.push_back(near);
  new_near_.clear();
  tree_.visitFacing(static_cast<float>(cosine_), static_cast<float>(distance_),
                    [this](int vertex, int triangle) { addNear(vertex, triangle); });
  std::sort(new_near_.begin(), new_near_.end());
  near_.resize(old_near_.size() + new_near_.size());
  // Both are ascending. A pair may be in both, because the tree visits more than what has changed.
  const auto end =
      std::set_union(old_near_.begin(), old_near_.end(), new_near_.begin(), new_near_.end(), near_.begin());
  near_.erase(end, near_.end());
}

void SelfContactSearch::addNear(int v, int triangle) {
  const auto& n = triangles_[triangle];
  const std::vector<Eigen::Vector3d>& at = bounds_.centre();
  const double distance = distance_ + bounds_.radius(v) + radius(triangle);
  const TriangleFoot foot = triangleFoot(at[v], at[n[0]], at[n[1]], at[n[2]]);
  if (!(foot.away.squaredNorm() < distance * distance)) return;
  if (!walls_.oneWall(v, n[0]) && !walls_.oneWall(v, n[1]) && !walls_.oneWall(v, n[2]))
    new_near_.push_back({v, triangle, kRoundedDown * static_cast<float>(foot.away.norm())});
}

// How far positions are from the centres of the balls, for which the distances in the list were taken.
void SelfContactSearch::measure(const NodeVectors& where) {
  if (near_.empty()) return;
  const NodeVectors at = carried_ ? aboutMiddle(where, middle_start_) : where;
  for (std::size_t i = 0; i < vertex_off_.size(); ++i)
    vertex_off_[i] =
        kRoundedUp * static_cast<float>((Eigen::Vector3d(at[0][i], at[1][i], at[2][i]) - bounds_.centre()[i]).norm());
  for (std::size_t t = 0; t < triangle_off_.size(); ++t) {
    const auto& n = triangles_[t];
    triangle_off_[t] = std::max({vertex_off_[n[0]], vertex_off_[n[1]], vertex_off_[n[2]]});
  }
}

double SelfContactSearch::radius(int triangle) const {
  const auto& n = triangles_[triangle];
  return std::max({bounds_.radius(n[0]), bounds_.radius(n[1]), bounds_.radius(n[2])});
}

void SelfContactSearch::renewMeetings() {
  old_meetings_.clear();
  for (const Meeting& pair : meetings_)
    if (!tree_.hasNewPath(pair[0]) && !tree_.hasNewPath(pair[1])) old_meetings_.push_back(pair);
  new_meetings_.clear();
  tree_.visitCrossing(static_cast<float>(floor_), [this](int one, int other) {
    if (mayMeet(one, other)) new_meetings_.push_back({one, other});
  });
  std::sort(new_meetings_.begin(), new_meetings_.end());
  meetings_.resize(old_meetings_.size() + new_meetings_.size());
  const auto end = std::set_union(old_meetings_.begin(), old_meetings_.end(), new_meetings_.begin(),
                                  new_meetings_.end(), meetings_.begin());
  meetings_.erase(end, meetings_.end());
}

bool SelfContactSearch::mayMeet(int one, int other) const {
  const double distance = floor_ + radius(one) + radius(other);
  int shared = 0;
  for (const int v : triangles_[one])
    for (const int w : triangles_[other]) shared += v == w ? 1 : 0;
  // Triangles with a common edge cannot cross without turning over; with a common vertex they touch there, and the rest
  // of them counts.
  if (shared == 0) return !apart(one, other, distance);
  return shared == 1 && fanDistance(triangles_[one], triangles_[other], bounds_.centre()) < distance;
}

// Whether a plane parallel to one of the triangles, or across the line between their centres, separates them by more
// than a distance.
bool SelfContactSearch::apart(int one, int other, double distance) const {
  const std::array<int, 3>&a = triangles_[one], &b = triangles_[other];
  const std::vector<Eigen::Vector3d>& at = bounds_.centre();
  const auto separates = [&](const Eigen::Vector3d& direction) {
    const double p = direction.dot(at[a[0]]), q = direction.dot(at[a[1]]), r = direction.dot(at[a[2]]),
                 s = direction.dot(at[b[0]]), t = direction.dot(at[b[1]]), u = direction.dot(at[b[2]]);
    const double gap = distance * direction.norm();
    return std::min({p, q, r}) - std::max({s, t, u}) > gap || std::min({s, t, u}) - std::max({p, q, r}) > gap;
  };
  const auto normal = [&](const std::array<int, 3>& t) -> Eigen::Vector3d {
    return (at[t[1]] - at[t[0]]).cross(at[t[2]] - at[t[0]]);
  };
  return separates((at[a[0]] + at[a[1]] + at[a[2]]) - (at[b[0]] + at[b[1]] + at[b[2]])) || separates(normal(a)) ||
         separates(normal(b));
}

}  // namespace vibe
