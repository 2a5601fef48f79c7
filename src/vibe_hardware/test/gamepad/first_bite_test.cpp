// The recorded pad session of the tutorial, in simulated time and without ROS: pad, mapping, simulator.

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "gamepad/pads.hpp"
#include "vibe_core/builder/model_builder.hpp"
#include "vibe_core/files/files.hpp"
#include "vibe_core/scene/scene_parser.hpp"
#include "vibe_core/simulation/simulation.hpp"
#include "vibe_hardware/gamepad/pad_recording.hpp"

namespace vibe::hardware::first_bite_test {
namespace {

using Kind = Event::Kind;

/// Plays a recorded pad on the default scene to its end; the events of the simulator.
std::vector<Event> playPad(const PadMapping& mapping, const std::string& recording) {
  const Scene scene = loadScene("../../vibe_core/scenes/stomach.yaml");
  Simulation simulation(buildModel(scene, readTextFile("../../vibe_description/urdf/scope.urdf", "URDF")));
  const auto pad = playPadRecording(loadPadRecording(recording));
  DriveState drive = startDrive(simulation.state().joints, mapping, pad->state());
  std::vector<Event> events;
  while (pad->update(simulation.time())) {
    drive = followJoints(simulation.state().joints, toolLimits(), drive);
    drive = advance(mapping, toolLimits(), pad->state(), drive, simulation.stepPeriod());
    StepInput input;
    input.joints = drive.joints;
    input.buttons = drive.buttons;
    const std::vector<Event>& news = simulation.step(input);
    events.insert(events.end(), news.begin(), news.end());
  }
  return events;
}

int count(const std::vector<Event>& events, Kind kind) {
  return static_cast<int>(
      std::count_if(events.begin(), events.end(), [kind](const Event& event) { return event.kind == kind; }));
}

TEST(FirstBite, TutorialSessionInsufflatesGrabsAndBites) {
  const std::vector<Event> events = playPad(shippedMapping("two_stick"), "../config/gamepads/first_bite.evemu");
  EXPECT_GE(count(events, Kind::PressureReached), 1);
  EXPECT_EQ(count(events, Kind::Grab), 1);
  EXPECT_EQ(count(events, Kind::HelixTurned), 1);
  EXPECT_EQ(count(events, Kind::Bite), 1);
  EXPECT_EQ(count(events, Kind::Release), 1);
  for (const Kind mistake : {Kind::GrabMissed, Kind::Slip, Kind::BiteMissed, Kind::BiteWithdrawn, Kind::Rejected})
    EXPECT_EQ(count(events, mistake), 0) << static_cast<int>(mistake);
}

}  // namespace
}  // namespace vibe::hardware::first_bite_test
