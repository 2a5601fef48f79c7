// A whole bite by the stream of web_node: keys, sticks and buttons as the page sends them. Argument: the port. Prints
// the row of docs/hardware.md, and on failure what did not happen.

#include <boost/asio/connect.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/websocket.hpp>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <nlohmann/json.hpp>

#include "protocol/message_kind.hpp"
#include "vibe_operator/drive/drive_keys.hpp"
#include "vibe_testing/whole_bite.hpp"

namespace {

using nlohmann::json;
using vibe::web::Bytes;
using vibe::web::Kind;
namespace asio = boost::asio;
namespace operating = vibe::operating;

constexpr std::chrono::milliseconds kPeriod(50);  // of messages, as the page has it
constexpr int kRetry = 200, kHold = 30;  // messages until a key without effect is pressed anew, and while it is down
constexpr double kNear = 4e-3;           // [m]; from here on Shift is held

bool slides(vibe::Joint joint) {
  return joint == vibe::Insertion || joint == vibe::HelixAdvance || joint == vibe::NeedleDriver;
}

class PageHand : public vibe::test::HandAtDevice {
 public:
  explicit PageHand(const std::string& port) {
    asio::connect(stream_.next_layer(), asio::ip::tcp::resolver(context_).resolve("localhost", port));
    stream_.handshake("localhost:" + port, "/stream");
    stream_.binary(true);
    stream_.read_message_max(0);
    read();
    write({2});  // takes the place
    while (grant_ == 0) context_.run_one();
    tick();
  }

  vibe::test::SeenByHand look() override {
    is_new_ = false;
    while (!is_new_) context_.run_one();
    return seen_;
  }

  void steer(vibe::Joint joint, double by) override {
    joint_ = joint;
    by_ = by;
  }

  /// Until the page shows it.
  void press(vibe::Button button, bool down) override {
    wanted_[button] = down;
    while (buttons_.empty() || buttons_[button] != down) context_.run_one();
  }

 private:
  asio::io_context context_;
  boost::beast::websocket::stream<asio::ip::tcp::socket> stream_{context_};
  boost::beast::flat_buffer received_;
  asio::steady_timer timer_{context_};
  vibe::test::SeenByHand seen_;
  bool is_new_ = false;
  std::uint32_t grant_ = 0, number_ = 0;
  int last_event_ = 0;
  std::vector<std::string> joints_;  // of a frame
  std::vector<bool> buttons_;        // that are down at the simulator; empty: not known yet
  std::array<bool, vibe::kButtonCount> wanted_{};
  std::array<int, vibe::kButtonCount> waits_{};  // messages for which a button was not as it is wanted
  vibe::Joint joint_ = vibe::Insertion;
  double by_ = 0;
  Bytes last_;

  void read() {
    stream_.async_read(received_, [this](const boost::system::error_code& error, std::size_t size) {
      if (error) throw boost::system::system_error(error);
      take(static_cast<const std::uint8_t*>(received_.data().data()), size);
      received_.consume(size);
      read();
    });
  }

  void take(const std::uint8_t* bytes, std::size_t size) {
    const auto kind = static_cast<Kind>(bytes[0]);
    if (kind == Kind::Frame) return takeFrame(bytes);
    if (kind != Kind::Scene && kind != Kind::Grant && kind != Kind::Operator && kind != Kind::Events) return;
    const json text = json::parse(bytes + 1, bytes + size);
    if (kind == Kind::Scene && text.contains("joints")) joints_ = text["joints"].get<std::vector<std::string>>();
    if (kind == Kind::Grant) grant_ = text["grant"].get<std::uint32_t>();
    if (kind == Kind::Operator) buttons_ = text["buttons"].get<std::vector<bool>>();
    if (kind != Kind::Events) return;
    for (const json& event : text)
      if (event["number"].get<int>() > last_event_) takeEvent(event["kind"].get<std::size_t>(), event["text"]);
    if (!text.empty()) last_event_ = text.back()["number"].get<int>();
  }

