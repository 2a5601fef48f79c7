#include "server/web_server.hpp"

#include <gtest/gtest.h>

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <chrono>
#include <memory>
#include <thread>
#include <vector>

namespace vibe::web::web_server_test {
namespace {

using boost::asio::ip::tcp;
using Socket = std::unique_ptr<tcp::socket>;

struct Visit {
  boost::asio::io_context context;
  ServerOptions options;
  std::unique_ptr<WebServer> server;

  Visit() {
    options.port = 0;
    options.page = "server";  // a folder of the tests
    server = std::make_unique<WebServer>(
        options, [](ClientId, const Command&) {}, [](ClientId) {});
  }

  /// A connection to the server from an address of this machine.
  Socket from(const char* address, const char* to = "127.0.0.1") {
    auto socket = std::make_unique<tcp::socket>(context);
    const auto own = boost::asio::ip::make_address(address);
    socket->open(own.is_v6() ? tcp::v6() : tcp::v4());
    socket->bind({own, 0});
    socket->connect({boost::asio::ip::make_address(to), server->port()});
    return socket;
  }

  /// First line of the answer to a request; empty: it was cut off.
  static std::string ask(tcp::socket& socket) {
    boost::system::error_code error;
    boost::asio::write(socket,
                       boost::asio::buffer(std::string("GET /web_server_test.cpp HTTP/1.1\r\nHost: localhost\r\n\r\n")),
                       error);
    std::string answer(15, '\0');
    boost::asio::read(socket, boost::asio::buffer(answer), error);
    return error ? "" : answer;
  }
};

TEST(WebServer, ListensOnBothLoopbacks) {
  Visit visit;
  EXPECT_EQ(Visit::ask(*visit.from("127.0.0.1")), "HTTP/1.1 200 OK");
  boost::system::error_code none;
  tcp::socket probe(visit.context, tcp::v6());
  probe.bind({boost::asio::ip::address_v6::loopback(), 0}, none);
  if (none) GTEST_SKIP() << "no IPv6 on this machine";
  EXPECT_EQ(Visit::ask(*visit.from("::1", "::1")), "HTTP/1.1 200 OK");
}

TEST(WebServer, APortThatIsTakenIsOneSentenceWithItsRemedy) {
  Visit visit;
  visit.options.port = visit.server->port();
  try {
    WebServer second(
        visit.options, [](ClientId, const Command&) {}, [](ClientId) {});
    ADD_FAILURE() << "two servers on one port";
  } catch (const std::runtime_error& error) {
    EXPECT_NE(std::string(error.what()).find("choose another one with _port:="), std::string::npos) << error.what();
  }
}

TEST(WebServer, IdleConnectionsOfOneMachineShutOutNobody) {
  Visit visit;
  std::vector<Socket> polite, idle;
  for (int k = 0; k < 6; ++k) polite.push_back(visit.from("127.0.0.2"));
  for (std::size_t k = 0; k < 2 * kMaxConnections; ++k) idle.push_back(visit.from("127.0.0.1"));
  EXPECT_EQ(Visit::ask(*visit.from("127.0.0.3")), "HTTP/1.1 200 OK");
  for (const Socket& socket : polite) EXPECT_EQ(Visit::ask(*socket), "HTTP/1.1 200 OK");
  EXPECT_EQ(Visit::ask(*idle.front()), "");  // whoever takes the places loses them
  EXPECT_EQ(Visit::ask(*idle.back()), "HTTP/1.1 200 OK");
}

}  // namespace
}  // namespace vibe::web::web_server_test
