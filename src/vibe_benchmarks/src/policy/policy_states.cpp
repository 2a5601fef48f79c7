#include "policy/policy_states.hpp"

#include <algorithm>

#include "contact/bench_tools.hpp"
#include "contact/contact_table.hpp"

namespace vibe::benchmarks {
namespace {

constexpr double kSweep = 0.7;          // of both angles of the tip, beyond those of a pressed scope [rad]
constexpr double kSweepTime = 0.4;      // [s]
constexpr double kRamSpeed = 0.5;       // [m/s]
constexpr double kRamWay = 0.06;        // [m]
constexpr double kRamTime = 0.4;        // until it is withdrawn again, and after it [s]
constexpr double kLowPressure = 130;    // 1 mmHg: walls of a fold meet [Pa]
constexpr double kDeflationTime = 1.5;  // [s]

/// The scope presses the wall and then slides along it.
ContactCase swept(ContactCase pressed) {
  pressed.name = "swept";
  pressed.input = [press = pressed.input, begin = pressed.duration](double end) {
    StepInput input = press(end);
    const double part = std::clamp((end - begin) / kSweepTime, 0.0, 1.0);
    input.joints[TipUpDown] += kSweep * part;
    input.joints[TipLeftRight] += kSweep * part;
    return input;
  };
  pressed.duration += kSweepTime + 0.1;
  return pressed;
}

/// The scope, straight, is pushed into the wall at a speed at which a step is longer than the wall is thick.
ContactCase rammed(ContactCase pressed) {
  pressed.name = "rammed";
  JointLimits limits = pressed.model->tool->limits()[Insertion];
  limits.velocity = std::max(limits.velocity, 1.01 * kRamSpeed);
  pressed.urdf = withJointLimits(pressed.urdf, "insertion", limits);
  pressed.input = [near = holdAt(pressed.start)](double end) {
    StepInput input = near;
    const double way = std::min(kRamWay, kRamSpeed * end), back = std::max(0.0, kRamSpeed * (end - kRamTime));
    input.joints[Insertion] += way - std::min(way, back);
    return input;
  };
  pressed.duration = 2 * kRamTime;
  return pressed;
}

/// The hand holds a fold while the stomach collapses around it.
ContactCase deflated(ContactCase wound) {
  wound.name = "deflated";
  auto model = std::make_shared<Model>();
  model->scene = wound.model->scene;
  model->organ = wound.model->organ;
  model->scene.gas->regulated_pressure = kLowPressure;
  finishModel(wound.urdf, *model);
  wound.model = model;
  wound.input = [still = wound.input(0)](double) { return still; };
  wound.duration = kDeflationTime;
  return wound;
}

}  // namespace

std::vector<ContactCase> policyStates(const Scene& scene, const std::string& urdf, std::ostream& log) {
  ContactStates states(scene, urdf, log);
  const ContactCase pressed = states.prepare("pressed"), wound = states.prepare("wound");
  return {pressed, swept(pressed), rammed(pressed), wound, deflated(wound), states.prepare("cinch1")};
}

std::string describePolicyStates() {
  return "  pressed, wound, cinch1  as those of `vibe_contact states`\n"
         "  swept                   pressed, then the tip is bent by 0.7 rad both ways in 0.4 s\n"
         "  rammed                  the scope, straight, is pushed 60 mm into the wall at 0.5 m/s and withdrawn\n"
         "  deflated                wound, held while the pressure falls to 1 mmHg\n"
         "  aimed                   joints for 64 targets of the tip, of which a quarter is out of reach\n";
}

}  // namespace vibe::benchmarks
