#pragma once
#include <string>
#include <utility>
#include <vector>

#include "vibe_core/scene/yaml_source.hpp"
#include "vibe_vision/config/vision_config.hpp"

namespace vibe::vision {

/// Reads a VisionConfig from YAML. Every mistake ends in an Error "file:line: key: what is wrong; remedy".
class ConfigReader {
 public:
  ConfigReader(YamlSource source, AxisRule rule) : source_(std::move(source)), rule_(rule) {}
  VisionConfig read();

 private:
  using Keys = std::vector<std::string>;

  YamlSource source_;
  AxisRule rule_;
  VisionConfig config_;

  /// Fields of a map of which each key must be one of `keys` and each of the `required` must be there.
  std::vector<YamlField> mapOf(const YamlField& field, const Keys& keys, const Keys& required) const;
  void readCamera(const YamlField& field);
  void readSize(const YamlField& field);
  void readNoise(const YamlField& field);
  void readGates(const YamlField& field);
  void readInstruments(const YamlField& field);
  InstrumentConfig readInstrument(const YamlField& field) const;
  MotionLimits readMotion(const YamlField& field) const;
  void readRange(const YamlField& field, InstrumentConfig& instrument) const;
  /// @param unit  of the joint: "m" or "rad"
  void readJoint(const YamlField& field, const std::string& unit, std::string& name, double& sign,
                 double& offset) const;

  MarkerDesign readMarker(const YamlField& field) const;
  RingDesign readRing(const YamlField& field) const;
  TagDesign readTag(const YamlField& field) const;
  SleeveDesign readSleeve(const YamlField& field) const;
  std::vector<Bar> readBars(const YamlField& field) const;
  void readHelix(const YamlField& field, SleeveDesign& sleeve) const;

  SlideAxis readAxis(const YamlField& field) const;
  Eigen::Vector2d readDirection(const YamlField& field) const;
  void readCovariance(const YamlField& field, SlideAxis& axis) const;

  void checkUnique(const YamlField& field, const InstrumentConfig& instrument) const;
  void checkAxis(const YamlField& field, const InstrumentConfig& instrument) const;
  void checkLens(const YamlField& field) const;
};

}  // namespace vibe::vision
