#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

#include "server/client.hpp"

namespace vibe::web {

constexpr std::uint32_t kMaxHeader = 8192;  ///< [bytes]
constexpr int kSendBuffer = 128 * 1024;     ///< of the system: what lies there is not replaced [bytes]
constexpr const char* kStreamPath = "/stream";

inline std::string textOf(beast::string_view view) {
  return {view.data(), view.size()};
}

inline Caller callerOf(const Request& request) {
  return {textOf(request[http::field::host]), textOf(request[http::field::origin]), textOf(request.target())};
}

/// What tells this content from any other (RFC 9110, 8.8.3).
inline std::string tagOf(const std::string& content) {
  return '"' + std::to_string(std::hash<std::string>()(content)) + '"';
}

/// Whether the browser has the content of this tag already.
inline bool knows(const Request& request, const std::string& tag) {
  return textOf(request[http::field::if_none_match]).find(tag) != std::string::npos;
}

/// A connection before it becomes a stream: answers requests for files.
template <class Stream>
class Connection : public std::enable_shared_from_this<Connection<Stream>> {
 public:
  template <class... Context>
  Connection(asio::ip::tcp::socket&& socket, std::shared_ptr<Shared> shared, Context&... context)
      : stream_(std::move(socket), context...), shared_(std::move(shared)) {}
  ~Connection() { shared_->guests.exit(guest_); }

  void run() {
    Error gone;
    const auto from = beast::get_lowest_layer(stream_).socket().remote_endpoint(gone).address();
    if (gone) return;
    guest_ = shared_->guests.enter(from, [weak = this->weak_from_this()] {
      if (const auto self = weak.lock()) beast::get_lowest_layer(self->stream_).close();
    });
    if constexpr (std::is_same_v<Stream, beast::tcp_stream>) {
      read();
    } else {
      beast::get_lowest_layer(stream_).expires_after(kReadTimeout);
      beast::async_detect_ssl(stream_.next_layer(), buffer_, [self = this->shared_from_this()](Error error, bool tls) {
        if (error) return;
        if (tls) return self->shakeHands();
        self->read(self->stream_.next_layer(), [&self = *self](const Request& request) { self.redirect(request); });
      });
    }
  }

 private:
  void shakeHands() {
    stream_.async_handshake(asio::ssl::stream_base::server, buffer_.data(),
                            [self = this->shared_from_this()](Error error, std::size_t used) {
                              self->buffer_.consume(used);
                              if (!error) self->read();
                            });
  }

  void read() {
    read(stream_, [this](const Request& request) { handle(request); });
  }

  template <class Layer, class Handler>
  void read(Layer& layer, Handler handler) {
    parser_.emplace();
    parser_->header_limit(kMaxHeader);
    parser_->body_limit(0);
    beast::get_lowest_layer(layer).expires_after(kReadTimeout);
    http::async_read(layer, buffer_, *parser_, [self = this->shared_from_this(), handler](Error error, std::size_t) {
      if (!error) handler(self->parser_->release());
    });
  }

  /// Of plain HTTP to TLS; for now, because a browser would remember more than this start of the server.
  void redirect(const Request& request) {
    const Caller caller = callerOf(request);
    auto response = std::make_shared<http::response<http::empty_body>>(http::status::temporary_redirect, 11);
    response->set(http::field::location, "https://" + caller.host + (caller.target[0] == '/' ? caller.target : "/"));
    response->keep_alive(false);
    response->prepare_payload();
    auto& plain = beast::get_lowest_layer(stream_);
    http::async_write(plain, *response, [self = this->shared_from_this(), response](Error, std::size_t) {
      Error ignored;
      beast::get_lowest_layer(self->stream_).socket().shutdown(asio::socket_base::shutdown_send, ignored);
    });
  }

  void handle(const Request& request) {
    const Caller caller = callerOf(request);
    const std::string path = caller.target.substr(0, caller.target.find('?'));
    if (path == kStreamPath) return openStream(request, caller);
    const std::string refused = hostRefusal(shared_->rule(), caller);
    if (!refused.empty()) return answerText(request, http::status::forbidden, refused);
    if (request.method() != http::verb::get && request.method() != http::verb::head)
      return answerText(request, http::status::method_not_allowed, "This server answers GET only.");
    const PageFile file = find(request, path);
    if (!file.content) return answerText(request, http::status::not_found, "This server has no such page.");
    answer(request, http::status::ok, file);
  }

