#include "server/web_server.hpp"

#include <gtest/gtest.h>

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace vibe::web::web_server_test {
namespace {

namespace http = boost::beast::http;
namespace websocket = boost::beast::websocket;
using boost::asio::ip::tcp;
using Socket = std::unique_ptr<tcp::socket>;

struct Visit {
  boost::asio::io_context context;
  ServerOptions options;
  std::unique_ptr<WebServer> server;

  explicit Visit(WebServer::CommandHandler obey = [](ClientId, const Command&) {}) {
    options.port = 0;
    options.page = ".";  // the folders of the tests
    server = std::make_unique<WebServer>(options, std::move(obey), [](ClientId) {});
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
    boost::asio::write(
        socket, boost::asio::buffer(std::string("GET /server/web_server_test.cpp HTTP/1.1\r\nHost: localhost\r\n\r\n")),
        error);
    std::string answer(15, '\0');
    boost::asio::read(socket, boost::asio::buffer(answer), error);
    return error ? "" : answer;
  }

  using Fields = std::vector<std::pair<http::field, std::string>>;
  using Answer = http::response<http::string_body>;

  Answer answer(const std::string& path, http::verb verb = http::verb::get, const Fields& fields = {}) {
    http::request<http::empty_body> request(verb, path, 11);
    request.set(http::field::host, "localhost");
    for (const auto& [name, value] : fields) request.set(name, value);
    const Socket socket = from("127.0.0.1");
    http::write(*socket, request);
    boost::beast::flat_buffer buffer;
    http::response_parser<http::string_body> parser;
    parser.skip(verb == http::verb::head);
    http::read(*socket, buffer, parser);
    return parser.release();
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

TEST(WebServer, AFolderIsNoPage) {
  Visit visit;
  for (const char* path : {"/server", "/server/", "/", "/none"}) {
    const Visit::Answer answer = visit.answer(path);
    EXPECT_EQ(answer.result_int(), path == std::string("/") ? 200 : 404) << path;  // that no page was built
  }
  EXPECT_EQ(visit.answer("/server/web_server_test.cpp").result_int(), 200);
}

TEST(WebServer, WhatGoesWrongInOneConnectionEndsNoOther) {
  int obeyed = 0;
  Visit visit([&](ClientId, const Command&) {
    ++obeyed;
    throw std::runtime_error("an error in the code that obeys");
  });
  websocket::stream<tcp::socket> stream(visit.context);
  stream.next_layer().connect({boost::asio::ip::make_address("127.0.0.1"), visit.server->port()});
  stream.handshake("localhost", "/stream");
  stream.binary(true);
  stream.write(boost::asio::buffer(std::string("\2")));  // takes the place
  boost::beast::flat_buffer buffer;
  boost::system::error_code ended;
  stream.read(buffer, ended);
  EXPECT_TRUE(ended);
  EXPECT_EQ(visit.answer("/server/web_server_test.cpp").result_int(), 200);
  EXPECT_EQ(obeyed, 1);
}

TEST(WebServer, HeadTellsWhatGetHas) {
  Visit visit;
  for (const char* path : {"/server/web_server_test.cpp", "/none"}) {
    Visit::Answer get = visit.answer(path), head = visit.answer(path, http::verb::head);
    EXPECT_GT(get.body().size(), 0U);
    EXPECT_TRUE(head.body().empty());
    for (const auto& field : get) EXPECT_EQ(head[field.name_string()], field.value()) << field.name_string();
    EXPECT_EQ(head[http::field::content_length], std::to_string(get.body().size()));
  }
  EXPECT_EQ(visit.answer("/", http::verb::post)[http::field::allow], "GET, HEAD");
}

TEST(WebServer, WhatABrowserHasIsNotSentAgain) {
  Visit visit;
  const auto text = [](const char* words) { return std::make_shared<const std::string>(words); };
  visit.server->provide("/pattern", {"text/plain", text("one"), false});
  const Visit::Answer first = visit.answer("/pattern");
  const std::string tag(first[http::field::etag]);
  const Visit::Fields known{{http::field::if_none_match, "\"other\", W/" + tag}};
  const Visit::Answer again = visit.answer("/pattern", http::verb::get, known);
  EXPECT_EQ(again.result(), http::status::not_modified);
  EXPECT_TRUE(again.body().empty());
  EXPECT_EQ(again[http::field::etag], tag);
  visit.server->provide("/pattern", {"text/plain", text("two"), false});
  EXPECT_EQ(visit.answer("/pattern", http::verb::get, known).body(), "two");
}

TEST(WebServer, PacksOnlyForThoseWhoUnpack) {
  for (const char* yes : {"gzip", "br, GZIP;q=0.5", "deflate , gzip ; q=1.0", "*", "br;q=1, *;q=0.1"})
    EXPECT_TRUE(takesGzip(yes)) << yes;
  for (const char* no : {"", "br", "gzip;q=0", "gzip; q=0.000, br", "*;q=0", "gzip;q=0, *", "x-gzipped"})
    EXPECT_FALSE(takesGzip(no)) << no;
  Visit visit;
  EXPECT_EQ(visit.answer("/server/web_server_test.cpp")[http::field::vary], "Accept-Encoding");
}

}  // namespace
}  // namespace vibe::web::web_server_test
