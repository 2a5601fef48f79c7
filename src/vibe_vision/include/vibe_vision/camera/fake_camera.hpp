#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "vibe_vision/synthetic/synthetic_scene.hpp"

namespace vibe::vision {

/// Pictures that a simulated camera shows in turn, forward and backward, so that nothing jumps. All have one size.
struct FrameRing {
  int width = 0, height = 0;                       ///< of the sensor [px]
  double rate = 147;                               ///< [Hz]
  double exposure = 1e-3;                          ///< with which they were drawn [s]
  std::vector<std::vector<std::uint8_t>> frames;   ///< grey values row by row
  std::vector<std::string> instruments;            ///< names; may be empty
  std::vector<std::vector<SyntheticTruth>> truth;  ///< by picture and instrument

  struct Turn {
    std::size_t index = 0;     ///< of the picture, in `frames`
    bool is_backward = false;  ///< the pictures run from the last to the first
  };
  /// Of frame k since the beginning.
  Turn turnOf(std::uint64_t k) const;
};

/// Draws the pictures of a scene. The first and the last are chosen where the instruments hardly move, so that they
/// turn there without a jump of their speed. @param frames  at most; 0.4 MB each at 728 x 544
std::shared_ptr<const FrameRing> renderRing(const SyntheticScene& scene, int frames);

struct FakeCameraOptions {
  std::string address = "127.0.0.1";  ///< of a network interface of this computer; one camera per address
  std::string serial = "ViBE1";       ///< that the camera states
  double lost_ratio = 0;              ///< share of the packets that are not sent
  double clock_ahead = -1000;         ///< camera's clock less Unix time [s]
  double clock_drift = 0;             ///< by which it is fast [s/s]
  /// Unix times at which the picture jumps between the first and the second of the ring, ascending; empty: all pictures
  /// are shown in turn [s].
  std::vector<double> blinks;
  /// When each blink happened and when the exposure that shows it was half over, as a table with the columns `blink`,
  /// `event` and `report` [ns of Unix time]; empty: none.
  std::string blink_file;
  std::string truth_file;  ///< what each frame that was sent truly shows, as truth.csv of vibe_render; empty: none
};

/// A GigE Vision camera in this process: Aravis' simulated camera sends the pictures of a ring over the network, with
/// stamps of its own clock. Exposures end at whole multiples of the period of Unix time; the frame follows at once. Its
/// sequence begins at 65401 and wraps from 65535 to 1, as GigE Vision 1.x does; the truth file counts on.
class FakeCamera {
 public:
  /// @throws Error if the address is none of this computer, or another camera serves there
  FakeCamera(std::shared_ptr<const FrameRing> ring, const FakeCameraOptions& options);
  ~FakeCamera();  ///< as if unplugged

  std::uint64_t sent() const;  ///< frames
  /// The clock begins at 0, as after a reset of the camera.
  void resetClock();
  /// Changes the format without being asked; the bytes stay grey values. @param code  of the PFNC, with 8 bits per
  /// pixel
  void announceFormat(std::uint32_t code);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vibe::vision
