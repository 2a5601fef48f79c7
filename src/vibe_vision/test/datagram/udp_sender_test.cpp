#include "vibe_vision/datagram/datagram.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>

#include "vibe_testing/expect_error.hpp"

namespace vibe::vision::udp_sender_test {
namespace {

/// A socket on a free port of this machine.
class Receiver {
 public:
  Receiver() : socket_(socket(AF_INET, SOCK_DGRAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(bind(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    socklen_t size = sizeof address;
    getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size);
    port_ = ntohs(address.sin_port);
    const timeval patience{1, 0};
    setsockopt(socket_, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
  }
  ~Receiver() { close(socket_); }
  std::string target() const { return "127.0.0.1:" + std::to_string(port_); }
  std::vector<std::uint8_t> receive() const {
    std::vector<std::uint8_t> bytes(2048);
    const ssize_t size = recv(socket_, bytes.data(), bytes.size(), 0);
    bytes.resize(size > 0 ? static_cast<std::size_t>(size) : 0);
    return bytes;
  }

 private:
  int socket_;
  int port_ = 0;
};

TEST(UdpSender, DeliversTheBytes) {
  const Receiver receiver;
  UdpSender sender(receiver.target());
  sender.send({1, 2, 3});
  sender.send({4});
  EXPECT_EQ(receiver.receive(), (std::vector<std::uint8_t>{1, 2, 3}));
  EXPECT_EQ(receiver.receive(), (std::vector<std::uint8_t>{4}));
  EXPECT_EQ(sender.sent(), 2u);
  EXPECT_EQ(sender.failed(), 0u);
}

TEST(UdpSender, ResolvesNames) {
  const Receiver receiver;
  UdpSender sender("localhost" + receiver.target().substr(9));
  sender.send({7});
  EXPECT_EQ(sender.failed(), 0u);
}

TEST(UdpSender, NobodyThereIsNoFailure) {
  std::string target;
  {
    const Receiver gone;
    target = gone.target();
  }
  UdpSender sender(target);
  for (int i = 0; i < 100; ++i) sender.send({1});
  EXPECT_EQ(sender.failed(), 0u);
}

TEST(UdpSender, CountsWhatTheSystemRefuses) {
  const Receiver receiver;
  UdpSender sender(receiver.target());
  sender.send(std::vector<std::uint8_t>(100000));  // more than a datagram can hold
  EXPECT_EQ(sender.failed(), 1u);
  sender.send({1});
  EXPECT_EQ(sender.sent(), 1u);
}

TEST(UdpSender, NeverWaitsForAReceiverThatDoesNotRead) {
  const Receiver receiver;
  UdpSender sender(receiver.target());
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < 20000; ++i) sender.send(std::vector<std::uint8_t>(344));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(5));
  EXPECT_EQ(sender.sent() + sender.failed(), 20000u);
}

TEST(UdpSender, WrongAddressesAreNamed) {
  for (const char* target : {"", "9870", ":9870", "localhost:", "localhost:0", "localhost:65536", "localhost:12x",
                             "localhost:-1", "a:b:9870", "no such host:9870"}) {
    const std::string message = errorOf([&] { UdpSender sender(target); });
    EXPECT_NE(message.find("'" + std::string(target) + "'"), std::string::npos) << target << ": " << message;
    EXPECT_NE(message.find("write host:port"), std::string::npos) << message;
  }
}

}  // namespace
}  // namespace vibe::vision::udp_sender_test
