#pragma once

#include <cstddef>
#include <vector>

#include "solver/row_system.hpp"

namespace vibe {

/// Contacts that count in a step at most. Design choice: three times what a press of 3 N by the scope touches; the time
/// of a solution grows with the third power of the rows that act.
constexpr std::size_t kMaxContacts = 128;
/// Those with friction, which have three rows. Design choice: what a usual press has within reach; in the cases that
/// have more, friction on all of them changes the force on the tool by no more than the last bound does.
constexpr std::size_t kMaxWithFriction = 32;

/// Bounds the work of a step: the deepest contacts at z keep their friction, further ones up to kMaxContacts only their
/// normal, and the rest neither rows nor force. Needs the targets.
/// @returns whether rows have other numbers now; their targets are to be set again
bool limitContacts(const std::vector<double>& z, RowSystem& system);
/// How deep the contacts that do not count are in the tool at z, moved by the forces of the last elimination [m].
double depthLeftOut(const std::vector<double>& z, const RowSystem& system);
/// Where a contact that does not count would be deep in the tool at z, those that are deepest take the rows of contacts
/// without force.
/// @returns whether rows have other numbers now; their targets are to be set again
bool exchangeContacts(const std::vector<double>& z, RowSystem& system);

}  // namespace vibe
