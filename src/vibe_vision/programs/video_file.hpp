#pragma once
#include <opencv2/videoio.hpp>
#include <string>

#include "vibe_core/files/files.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::vision {

/// A video that is there whole or not at all.
class VideoFile {
 public:
  /// @param codec  four letters, such as "FFV1"
  /// @param rate  frames per second
  /// @throws Error if OpenCV cannot write such a video there
  VideoFile(const std::string& file, const char* codec, double rate, const cv::Size& size, bool has_colour)
      : whole_(file, "The video") {
    const int letters = cv::VideoWriter::fourcc(codec[0], codec[1], codec[2], codec[3]);
    writer_.open(whole_.part(), cv::CAP_FFMPEG, letters, rate, size, has_colour);
    if (!writer_.isOpened())
      throw Error(file + ": cannot be written as " + codec + " video; check the folder, or write images.");
  }

  void add(const cv::Mat& picture) {
    writer_.write(picture);
    ++count_;
  }

  /// Puts it in place. OpenCV does not say that a disk is full, so what was written is read again.
  /// @throws Error if a frame is missing
  void finish() {
    writer_.release();
    cv::VideoCapture reader(whole_.part(), cv::CAP_FFMPEG);
    unsigned long long found = 0;
    while (reader.grab()) ++found;
    whole_.finish(found == count_);
  }

 private:
  WholeFile whole_;
  cv::VideoWriter writer_;  // is closed before an unfinished file is removed
  unsigned long long count_ = 0;
};

}  // namespace vibe::vision
