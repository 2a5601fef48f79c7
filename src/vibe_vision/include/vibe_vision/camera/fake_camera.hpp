#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace vibe {

/// Pictures that a simulated camera shows in turn, forward and backward, so that nothing jumps. All have one size.
struct FrameRing {
  int width = 0, height = 0;                      ///< of the sensor [px]
  double rate = 147;                              ///< [Hz]
  double exposure = 1e-3;                         ///< with which they were drawn [s]
  std::vector<std::vector<std::uint8_t>> frames;  ///< grey values row by row
  /// Of each picture: what is true at the middle of its exposure, as columns of a text file; may be empty.
  std::vector<std::string> truth;
  std::string truth_columns;  ///< names, with commas between

  /// Of frame k since the beginning.
  std::size_t indexOf(std::uint64_t k) const;
};

struct FakeCameraOptions {
  std::string address = "127.0.0.1";  ///< of a network interface of this computer; one camera per address
  std::string serial = "ViBE1";
  double lost_ratio = 0;       ///< share of the packets that are not sent
  double clock_ahead = -1000;  ///< camera's clock less Unix time [s]
  double clock_drift = 0;      ///< by which it is fast
  std::string truth_file;      ///< sequence, stamp, exposure and truth of each frame sent; empty: none
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
  /// Announces another format without being asked; the bytes stay grey values. @param code  of the PFNC
  void announceFormat(std::uint32_t code);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vibe
