#include "camera/picture_reader.hpp"

#include <algorithm>

#include <glob.h>
#include <sys/stat.h>
#include <unistd.h>
#include <opencv2/imgcodecs.hpp>

#include "vibe_core/program/error.hpp"

namespace vibe::vision {

ImageListReader::ImageListReader(const std::string& pattern) {
  glob_t found{};
  if (::glob(pattern.c_str(), GLOB_TILDE, nullptr, &found) == 0) {
    files_.assign(found.gl_pathv, found.gl_pathv + found.gl_pathc);
  }
  ::globfree(&found);
  if (files_.empty()) {
    throw Error(pattern +
                ": no file matches; put the pattern in quotes and check it with ls, such as images:DIR/*.png.");
  }
  std::sort(files_.begin(), files_.end(), [](const std::string& a, const std::string& b) {
    return ::strverscmp(a.c_str(), b.c_str()) < 0;  // frame_9 is before frame_10
  });
}

PictureReader::Result ImageListReader::next(cv::Mat& picture) {
  complaint_.clear();
  if (index_ == files_.size()) return Result::End;
  const std::string& file = files_[index_++];
  picture = cv::imread(file, cv::IMREAD_ANYDEPTH | cv::IMREAD_ANYCOLOR);
  if (!picture.empty()) return Result::Picture;
  complaint_ = file + " cannot be read as an image; it is damaged or of an unknown format";
  return Result::Unreadable;
}

std::string ImageListReader::folder() const {
  const std::size_t slash = files_.front().rfind('/');
  return slash == std::string::npos ? "." : files_.front().substr(0, slash);
}

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
  throw Error(
      file_ +
      ": FFmpeg cannot read it as a video; it may be none, damaged, or of another format: see what ffprobe says.");
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
