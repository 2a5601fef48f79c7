#pragma once

#include <memory>
#include <optional>
#include <utility>

#include <boost/asio/steady_timer.hpp>

#include "protocol/byte_writer.hpp"
#include "server/shared.hpp"

namespace vibe::web {

constexpr int kMaxUndrawn = 2;                       ///< frames on their way to a page that tells what it has drawn
constexpr auto kSilence = std::chrono::seconds(20);  ///< after half of it a client is pinged, then let go

/// As many commands as a client may send, refilled steadily.
class Allowance {
 public:
  bool spend() {
    const Clock::time_point now = Clock::now();
    left_ = std::min(left_ + kMaxCommands * std::chrono::duration<double>(now - last_).count(), double{kMaxCommands});
    last_ = now;
    left_ -= 1;
    return left_ >= 0;
  }

 private:
  double left_ = kMaxCommands;
  Clock::time_point last_ = Clock::now();
};

/// The stream to one page.
template <class Stream>
class Client : public std::enable_shared_from_this<Client<Stream>> {
 public:
  Client(Stream&& stream, std::shared_ptr<Shared> shared)
      : socket_(std::move(stream)), timer_(socket_.get_executor()), shared_(std::move(shared)) {
    ++shared_->client_count;  // before it is open: many may ask at once
  }

  ~Client() {
    --shared_->client_count;
    if (id_ == 0) return;
    shared_->clients.erase(id_);
    shared_->on_leave(id_);
  }

  void accept(const Request& request) {
    websocket::stream_base::timeout patience{kReadTimeout, kSilence, true};
    socket_.set_option(patience);
    socket_.read_message_max(kMaxCommand);
    socket_.binary(true);
    socket_.async_accept(request, [self = this->shared_from_this()](Error error) {
      if (!error) self->begin();
    });
  }

 private:
  void begin() {
    id_ = ++shared_->last_id;
    waiting_ = shared_->newest;
    shared_->clients[id_] = [weak = this->weak_from_this()](Kind kind, SharedBytes bytes) {
      if (const auto self = weak.lock()) self->offer(kind, std::move(bytes));
    };
    read();
    pump();
  }

  void offer(Kind kind, SharedBytes bytes) {
    if (kind == Kind::Frame) came_ = Clock::now();
    waiting_[static_cast<std::size_t>(kind)] = std::move(bytes);
    pump();
  }

  bool isDue(std::size_t kind) const {
    if (kind != static_cast<std::size_t>(Kind::Frame)) return static_cast<bool>(waiting_[kind]);
    return waiting_[kind] && Clock::now() >= frameDue() && !isBehind();
  }

  /// A frame that has waited for its page is soon followed by a newer one; it is sent only if that does not come.
  Clock::time_point frameDue() const {
    const bool fresh = Clock::now() - came_ < period_ / 2;
    return fresh ? next_frame_ : std::max(next_frame_, came_ + period_ * 5 / 4);
  }

  /// A page that is slow to draw would show older and older frames from the queues of its browser.
  bool isBehind() const { return tells_ && undrawn_ >= kMaxUndrawn; }

  /// Sends one of the messages that wait, in turns, so that frames do not keep back all else.
  void pump() {
    if (writing_) return;
    for (std::size_t k = 1; k <= kKinds; ++k) {
      const std::size_t kind = (last_kind_ + k) % kKinds;
      if (isDue(kind)) return write(kind);
    }
    if (waiting_[static_cast<std::size_t>(Kind::Frame)] && !isBehind()) wakeForFrame();
  }

  void write(std::size_t kind) {
    writing_ = true;
    last_kind_ = kind;
    sending_ = std::exchange(waiting_[kind], nullptr);
    // a little early, because states come in steps of their own
    if (kind == static_cast<std::size_t>(Kind::Frame))
      ++undrawn_, next_frame_ = std::max(next_frame_ + period_, Clock::now() - period_ / 2);
    socket_.async_write(asio::buffer(*sending_), [self = this->shared_from_this()](Error error, std::size_t) {
      self->writing_ = false;
      self->sending_.reset();
      if (!error) self->pump();
    });
  }

  void wakeForFrame() {
    timer_.expires_at(frameDue());
    timer_.async_wait([weak = this->weak_from_this()](Error error) {
      const auto self = weak.lock();
      if (!error && self) self->pump();
    });
  }

  void read() {
    socket_.async_read(buffer_, [self = this->shared_from_this()](Error error, std::size_t) {
      if (error) return self->end();
      if (self->take()) self->read();
    });
  }

  /// @return whether the client may stay
  bool take() {
    const asio::const_buffer bytes = buffer_.cdata();
    const auto command = socket_.got_binary()
                             ? decodeCommand(static_cast<const std::uint8_t*>(bytes.data()), bytes.size())
                             : std::nullopt;
    buffer_.consume(bytes.size());
    if (!command || !allowance_.spend()) {
      close(command ? websocket::close_code::policy_error : websocket::close_code::bad_payload);
      return false;
    }
    if (command->kind == Command::Kind::Rate) period_ = std::chrono::nanoseconds(1'000'000'000 / command->rate);
    if (command->kind == Command::Kind::Drawn) return countDrawn(command->drawn), true;
    if (command->kind == Command::Kind::Ping) return answer(command->ping), true;
    shared_->on_command(id_, *command);
    return true;
  }

  void countDrawn(int frames) {
    undrawn_ = std::max(0, undrawn_ - frames);  // of all that were sent, so that none is forgotten in a queue
    tells_ = true;
    pump();
  }

  void answer(const std::array<std::uint8_t, 8>& ping) {
    ByteWriter pong(Kind::Pong);
    for (int k = 0; k < 7; ++k) pong.put(std::uint8_t{0});
    pong.putAll(ping.data(), ping.size());
    pong.put(std::chrono::duration<double>(std::chrono::system_clock::now().time_since_epoch()).count());
    offer(Kind::Pong, std::make_shared<const Bytes>(pong.take()));
  }

  void close(websocket::close_code code) {
    socket_.async_close(code, [self = this->shared_from_this()](Error) { self->end(); });
  }

  /// A write in progress ends with an error, and with it the last owner goes.
  void end() {
    timer_.cancel();
    beast::get_lowest_layer(socket_).close();
  }

  websocket::stream<Stream> socket_;
  asio::steady_timer timer_;
  std::shared_ptr<Shared> shared_;
  ClientId id_ = 0;
  beast::flat_static_buffer<kMaxCommand + 16> buffer_;
  std::array<SharedBytes, kKinds> waiting_;
  SharedBytes sending_;
  bool writing_ = false;
  bool tells_ = false;  // what it has drawn
  int undrawn_ = 0;     // frames sent and not drawn
  std::size_t last_kind_ = 0;
  std::chrono::nanoseconds period_{1'000'000'000 / 60};
  Clock::time_point next_frame_{}, came_{};
  Allowance allowance_;
};

}  // namespace vibe::web
