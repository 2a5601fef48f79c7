#include <ros/console.h>

#include "simulation/scene_source.hpp"
#include "simulator/simulation_thread.hpp"
#include "vibe_core/constraints/breathing.hpp"
#include "vibe_core/files/number_text.hpp"
#include "vibe_core/program/error.hpp"
#include "vibe_core/simulation/simulator.hpp"
#include "vibe_core/simulation/snapshot.hpp"
#include "vibe_ros_utils/wall_clock.hpp"

// The commands of SimulationThread: what other threads ask for, and how the stepping thread does it between two steps.

namespace vibe::sim {

namespace {

const Reply kShuttingDown{false, "The simulator is shutting down."};

std::string seconds(double time) {
  return formatted("%.3f s", time);
}

}  // namespace

Reply SimulationThread::post(Command command) {
  auto answer = std::make_shared<Answer>();
  std::future<Reply> reply = answer->get_future();
  {
    std::lock_guard<std::mutex> lock(mutex_);
    if (!accepting_) return kShuttingDown;
    commands_.emplace_back(std::move(command), answer);
    asked_ = true;
  }
  changed_.notify_all();
  return reply.get();
}

Reply SimulationThread::call(std::function<Reply()> work) {
  return post([work = std::move(work)](const std::shared_ptr<Answer>& answer) {
    try {
      answer->set_value(work());
    } catch (const std::exception& error) {
      answer->set_value({false, error.what()});
    }
  });
}

void SimulationThread::serveCommands() {
  if (!asked_) return;
  std::unique_lock<std::mutex> lock(mutex_);
  asked_ = false;  // whoever asks from now on sets it again
  while (!commands_.empty()) {
    const auto [command, answer] = std::move(commands_.front());
    commands_.pop_front();
    lock.unlock();
    command(answer);
    lock.lock();
  }
}

void SimulationThread::rejectCommands() {
  std::lock_guard<std::mutex> lock(mutex_);
  accepting_ = false;
  for (auto& [command, answer] : commands_) answer->set_value(kShuttingDown);
  commands_.clear();
  answerSteps(kShuttingDown);
}

void SimulationThread::answerSteps(const Reply& reply) {
  steps_left_ = 0;
  if (steps_answer_) steps_answer_->set_value(reply);
  steps_answer_.reset();
}

Reply SimulationThread::setPaused(bool paused) {
  return call([this, paused] { return changePause(paused); });
}

Reply SimulationThread::changePause(bool paused) {
  if (status_.paused == paused) return {true, paused ? "It is paused already." : "It is running already."};
  status_.paused = paused;
  hold_ = Hold::None;  // whoever resumes gives the inputs the full time to come
  if (!paused) pace_.restart(ros_utils::wallTime());
  publishers_.procedureState(simulation_, status_);
  return {true, (paused ? "Paused at " : "Running from ") + seconds(simulation_.state().time) + "."};
}

Reply SimulationThread::takeSteps(std::uint32_t n) {
  return post([this, n](const std::shared_ptr<Answer>& answer) {
    if (n == 0) {
      answer->set_value({false, "There is nothing to do for 0 steps; ask for 1 or more."});
    } else if (!status_.paused) {
      answer->set_value({false, "Single steps are for a paused simulation; call the service pause first."});
    } else if (steps_left_ > 0) {
      answer->set_value({false, "Steps that another caller asked for are still being taken; try again later."});
    } else {
      steps_asked_ = steps_left_ = n;
      steps_answer_ = answer;
      hold_ = Hold::None;
      pace_.restart(ros_utils::wallTime());
    }
  });
}

// A part of the input in force, so that applied_input has it and a replay repeats it.
Reply SimulationThread::holdBreath(bool held) {
  return call([this, held]() -> Reply {
    const std::string refusal = breathRefusal(simulation_.model().scene);
    if (!refusal.empty()) return {false, refusal};
    StepInput input = simulation_.input();
    input.breath = held ? Breath::Held : Breath::Free;
    simulation_.setInput(input);
    return {true, (held ? "The breath is held from " : "It breathes from ") + seconds(simulation_.state().time) + "."};
  });
}

Reply SimulationThread::reset(std::uint64_t seed, bool keep_time) {
  return call([this, seed, keep_time]() -> Reply {
    if (!keep_time && parameters_.time_source == TimeSource::Wall) {
      return {false, "The wall clock cannot be set back; reset with keep_time true."};
    }
    const Model& model = simulation_.model();
    simulation_.replaceState(initialState(model, seed != 0 ? seed : model.scene.seed));
    if (!keep_time) {
      simulation_.restartTime(kEpoch);
      queue_.clear();
    }
    afterReplacement();
    return {true, "Reset to the initial state with seed " + std::to_string(simulation_.state().seed) + "."};
  });
}

void SimulationThread::afterReplacement() {
  interpreter_.endMoves();
  status_.scope_moves = status_.suturing_device_moves = false;
  pace_.restart(ros_utils::wallTime());
  publishers_.announceRun(simulation_);
  publishers_.wholeState(simulation_, status_);
}

Reply SimulationThread::saveSnapshot(const std::string& file) {
  // copying is quick, writing may not be: only the copy holds up the stepping
  std::shared_ptr<const Model> model;
  State state;
  Reply copied = call([&]() -> Reply {
    model = simulation_.sharedModel();
    state = simulation_.state();
    return {true, ""};
  });
  if (!copied.success) return copied;
  try {
    vibe::saveSnapshot(*model, state, file);
  } catch (const Error& error) {
    return {false, error.what()};
  }
  return {true, "Saved the state at " + seconds(state.time) + " to '" + file + "'."};
}

Reply SimulationThread::loadSnapshot(const std::string& file, OtherScene other) {
  return call([this, file, other]() -> Reply {
    simulation_.replaceState(vibe::loadSnapshot(simulation_.model(), file, other));
    afterReplacement();
    return {true, "Loaded the state at " + seconds(simulation_.state().time) + " from '" + file + "'."};
  });
}

Reply SimulationThread::loadScene(const std::string& address) {
  SceneModel made;
  try {
    made = loadModel(address, "");
  } catch (const std::exception& error) {
    return {false, error.what()};
  }
  return call([this, made]() -> Reply {
    const double left = static_cast<double>(last_step_ - statistics_.steps) * simulation_.time().period();
    simulation_.replaceModel(made);
    if (last_step_ > 0) last_step_ = statistics_.steps + stepsIn(left, simulation_.time().period());
    pace_.forgetSamples();
    publishers_.announceModel(simulation_);
    afterReplacement();
    simulation_.warmUp();
    pace_.restart(ros_utils::wallTime());
    return {true, "Simulating '" + made.model->scene.name + "' with " + std::to_string(made.model->particle_count) +
                      " particles."};
  });
}

}  // namespace vibe::sim