  PageFile find(const Request& request, const std::string& path) const {
    const auto provided = shared_->provided.find(path);
    if (provided != shared_->provided.end()) return provided->second;
    const bool gzip = takesGzip(textOf(request[http::field::accept_encoding]));
    PageFile file = readPageFile(shared_->options.page, path, gzip);
    if (file.content || path != "/") return file;
    file.type = "text/plain; charset=utf-8";
    file.content = std::make_shared<const std::string>(
        "The page has not been built: install nodejs and npm, and run scripts/build again. The stream works without "
        "it.\n");
    return file;
  }

  void openStream(const Request& request, const Caller& caller) {
    const std::string refused = streamRefusal(shared_->rule(), caller);
    if (!refused.empty()) return answerText(request, http::status::forbidden, refused);
    if (shared_->client_count >= kMaxClients)
      return answerText(request, http::status::service_unavailable, "Too many pages look already; close one of them.");
    if (!websocket::is_upgrade(request))  // a page asks so why its stream was refused
      return answerText(request, http::status::upgrade_required, "This is the stream of the page, a WebSocket.");
    shared_->guests.exit(guest_);
    beast::get_lowest_layer(stream_).expires_never();
    Error ignored;
    beast::get_lowest_layer(stream_).socket().set_option(asio::ip::tcp::no_delay(true), ignored);
    beast::get_lowest_layer(stream_).socket().set_option(asio::socket_base::send_buffer_size(kSendBuffer), ignored);
    std::make_shared<Client<Stream>>(std::move(stream_), shared_)->accept(request);
  }

  void answerText(const Request& request, http::status status, const std::string& sentence) {
    PageFile file;
    file.type = "text/plain; charset=utf-8";
    file.content = std::make_shared<const std::string>(sentence + "\n");
    answer(request, status, file);
  }

  void answer(const Request& request, http::status status, const PageFile& file) {
    using Response = http::response<http::span_body<const char>>;
    auto response = std::make_shared<Response>(status, request.version());
    response->set(http::field::content_type, file.type);
    response->set("X-Content-Type-Options", "nosniff");
    response->set("Referrer-Policy", "no-referrer");
    response->set(http::field::cache_control, "no-cache");  // asked for again, and sent again if it has changed
    response->set(http::field::vary, "Accept-Encoding");
    if (status == http::status::ok) response->set(http::field::etag, tagOf(*file.content));
    if (status == http::status::upgrade_required) response->set(http::field::upgrade, "websocket");
    if (status == http::status::method_not_allowed) response->set(http::field::allow, "GET, HEAD");
    response->set(
        "Content-Security-Policy",
        "default-src 'self'; img-src 'self' data: blob:; style-src 'self' 'unsafe-inline'; connect-src 'self' "
        "ws: wss:; frame-ancestors 'none'; base-uri 'none'; form-action 'none'");
    if (file.gzipped) response->set(http::field::content_encoding, "gzip");
    const bool known = status == http::status::ok && knows(request, textOf((*response)[http::field::etag]));
    if (known) response->result(http::status::not_modified);
    if (!known && request.method() != http::verb::head)
      response->body() = beast::span<const char>(file.content->data(), file.content->size());
    response->keep_alive(request.keep_alive());
    response->content_length(file.content->size());  // also where it is only told (RFC 9110, 8.6)
    http::async_write(stream_, *response,
                      [self = this->shared_from_this(), response, content = file.content](Error error, std::size_t) {
                        if (!error && response->keep_alive()) self->read();
                      });
  }

  Stream stream_;
  std::shared_ptr<Shared> shared_;
  Guests::Id guest_ = 0;
  beast::flat_static_buffer<kMaxHeader + 1024> buffer_;
  boost::optional<http::request_parser<http::empty_body>> parser_;
};

}  // namespace vibe::web
