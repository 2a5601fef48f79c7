#include "server/guests.hpp"

#include <algorithm>
#include <utility>

namespace vibe::web {

namespace {

std::uint64_t networkOf(const boost::asio::ip::address& address) {
  if (address.is_v4()) return address.to_v4().to_uint();
  std::uint64_t network = 0;
  const auto bytes = address.to_v6().to_bytes();
  for (std::size_t k = 0; k < sizeof network; ++k) network = network << 8 | bytes[k];
  return network;
}

}  // namespace

Guests::Id Guests::enter(const boost::asio::ip::address& from, std::function<void()> leave) {
  if (count() >= places_) makeRoom();
  const House house = networkOf(from);
  guests_[house][++last_] = std::move(leave);
  house_of_[last_] = house;
  return last_;
}

void Guests::exit(Id guest) {
  const auto found = house_of_.find(guest);
  if (found == house_of_.end()) return;  // it was asked to leave
  const auto house = guests_.find(found->second);
  house->second.erase(guest);
  if (house->second.empty()) guests_.erase(house);
  house_of_.erase(found);
}

void Guests::makeRoom() {
  const auto fewer = [](const auto& a, const auto& b) { return a.second.size() < b.second.size(); };
  const auto oldest = std::max_element(guests_.begin(), guests_.end(), fewer)->second.begin();
  const std::function<void()> leave = std::move(oldest->second);
  exit(oldest->first);
  leave();
}

}  // namespace vibe::web
