// Devices behind local sockets: both sides of the protocol, and what peers may do that do not keep to it.
#include "vibe_hardware/hid/socket_bus.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>

#include <fstream>
#include <random>

#include "emulator/fake_function.hpp"
#include "emulator/served_device.hpp"
#include "hid/transport.hpp"

namespace vibe::hardware::socket_bus_test {
namespace {

using test::FakeFunction;
using test::ServedDevice;
using test::SocketFolder;
using Bytes = std::vector<std::uint8_t>;

struct Bench {
  SocketFolder folder;
  FakeFunction function;
  std::unique_ptr<ServedDevice> device = std::make_unique<ServedDevice>(folder.path(), "haptic", function);
  SocketBus bus{folder.path()};
  std::string path = folder.path() + "/haptic.hid";
};

Bytes readReport(HidPort& port, double timeout = 1) {
  Bytes report(64);
  report.resize(port.read(report.data(), report.size(), timeout));
  return report;
}

void waitFor(const std::function<bool()>& condition) {
  for (int i = 0; i < 2000 && !condition(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  ASSERT_TRUE(condition());
}

void sendRaw(int file, const Bytes& packet) {
  ::send(file, packet.data(), packet.size(), MSG_NOSIGNAL);
}

TEST(SocketBus, ListsWhatADeviceSaysOfItself) {
  Bench bench;
  const std::vector<HidInfo> found = bench.bus.list();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].path, bench.path);
  EXPECT_EQ(found[0].vendor, vibe_firmware::kVendorId);
  EXPECT_EQ(found[0].product, vibe_firmware::kHapticProductId);
  EXPECT_EQ(found[0].serial, "F-1");
  EXPECT_EQ(found[0].name, "fake");
}

TEST(SocketBus, SendsTheReportDescriptorOfTheFirmware) {
  Bench bench;
  const FileDescriptor file = connectTo(bench.path);
  ASSERT_TRUE(waitReadable(file.get(), 1));
  Bytes packet(kMaxPacket);
  packet.resize(static_cast<std::size_t>(::recv(file.get(), packet.data(), packet.size(), 0)));
  const auto hello = unpackHello(packet.data(), packet.size());
  ASSERT_TRUE(hello);
  EXPECT_EQ(bench.bus.open(bench.path)->reportDescriptor(), hello->report_descriptor);
  EXPECT_EQ(hello->report_descriptor, Bytes(std::begin(vibe_firmware::kHapticReportDescriptor),
                                            std::end(vibe_firmware::kHapticReportDescriptor)));
}

TEST(SocketBus, AFolderThatDoesNotExistHasNoDevices) {
  EXPECT_TRUE(SocketBus("/tmp/no such folder").list().empty());
  EXPECT_THROW(SocketBus("/dev/null").list(), std::runtime_error);
}

TEST(SocketBus, DoesNotListWhatIsNoDevice) {
  Bench bench;
  { const FileDescriptor stale = listenAt(bench.folder.path() + "/stale.hid"); }  // its file remains
  const FileDescriptor silent = listenAt(bench.folder.path() + "/silent.hid");
  std::ofstream(bench.folder.path() + "/file.hid") << "text";
  std::filesystem::create_directory(bench.folder.path() + "/folder.hid");
  const std::vector<HidInfo> found = bench.bus.list();
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].path, bench.path);
  EXPECT_THROW(bench.bus.open(bench.folder.path() + "/stale.hid"), DeviceGone);
  EXPECT_THROW(bench.bus.open(bench.folder.path() + "/silent.hid"), DeviceGone);
  EXPECT_THROW(bench.bus.open(bench.folder.path() + "/file.hid"), DeviceGone);
  EXPECT_THROW(bench.bus.open(bench.folder.path() + "/none.hid"), DeviceGone);
}

TEST(SocketBus, ADeviceOfAnotherReleaseIsReportedIfItIsTheOnlyOne) {
  SocketFolder folder;
  const FileDescriptor listener = listenAt(folder.path() + "/old.hid");
  Bytes hello = packHello({1, 2, "serial", "name", Bytes(100, 7)});
  const auto listGreetedWith = [&](const Bytes& greeting) {
    std::thread device([&] {
      waitReadable(listener.get(), 5);
      const FileDescriptor file(::accept(listener.get(), nullptr, nullptr));
      sendRaw(file.get(), greeting);
    });
    std::string said;
    try {
      said = std::to_string(SocketBus(folder.path()).list().size()) + " listed";
    } catch (const std::runtime_error& error) {
      said = error.what();
    }
    device.join();
    return said;
  };
  EXPECT_EQ(listGreetedWith(hello), "1 listed");
  ++hello[1];  // version of the protocol
  const std::string sentence =
      "Socket " + folder.path() +
      "/old.hid does not answer as a device of this release; start the emulator of the same release.";
  EXPECT_EQ(listGreetedWith(hello), sentence);
  EXPECT_EQ(listGreetedWith({}), "0 listed") << "it may be about to end";
  FakeFunction function;
  const ServedDevice good(folder.path(), "haptic", function);
  EXPECT_EQ(listGreetedWith(hello), "1 listed");
}

