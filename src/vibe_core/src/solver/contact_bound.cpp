#include "solver/contact_bound.hpp"

#include <algorithm>
#include <limits>

#include "arithmetic/ordered_algebra.hpp"
#include "vibe_core/solver/step_policy.hpp"

namespace vibe {

namespace {

// @param yielded  by the tool, against its forces
double depthOf(const ContactRows& contact, const YieldVector& yielded, const std::vector<double>& z) {
  return contact.target - fixedDot(contact.yield.row(0).transpose(), yielded) - contact.form[0].value(z);
}

// The first ones of an order count, in the order that they have already.
void countFirstOf(std::vector<std::pair<double, std::size_t>>& order, RowSystem& system) {
  ConstraintRows& rows = system.rows;
  std::sort(order.begin(), order.begin() + kMaxContacts,
            [](const auto& one, const auto& other) { return one.second < other.second; });
  for (std::size_t k = 0; k < kMaxContacts; ++k) std::swap(rows.contacts[k], rows.contacts[order[k].second]);
  rows.number(kMaxContacts);
  system.rhs.resize(rows.count());
}

}  // namespace

bool limitContacts(const std::vector<double>& z, RowSystem& system) {
  ConstraintRows& rows = system.rows;
  if (rows.contacts.size() <= kMaxWithFriction) return false;
  std::vector<std::pair<double, std::size_t>>& order = system.contact_order;
  order.clear();
  for (std::size_t c = 0; c < rows.contacts.size(); ++c) {
    rows.contacts[c].target = system.target[rows.contactRow(c)];
    const double gap = rows.contacts[c].form[0].value(z) - rows.contacts[c].target;
    order.emplace_back(rows.contacts[c].guess[0] > 0 ? -std::numeric_limits<double>::max() : gap, c);
  }
  std::sort(order.begin(), order.end());
  for (std::size_t k = kMaxWithFriction; k < order.size(); ++k) rows.contacts[order[k].second].friction = 0;
  if (order.size() <= kMaxContacts) return false;
  countFirstOf(order, system);
  return true;
}

bool exchangeContacts(const std::vector<double>& z, RowSystem& system) {
  const ConstraintRows& rows = system.rows;
  if (!(depthLeftOut(z, system) > stepPolicy().left_out_depth)) return false;
  const YieldVector yielded = rows.tool_compliance * system.schur.pull();
  std::vector<std::pair<double, std::size_t>>& order = system.contact_order;
  order.clear();
  for (std::size_t c = 0; c < rows.contacts.size(); ++c) {
    const bool pushes = c < rows.counted && system.schur.forces()[rows.contactRow(c)] > 0;
    order.emplace_back(pushes ? -std::numeric_limits<double>::max() : -depthOf(rows.contacts[c], yielded, z), c);
  }
  std::sort(order.begin(), order.end());
  countFirstOf(order, system);
  return true;
}

double depthLeftOut(const std::vector<double>& z, const RowSystem& system) {
  const ConstraintRows& rows = system.rows;
  const YieldVector yielded = rows.tool_compliance * system.schur.pull();
  double deepest = 0;
  for (std::size_t c = rows.counted; c < rows.contacts.size(); ++c)
    deepest = std::max(deepest, depthOf(rows.contacts[c], yielded, z));
  return deepest;
}

}  // namespace vibe
