#include "protocol/suture_stream.hpp"

#include "protocol/byte_writer.hpp"

namespace vibe::web {

namespace {

constexpr double kMillilitre = 1e-6;  // [m^3]

class Numbers {
 public:
  explicit Numbers(ByteWriter& writer) : writer_(writer) {}
  void put(double number) { writer_.put(static_cast<float>(number)); }
  void put(const Eigen::Vector3d& place) {
    for (int k = 0; k < 3; ++k) put(place[k]);
  }

 private:
  ByteWriter& writer_;
};

void putSet(const graphics::SutureSet& set, Numbers& numbers) {
  numbers.put(static_cast<double>(set.stage));
  numbers.put(set.has_t_tag ? 1 : 0);
  numbers.put(set.has_t_tag ? set.t_tag : Eigen::Vector3d(0, 0, 0));
  numbers.put(set.has_cinch ? 1 : 0);
  numbers.put(set.has_cinch ? set.cinch : Eigen::Vector3d(0, 0, 0));
  numbers.put(static_cast<double>(set.bites.size()));
  numbers.put(static_cast<double>(set.pieces.size()));
  for (const graphics::SutureBite& bite : set.bites) {
    numbers.put(bite.place);
    numbers.put(bite.full_thickness ? 1 : 0);
  }
  for (const graphics::ThreadPiece& piece : set.pieces) {
    numbers.put(piece.tension);
    numbers.put(static_cast<double>(piece.line.size()));
    for (const Eigen::Vector3d& point : piece.line) numbers.put(point);
  }
}

}  // namespace

Bytes encodeSutures(const graphics::SutureDrawing& drawing) {
  ByteWriter writer(Kind::Sutures);
  for (int k = 0; k < 3; ++k) writer.put(std::uint8_t{0});
  Numbers numbers(writer);
  numbers.put(static_cast<double>(drawing.sets.size()));
  numbers.put(static_cast<double>(drawing.wounds.size()));
  for (const graphics::SutureSet& set : drawing.sets) putSet(set, numbers);
  for (const graphics::Wound& wound : drawing.wounds) {
    numbers.put(wound.place);
    numbers.put(wound.inward);
    for (const double number :
         {wound.brisk ? 1.0 : 0.0, wound.rate / kMillilitre, wound.amount / kMillilitre, wound.age})
      numbers.put(number);
  }
  return writer.take();
}

}  // namespace vibe::web