  void takeEvent(std::size_t kind, const std::string& text) {
    ++seen_.events.at(kind);
    if (static_cast<vibe::Event::Kind>(kind) == vibe::Event::Kind::GrabMissed)
      seen_.gap = 1e-3 * std::stod(text.substr(text.find("nearest is ") + 11));  // [mm]
  }

  template <class T>
  static T at(const std::uint8_t* bytes, std::size_t place) {
    T value;
    std::memcpy(&value, bytes + place, sizeof value);
    return value;
  }

  void takeFrame(const std::uint8_t* bytes) {
    if (joints_.size() != bytes[1]) return;
    seen_.time = at<double>(bytes, 8);
    seen_.force = std::hypot(at<float>(bytes, 48), at<float>(bytes, 52), at<float>(bytes, 56));
    for (std::size_t k = 0; k < joints_.size(); ++k)
      for (std::size_t j = 0; j < vibe::kJointCount; ++j)
        if (joints_[k] == vibe::kJointNames[j]) seen_.joints[j] = at<float>(bytes, 72 + 4 * k);
    is_new_ = true;
  }

  /// Twenty times a second, whatever is heard: a page that is silent lets go.
  void tick() {
    timer_.expires_after(kPeriod);
    timer_.async_wait([this](const boost::system::error_code& error) {
      if (!error) tick();
    });
    std::vector<std::uint32_t> keys;
    std::array<std::int16_t, vibe::kJointCount> axes{};
    for (const operating::KeyBinding& binding : operating::keyBindings())
      if (holds(binding)) keys.push_back(static_cast<std::uint32_t>(binding.key));
    // a stick
    if (joint_ < vibe::kScopeJointCount)
      axes[joint_] = static_cast<std::int16_t>(32767 * std::clamp(by_ / (slides(joint_) ? 0.015 : 0.4), -1.0, 1.0));
    send(keys, axes);
  }

  bool holds(const operating::KeyBinding& binding) {
    using Does = operating::KeyBinding::Kind;
    if (binding.kind == Does::Button) return holdsButton(binding.index);
    if (joint_ < vibe::kScopeJointCount) return false;  // the sticks have them
    if (binding.kind == Does::SlowDown) return slides(joint_) && by_ != 0 && std::abs(by_) < kNear;
    return binding.kind == Does::Joint && binding.index == joint_ && by_ * binding.sign > 0 && binding.key != 'Y';
  }

  /// Gas and grab change with each press; others are down while their key is.
  bool holdsButton(int index) {
    const auto b = static_cast<std::size_t>(index);
    const bool differs = !buttons_.empty() && buttons_[b] != wanted_[b];
    waits_[b] = differs ? waits_[b] + 1 : 0;
    const bool toggles = index == vibe::HelixGrab || index == vibe::Insufflate;
    return (toggles ? differs : wanted_[b]) && waits_[b] % kRetry <= kHold;
  }

  void send(const std::vector<std::uint32_t>& keys, const std::array<std::int16_t, vibe::kJointCount>& axes) {
    Bytes held;
    const auto put = [&held](auto value) {
      const auto* bytes = reinterpret_cast<const std::uint8_t*>(&value);
      held.insert(held.end(), bytes, bytes + sizeof value);
    };
    for (const std::int16_t axis : axes) put(axis);
    put(std::uint16_t{0});
    for (const std::uint32_t key : keys) put(key);
    if (held != last_) ++commands;
    last_.swap(held);
    held.clear();
    put(std::uint8_t{4});
    put(static_cast<std::uint8_t>(keys.size()));
    put(std::uint16_t{0});
    put(grant_);
    put(++number_);
    held.insert(held.end(), last_.begin(), last_.end());
    write(held);
  }

  void write(const Bytes& bytes) { stream_.write(asio::buffer(bytes)); }
};

}  // namespace

int main(int argc, char** argv) try {
  if (argc != 2) return 2;
  PageHand hand(argv[1]);
  vibe::test::BiteOperator person(hand);
  const std::string failure = person.bite();
  std::printf("| the page | %.1f | %d | %.2f |\n%s\n", person.seconds(), hand.commands, person.force(),
              failure.c_str());
  return failure.empty() ? 0 : 1;
} catch (const std::exception& error) {
  std::printf("%s\n", error.what());
  return 1;
}
