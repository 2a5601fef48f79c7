#include "camera/video_reader.hpp"

#include <sys/stat.h>
#include <unistd.h>

#include "vibe_core/common/error.hpp"

namespace vibe::vision {

VideoReader::VideoReader(const std::string& file) : file_(file) {
  struct stat facts {};
  if (::stat(file.c_str(), &facts) != 0)
    throw Error(file + ": there is no such file; check the address video:" + file + ".");
  if (!S_ISREG(facts.st_mode)) throw Error(file + ": is not a file; the address of a video is video:FILE.");
  if (::access(file.c_str(), R_OK) != 0) throw Error(file + ": may not be read; check its permissions.");
  open();
  const double count = capture_.get(cv::CAP_PROP_FRAME_COUNT);
  if (count > 0 && count < 1e9) count_ = static_cast<std::size_t>(count);
}

void VideoReader::open() {
  read_ = 0;
  if (capture_.open(file_, cv::CAP_FFMPEG)) return;
  throw Error(file_ + ": cannot be read as a video; it is damaged, or of a format that FFmpeg does not know.");
}

PictureReader::Result VideoReader::next(cv::Mat& picture) {
  complaint_.clear();
  cv::Mat fresh;
  if (capture_.read(fresh) && !fresh.empty()) {
    ++read_;
    picture = fresh;
    return Result::Picture;
  }
  if (read_ + 1 < count_) {
    complaint_ = "ends after " + std::to_string(read_) + " of " + std::to_string(count_) +
                 " frames: the file is truncated or damaged; record it again";
  }
  return Result::End;
}

void VideoReader::rewind() {
  capture_.release();
  open();
}

}  // namespace vibe::vision
