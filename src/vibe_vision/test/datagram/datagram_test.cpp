#include "vibe_vision/datagram/datagram.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "vibe_core/program/error.hpp"

namespace vibe::vision::datagram_test {
namespace {

CoordinateSample randomCoordinate(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  CoordinateSample sample{normal(random), normal(random), normal(random), normal(random), {}};
  for (float& value : sample.covariance) value = static_cast<float>(normal(random));
  return sample;
}

TrackDatagram randomDatagram(std::mt19937_64& random, std::size_t instruments) {
  std::uniform_real_distribution<double> uniform(0, 2e9);
  TrackDatagram datagram;
  datagram.sequence = static_cast<std::uint32_t>(random());
  datagram.exposure = static_cast<float>(uniform(random));
  datagram.frame_sequence = random();
  datagram.stamp = uniform(random);
  datagram.age = static_cast<float>(uniform(random));
  datagram.jerk_time = static_cast<float>(uniform(random));
  for (std::size_t i = 0; i < instruments; ++i) {
    InstrumentSample sample;
    sample.tracked = random() % 2 == 0;
    sample.reason = static_cast<std::uint8_t>(random());
    sample.has_rotation = random() % 2 == 0;
    sample.score = static_cast<float>(uniform(random));
    sample.slide = randomCoordinate(random);
    sample.rotation = randomCoordinate(random);
    datagram.instruments.push_back(sample);
  }
  return datagram;
}

TEST(Datagram, DecodesWhatWasEncoded) {
  std::mt19937_64 random(1);
  for (std::size_t run = 0; run < 500; ++run) {
    const TrackDatagram datagram = randomDatagram(random, run % (kMaxInstruments + 1));
    const std::vector<std::uint8_t> bytes = encode(datagram);
    EXPECT_EQ(bytes.size(), kDatagramHeader + datagram.instruments.size() * kDatagramInstrument);
    const auto decoded = decode(bytes.data(), bytes.size());
    ASSERT_TRUE(decoded);
    EXPECT_EQ(encode(*decoded), bytes);
  }
}

TEST(Datagram, BytesAreThoseOfTheDocumentation) {
  TrackDatagram datagram;
  datagram.sequence = 0x04030201;
  datagram.exposure = 1;
  datagram.frame_sequence = 0x0807060504030201;
  datagram.stamp = 1;
  datagram.age = -2;
  datagram.jerk_time = 0.5;
  datagram.instruments.resize(1);
  InstrumentSample& sample = datagram.instruments[0];
  sample.tracked = true;
  sample.reason = 5;
  sample.has_rotation = true;
  sample.score = 1;
  sample.slide = {1, 2, 4, 8, {1}};
  sample.rotation = {8, 4, 2, 1, {1}};
  sample.slide.covariance.back() = sample.rotation.covariance.back() = 1;
  std::vector<std::uint8_t> expected(192, 0);
  const auto put = [&](std::size_t offset, std::initializer_list<int> bytes) {
    for (const int byte : bytes) expected[offset++] = static_cast<std::uint8_t>(byte);
  };
  put(0, {'V', 'I', 'B', 'T', 1, 0, 1, 0, 1, 2, 3, 4, 0, 0, 0x80, 0x3f});
  put(16, {1, 2, 3, 4, 5, 6, 7, 8, 0, 0, 0, 0, 0, 0, 0xf0, 0x3f});
  put(32, {0, 0, 0, 0xc0, 0, 0, 0, 0x3f});
  put(40, {1, 5, 1, 0, 0, 0, 0x80, 0x3f});
  put(48, {0, 0, 0, 0, 0, 0, 0xf0, 0x3f, 0, 0, 0, 0, 0, 0, 0, 0x40});
  put(64, {0, 0, 0, 0, 0, 0, 0x10, 0x40, 0, 0, 0, 0, 0, 0, 0x20, 0x40});
  put(120, {0, 0, 0, 0, 0, 0, 0x20, 0x40, 0, 0, 0, 0, 0, 0, 0x10, 0x40});
  put(136, {0, 0, 0, 0, 0, 0, 0, 0x40, 0, 0, 0, 0, 0, 0, 0xf0, 0x3f});
  for (const std::size_t offset : {80, 116, 152, 188}) put(offset, {0, 0, 0x80, 0x3f});
  EXPECT_EQ(encode(datagram), expected);
}

TEST(Datagram, NumbersThatAreNotFiniteSurvive) {
  TrackDatagram datagram;
  datagram.instruments.resize(1);
  datagram.instruments[0].slide.position = std::numeric_limits<double>::quiet_NaN();
  datagram.instruments[0].slide.covariance[9] = std::numeric_limits<float>::infinity();
  const auto bytes = encode(datagram);
  const auto decoded = decode(bytes.data(), bytes.size());
  ASSERT_TRUE(decoded);
  EXPECT_TRUE(std::isnan(decoded->instruments[0].slide.position));
  EXPECT_TRUE(std::isinf(decoded->instruments[0].slide.covariance[9]));
}

TEST(Datagram, EveryOtherLengthIsRefused) {
  std::mt19937_64 random(2);
  std::vector<std::uint8_t> bytes = encode(randomDatagram(random, 2));
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    const std::vector<std::uint8_t> part(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    EXPECT_FALSE(decode(part.data(), part.size())) << size;
  }
  bytes.push_back(0);
  EXPECT_FALSE(decode(bytes.data(), bytes.size()));
  EXPECT_FALSE(decode(nullptr, 0));
}

TEST(Datagram, WhatIsNotOfThisVersionIsRefused) {
  std::mt19937_64 random(3);
  const std::vector<std::uint8_t> bytes = encode(randomDatagram(random, 1));
  ASSERT_TRUE(decode(bytes.data(), bytes.size()));
  // magic, version, instruments, padding; tracked, has_rotation, padding of the instrument
  for (const std::size_t offset : {0, 1, 2, 3, 4, 5, 6, 7, 40, 42, 43}) {
    std::vector<std::uint8_t> changed = bytes;
    changed[offset] = static_cast<std::uint8_t>(changed[offset] + 2);
    EXPECT_FALSE(decode(changed.data(), changed.size())) << offset;
  }
}

TEST(Datagram, TooManyInstrumentsAreAnError) {
  TrackDatagram datagram;
  datagram.instruments.resize(kMaxInstruments);
  EXPECT_LE(encode(datagram).size(), 1472u);  // one Ethernet frame
  datagram.instruments.resize(kMaxInstruments + 1);
  EXPECT_THROW(encode(datagram), Error);
}

}  // namespace
}  // namespace vibe::vision::datagram_test