TEST(SocketBus, ExchangesFeatureReports) {
  Bench bench;
  const auto port = bench.bus.open(bench.path);
  Bytes report(64);
  for (std::uint8_t i = 0; i < 100; ++i) {
    const std::uint8_t sent[] = {2, i, 5, 6};
    port->setFeature(sent, sizeof sent);
    ASSERT_EQ(port->getFeature(2, report.data(), report.size()), 4U);
    ASSERT_EQ(Bytes(report.begin(), report.begin() + 4), Bytes({2, i, 5, 6}));
  }
  EXPECT_EQ(port->getFeature(3, report.data(), report.size()), 2U);
  EXPECT_EQ(report[1], 7);
}

TEST(SocketBus, AStallIsARejectedReport) {
  Bench bench;
  const auto port = bench.bus.open(bench.path);
  Bytes report(64);
  EXPECT_THROW(port->getFeature(9, report.data(), report.size()), ReportRejected);
  const std::uint8_t unknown[] = {9, 1}, truncated[] = {2, 1};
  EXPECT_THROW(port->setFeature(unknown, sizeof unknown), ReportRejected);
  EXPECT_THROW(port->setFeature(truncated, sizeof truncated), ReportRejected);
  EXPECT_THROW(port->setFeature(unknown, 0), ReportRejected);
  EXPECT_EQ(port->getFeature(2, report.data(), report.size()), 4U);  // and goes on
}

TEST(SocketBus, EveryHostGetsEveryReportInOrder) {
  Bench bench;
  const auto a = bench.bus.open(bench.path), b = bench.bus.open(bench.path);
  EXPECT_TRUE(readReport(*a, 0).empty());
  for (std::uint8_t i = 0; i < 50; ++i) {
    bench.device->publish({1, i});
    if (i % 7 != 0) continue;
    Bytes report(64);
    a->getFeature(2, report.data(), report.size());  // in between, without losing one
  }
  for (HidPort* port : {a.get(), b.get()})
    for (std::uint8_t i = 0; i < 50; ++i) ASSERT_EQ(readReport(*port), Bytes({1, i}));
}

TEST(SocketBus, AHostThatDoesNotReadLosesTheOldestReports) {
  Bench bench;
  const auto idle = bench.bus.open(bench.path), reader = bench.bus.open(bench.path);
  const int count = 2000;
  for (int i = 0; i < count; ++i) {
    bench.device->publish({1, static_cast<std::uint8_t>(i), static_cast<std::uint8_t>(i >> 8)});
    ASSERT_EQ(readReport(*reader)[1], static_cast<std::uint8_t>(i));  // the other host loses nothing
  }
  std::uint64_t dropped = 0;
  bench.device->with([&](SocketServer& server) { dropped = server.droppedReports(); });
  int received = 0, last = -1;
  for (Bytes report = readReport(*idle); !report.empty(); report = readReport(*idle, 0.05)) {
    const int number = report[1] | report[2] << 8;
    ASSERT_GT(number, last);
    last = number;
    ++received;
  }
  EXPECT_EQ(last, count - 1);
  EXPECT_GE(received, static_cast<int>(SocketServer::kMaxWaitingReports));
  EXPECT_EQ(received + static_cast<int>(dropped), count);
  EXPECT_GT(dropped, 1500U);
}

TEST(SocketBus, AHostThatFloodsWithoutReadingIsExpelled) {
  Bench bench;
  const auto good = bench.bus.open(bench.path);
  const FileDescriptor bad = connectTo(bench.path);
  std::uint64_t expelled = 0;
  waitFor([&] {
    for (int i = 0; i < 20; ++i) ::send(bad.get(), "G\1\2", 3, MSG_NOSIGNAL | MSG_DONTWAIT);
    bench.device->with([&](SocketServer& server) { expelled = server.expelledHosts(); });
    return expelled == 1;
  });
  Bytes report(64);
  EXPECT_EQ(good->getFeature(2, report.data(), report.size()), 4U);
}

TEST(SocketBus, NoPacketOfAHostHarmsTheDevice) {
  Bench bench;
  const auto good = bench.bus.open(bench.path);
  std::mt19937 random(1);
  for (int i = 0; i < 300; ++i) {
    const FileDescriptor bad = connectTo(bench.path);
    Bytes packet(random() % 3 == 0 ? random() % 9000 : random() % 12);
    for (auto& byte : packet) byte = static_cast<std::uint8_t>(random());
    const char kinds[] = "GSIRHgs";
    if (!packet.empty()) packet[0] = static_cast<std::uint8_t>(kinds[random() % 7]);
    sendRaw(bad.get(), packet);
    Bytes report(64);
    ASSERT_EQ(good->getFeature(2, report.data(), report.size()), 4U);
  }
  waitFor([&] { return bench.device->hostCount() == 1; });
  std::uint64_t expelled = 0;
  bench.device->with([&](SocketServer& server) { expelled = server.expelledHosts(); });
  EXPECT_GT(expelled, 100U);
}

