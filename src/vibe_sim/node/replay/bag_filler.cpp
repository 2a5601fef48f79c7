#include "replay/bag_filler.hpp"

#include <algorithm>

#include <rosbag/view.h>

#include "conversions/conversions.hpp"
#include "recording/bag_name.hpp"
#include "recording/recording.hpp"
#include "vibe_core/common/error.hpp"

namespace vibe::sim {

namespace {

bool isReplayed(const std::string& topic, const std::string& prefix) {
  const RecordingRule* rule = recordingRule(topic, "", {prefix});
  return rule != nullptr && rule->replayed;
}

bool hasClock(const Recording& recording) {
  return recording.view(rosbag::TopicQuery("/clock"))->size() > 0;
}

// Messages without an identity could not be told apart.
void checkAlone(const Recording& recording) {
  const auto& all = recording.sessions();
  if (std::count_if(all.begin(), all.end(), [&](const auto& each) { return each.prefix == recording.prefix(); }) > 1)
    throw Error("Recording '" + recording.file() + "' holds several sessions in the namespace '" +
                recording.session().nameSpace() +
                "', whose topics cannot be told apart; --fill needs one of one session.");
}

// An open bag with the name of the file while it is incomplete.
std::unique_ptr<rosbag::Bag> begin(const std::string& file) {
  claimBag(file);
  auto bag = std::make_unique<rosbag::Bag>();
  try {
    bag->open(file + ".active", rosbag::bagmode::Write);
    bag->setCompression(rosbag::compression::LZ4);
    return bag;
  } catch (const rosbag::BagException& error) {
    bag.release();  // NOLINT: see the destructor
    throw Error("'" + file + "' cannot be written (" + error.what() + "); give a path in a writable folder.");
  }
}

}  // namespace

BagFiller::BagFiller(const Recording& recording, const std::string& file)
    : recording_(recording),
      bag_(begin(file)),
      file_(file),
      target_{*bag_, recording.prefix(),
              [prefix = recording.prefix()](const std::string& topic) { return isReplayed(topic, prefix); }},
      publishers_(OutletSource(target_), hasClock(recording)) {
  checkAlone(recording);
}

// A bag is closed by its destructor, and one that cannot be written throws there, which ends the program.
BagFiller::~BagFiller() {
  if (failed_) {
    bag_.release();  // NOLINT: better lost than closed
    return;
  }
  try {
    bag_->close();
  } catch (const rosbag::BagException&) {
    bag_.release();  // NOLINT
  }
}

void BagFiller::fail(const std::string& why) {
  failed_ = true;
  throw Error("'" + file_ + ".active' breaks off (" + why + "); make room on the disk.");
}

void BagFiller::publish(const TimedSimulation& simulation, const std::function<void()>& send) {
  target_.time = toRosTime(simulation.now());
  try {
    send();
  } catch (const rosbag::BagException& error) {
    fail(error.what());
  }
}

void BagFiller::newModel(const TimedSimulation& simulation) {
  publish(simulation, [&] { publishers_.announceModel(simulation); });
}

void BagFiller::newState(const TimedSimulation& simulation) {
  publish(simulation, [&] { publishers_.wholeState(simulation, {}); });
}

void BagFiller::afterStep(const TimedSimulation& simulation) {
  publish(simulation, [&] { publishers_.stepResult(simulation, {}); });
}

void BagFiller::finish(const TimedSimulation& simulation) {
  newState(simulation);
  try {
    const auto all = recording_.view([](const rosbag::ConnectionInfo*) { return true; });
    for (const rosbag::MessageInstance& message : *all)
      if (!isReplayed(message.getTopic(), recording_.prefix()))
        bag_->write(message.getTopic(), message.getTime(), message);
    bag_->close();
    rosbag::Bag whole(file_ + ".active", rosbag::bagmode::Read);
    count_ = rosbag::View(whole).size();
  } catch (const rosbag::BagException& error) {
    fail(error.what());
  }
  finishBag(file_);
}

}  // namespace vibe::sim
