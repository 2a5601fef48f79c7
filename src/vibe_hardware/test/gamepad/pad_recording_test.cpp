#include "vibe_hardware/gamepad/pad_recording.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "gamepad/pads.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::hardware::pad_recording_test {
namespace {

/// As evemu-record writes it.
const char* const kRecording =
    "# EVEMU 1.3\n"
    "# Kernel: 6.1.0\n"
    "N: Test pad\n"
    "I: 0003 045e 028e 0114\n"
    "P: 00 00 00 00 00 00 00 00\n"
    "B: 00 0b 00 00 00 00 00 00 00\n"
    "B: 01 00 00 00 00 00 00 00 00\n"
    "B: 01 00 00 00 00 00 00 00 00\n"
    "B: 01 00 00 00 00 00 00 00 00\n"
    "B: 01 00 00 00 00 00 00 00 00\n"
    "B: 01 00 00 00 00 00 00 03 00\n"
    "A: 00 -32768 32767 16 128 0\n"
    "A: 01 0 255 0 15 0\n"
    "E: 10.000000 0003 0000 -1200\n"
    "E: 10.000000 0000 0000 0\n"
    "E: 10.500000 0001 0130 1\n"
    "E: 11.000000 0001 0130 0\n";

std::string errorOf(const std::string& text) {
  try {
    parsePadRecording(text, "pad.evemu");
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

TEST(PadRecording, ReadsTheFormatOfEvemu) {
  const PadRecording recording = parsePadRecording(kRecording, "pad.evemu");
  EXPECT_EQ(recording.info.name, "Test pad");
  EXPECT_EQ(recording.info.vendor, 0x045e);
  EXPECT_EQ(recording.info.product, 0x028e);
  ASSERT_EQ(recording.state.axes.size(), 2u);
  EXPECT_EQ(recording.state.axes.at(ABS_Y).maximum, 255);
  EXPECT_NEAR(recording.state.axes.at(ABS_X).deflection(), 0, 1e-4);
  ASSERT_EQ(recording.state.buttons.size(), 2u);
  EXPECT_EQ(recording.state.buttons.count(BTN_SOUTH), 1u);
  EXPECT_EQ(recording.state.buttons.count(BTN_EAST), 1u);
  ASSERT_EQ(recording.events.size(), 4u);
  EXPECT_EQ(recording.events[0].value, -1200);
  EXPECT_DOUBLE_EQ(recording.events[2].time, 10.5);
  EXPECT_EQ(recording.events[2].code, BTN_SOUTH);
}

TEST(PadRecording, PlaysEventsWhenTheyAreDueAndEnds) {
  const auto pad = playPadRecording(parsePadRecording(kRecording, "pad.evemu"));
  EXPECT_TRUE(pad->update(100));
  EXPECT_EQ(pad->state().axes.at(ABS_X).value, -1200);
  EXPECT_TRUE(pad->update(100.49));
  EXPECT_FALSE(pad->state().buttons.at(BTN_SOUTH).down);
  EXPECT_TRUE(pad->update(100.51));
  EXPECT_TRUE(pad->state().buttons.at(BTN_SOUTH).isPressed());
  EXPECT_TRUE(pad->update(101.01));
  EXPECT_FALSE(pad->state().buttons.at(BTN_SOUTH).down);
  EXPECT_FALSE(pad->update(101.02));
}

// The format has no state at the beginning: an axis rests, as a stick or as a trigger, until its first event.
TEST(PadRecording, AnAxisRestsUntilItIsMoved) {
  const std::string text = std::string("A: 02 0 255 0 0 0\nA: 05 10 10 0 0 0\n") + kRecording;
  const auto pad = playPadRecording(parsePadRecording(text + "E: 12 0003 0002 64\n", "pad.evemu"));
  EXPECT_TRUE(pad->update(100));
  EXPECT_EQ(pad->state().axes.count(ABS_RZ), 0U) << "an axis without a range is none";
  EXPECT_EQ(pad->state().axes.at(ABS_Z).pressure(), 0);
  EXPECT_EQ(pad->state().axes.at(ABS_Z).deflection(), 0);
  EXPECT_EQ(pad->state().axes.at(ABS_Y).deflection(), 0);
  EXPECT_LT(pad->state().axes.at(ABS_X).deflection(), 0) << "moved";
  EXPECT_TRUE(pad->update(103));
  EXPECT_NEAR(pad->state().axes.at(ABS_Z).pressure(), 0.25, 1e-2);
}

TEST(PadRecording, WhatIsWrittenIsReadAgain) {
  const std::string file = testing::TempDir() + "/pad_recording_test.evemu";
  PadState pad = twoStickPad();
  pad.axes[ABS_RY].value = 4321;
  {
    PadRecorder recorder(file, parsePadRecording(kRecording, "").info, pad);
    recorder.add({500.25, EV_ABS, ABS_X, -77});
    recorder.add({500.25, EV_SYN, SYN_REPORT, 0});
    recorder.add({501.5, EV_KEY, BTN_START, 1});
  }
  const PadRecording read = loadPadRecording(file);
  EXPECT_EQ(read.info.name, "Test pad");
  EXPECT_EQ(read.info.path, file);
  ASSERT_EQ(read.state.axes.size(), pad.axes.size());
  for (const auto& [code, axis] : pad.axes) {
    EXPECT_EQ(read.state.axes.at(code).minimum, axis.minimum);
    EXPECT_EQ(read.state.axes.at(code).maximum, axis.maximum);
  }
  EXPECT_EQ(read.state.buttons.size(), pad.buttons.size());
  EXPECT_DOUBLE_EQ(read.events.back().time, 1.25);
  const auto played = playPadRecording(read);
  EXPECT_TRUE(played->update(0));
  EXPECT_EQ(played->state().axes.at(ABS_RY).value, 4321);  // where the stick was at the beginning
  EXPECT_EQ(played->state().axes.at(ABS_X).value, -77);
  EXPECT_TRUE(played->update(2));
  EXPECT_TRUE(played->state().buttons.at(BTN_START).isPressed());
  std::remove(file.c_str());
}

TEST(PadRecording, AFileIsCheckedBeforeThereIsAPadAndStaysAsItIs) {
  const std::string file = testing::TempDir() + "/pad_recording_check.evemu";
  std::filesystem::remove(file);
  PadRecorder::checkFile(file);
  EXPECT_FALSE(std::filesystem::exists(file));
  std::ofstream(file) << "an older recording";
  PadRecorder::checkFile(file);
  EXPECT_EQ(std::filesystem::file_size(file), 18U);
  std::filesystem::remove(file);
  for (const auto& [place, why] :
       {std::pair<std::string, std::string>{"/nowhere/pad.evemu", "No such file or directory"},
        {testing::TempDir(), "Is a directory"}}) {
    try {
      PadRecorder::checkFile(place);
      ADD_FAILURE() << place;
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()),
                "Cannot write the pad recording '" + place + "' (" + why + "); choose another file.");
    }
  }
}

TEST(PadRecording, NamesTheLineOfAMistake) {
  EXPECT_EQ(errorOf(kRecording), "no error");
  EXPECT_NE(errorOf("N: x\n").find("pad.evemu: has no events"), std::string::npos);
  EXPECT_NE(errorOf("# a\nhello\n").find("pad.evemu:2: is no line of a recording"), std::string::npos);
  EXPECT_NE(errorOf("Q: 1\n").find("pad.evemu:1: begins with the unknown letter 'Q'"), std::string::npos);
  EXPECT_NE(errorOf("I: 1 2\n").find("needs four hexadecimal numbers"), std::string::npos);
  EXPECT_NE(errorOf("A: 00 6 5\n").find("minimum that is above"), std::string::npos);
  EXPECT_NE(errorOf("A: ff 0 5\n").find("needs a code"), std::string::npos);
  EXPECT_NE(errorOf("B: 99 00\n").find("needs an event type"), std::string::npos);
  EXPECT_NE(errorOf("B: 01 100\n").find("from 00 to ff"), std::string::npos);
  EXPECT_NE(errorOf("B: 01 zz\n").find("not a byte"), std::string::npos);
  EXPECT_NE(errorOf("E: 1.0 0003 0000\n").find("needs a time"), std::string::npos);
  EXPECT_NE(errorOf("E: 2 0003 0000 1\nE: 1 0003 0000 1\n").find(":2: goes back in time"), std::string::npos);
  EXPECT_NE(errorOf("E: nan 0003 0000 1\n").find(":1: "), std::string::npos);
  EXPECT_NE(errorOf("E: 0 0003 0000 1\nE: 1e9 0003 0000 1\n").find("more than a day"), std::string::npos);
}

}  // namespace
}  // namespace vibe::hardware::pad_recording_test