TEST(SocketBus, TakesNoMoreHostsThanItsLimit) {
  Bench bench;
  std::vector<std::unique_ptr<HidPort>> ports;
  for (std::size_t i = 0; i < SocketServer::kMaxHosts; ++i) ports.push_back(bench.bus.open(bench.path));
  EXPECT_THROW(bench.bus.open(bench.path), DeviceGone);
  ports.pop_back();
  waitFor([&] { return bench.device->hostCount() < SocketServer::kMaxHosts; });
  EXPECT_NO_THROW(bench.bus.open(bench.path));
}

TEST(SocketBus, AnUnpluggedDeviceIsGoneAndComesBack) {
  Bench bench;
  for (int i = 0; i < 20; ++i) {
    const auto port = bench.bus.open(bench.path);
    bench.device->publish({1, 1});
    ASSERT_EQ(readReport(*port).size(), 2U);
    bench.device.reset();
    Bytes report(64);
    EXPECT_THROW(readReport(*port), DeviceGone);
    EXPECT_THROW(port->getFeature(2, report.data(), report.size()), DeviceGone);
    EXPECT_THROW(bench.bus.open(bench.path), DeviceGone);
    EXPECT_TRUE(bench.bus.list().empty());
    bench.device = std::make_unique<ServedDevice>(bench.folder.path(), "haptic", bench.function);
    EXPECT_EQ(bench.bus.list().size(), 1U);
  }
}

TEST(SocketBus, SaysWhereADeviceIsMissingAndWhatToStart) {
  SocketFolder folder;
  const std::string place = folder.path() + "/not_there";
  const std::string start =
      "; start 'vibe_emulator --folder " + place + "', its devices are used as soon as they appear.";
  SocketBus bus(place);
  EXPECT_TRUE(bus.list().empty());
  EXPECT_EQ(bus.remedyOfAbsence(), ": the folder " + place + " does not exist" + start);
  std::filesystem::create_directory(place);
  EXPECT_TRUE(bus.list().empty());
  EXPECT_EQ(bus.remedyOfAbsence(), ": no emulator serves the folder " + place + start);
  FakeFunction function;
  const ServedDevice device(place, "haptic", function);
  EXPECT_EQ(bus.list().size(), 1U);
  EXPECT_EQ(bus.remedyOfAbsence(),
            " in the folder " + place + "; compare the id and the serial number with those that its emulator prints.");
}

// A device that says nothing sensible: truncated and random greetings, and random packets after a good one.
TEST(SocketBus, NoPacketOfADeviceHarmsTheHost) {
  SocketFolder folder;
  const std::string path = folder.path() + "/bad.hid";
  const FileDescriptor listener = listenAt(path);
  const Packet good = packHello({1, 2, "serial", "name", Bytes(100, 7)});
  ASSERT_TRUE(unpackHello(good.data(), good.size()));
  std::mt19937 random(2);
  for (int i = 0; i < 200; ++i) {
    const bool greets = i % 2 == 0;
    std::thread device([&, seed = random()] {
      std::mt19937 own(seed);
      waitReadable(listener.get(), 5);
      const FileDescriptor file(::accept(listener.get(), nullptr, nullptr));
      Bytes packet = good;
      if (!greets && own() % 2 == 0) packet.resize(own() % good.size());
      if (!greets && packet.size() == good.size())
        packet[own() % 8 == 0 ? 1 : 6] ^= static_cast<std::uint8_t>(1 + own() % 255);
      sendRaw(file.get(), packet);
      Bytes noise(1 + own() % 40);
      for (auto& byte : noise) byte = static_cast<std::uint8_t>(own());
      noise[0] = own() % 2 == 0 ? 'I' : 'X';
      noise.resize(noise[0] == 'I' ? 1 : noise.size());
      sendRaw(file.get(), noise);
    });
    Bytes report(64);
    EXPECT_THROW(readReport(*SocketBus(folder.path()).open(path)), DeviceGone);
    device.join();
  }
}

TEST(SocketServer, ReplacesAStaleSocketAndNothingElse) {
  SocketFolder folder;
  FakeFunction function;
  UsbHost host(function);
  { const FileDescriptor stale = listenAt(folder.path() + "/a.hid"); }
  EXPECT_NO_THROW(SocketServer(folder.path(), "a", host));
  const SocketServer first(folder.path(), "a", host);
  EXPECT_THROW(SocketServer(folder.path(), "a", host), std::runtime_error);
  std::ofstream(folder.path() + "/b.hid") << "text";
  EXPECT_THROW(SocketServer(folder.path(), "b", host), std::runtime_error);
  EXPECT_TRUE(std::filesystem::exists(folder.path() + "/b.hid"));
  EXPECT_THROW(SocketServer(folder.path(), std::string(120, 'x'), host), std::runtime_error);
  EXPECT_THROW(SocketServer("/proc/nothing", "a", host), std::runtime_error);
}

}  // namespace
}  // namespace vibe::hardware::socket_bus_test
