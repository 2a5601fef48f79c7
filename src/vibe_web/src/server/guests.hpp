#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>

#include <boost/asio/ip/address.hpp>

namespace vibe::web {

/// Connections that have shown no token yet. There is always room for one more: where all places are taken, the address
/// with most guests loses the one that has been there longest. So one machine, however often it knocks, shuts nobody
/// out.
class Guests {
 public:
  using Id = std::uint64_t;

  explicit Guests(std::size_t places) : places_(places) {}

  /// @param leave  ends the connection; called at most once, while it is a guest
  Id enter(const boost::asio::ip::address& from, std::function<void()> leave);
  void exit(Id guest);
  std::size_t count() const { return house_of_.size(); }

 private:
  using House = std::uint64_t;  // an address, or the network of 64 bits that one machine has with IPv6
  void makeRoom();

  std::size_t places_;
  Id last_ = 0;
  std::map<House, std::map<Id, std::function<void()>>> guests_;
  std::map<Id, House> house_of_;
};

}  // namespace vibe::web
