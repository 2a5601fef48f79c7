#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Core>

#include "suture/capstan.hpp"

namespace vibe::detail {

// Variable size with fixed storage: nothing here allocates.
using SegmentVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxThreadSegments, 1>;
using SegmentMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxThreadSegments, kMaxThreadSegments>;
/// Two columns b, g: the quantity is b + t g at parameter t of the path.
using SegmentPath = Eigen::Matrix<double, Eigen::Dynamic, 2, 0, kMaxThreadSegments, 2>;

/// State of an eyelet. Smooth eyelets (factor 1) let thread slide in both directions.
enum class Eyelet : std::int8_t { Backward = -1, Sticks = 0, Forward = 1, Smooth = 2 };
using Eyelets = std::array<Eyelet, kMaxThreadSegments>;
using Tight = std::array<bool, kMaxThreadSegments>;

/// Capstan factors below this count as 1.
constexpr double kSmoothFactor = 1 + 1e-12;

/// Computes tensions and slides with slack = 0 in all tight segments for given states of the eyelets. The tensions of
/// segments that slide into each other have known ratios, and the sum of their conditions is independent of the slide.
/// Segments that are not tight have no tension, and nothing slides through their eyelets here.
/// @return  false if there is no solution
bool solveLinked(const SegmentMatrix& compliance, const SegmentPath& residual, const SegmentVector& factor,
                 const Eyelets& eyelets, const Tight& tight, SegmentPath& tension, SegmentPath& slide);

/// Follows the solutions of a thread without knots that lacks length in total, from the frictionless one (t = 0, where
/// lack is C times one tension, with the same sum) to the requested one (t = 1).
/// @return  false if the path does not reach it; tension and slide are then those of the farthest point
bool updatePath(const SegmentMatrix& compliance, const SegmentVector& residual, const SegmentVector& factor,
                Eyelets& eyelets, SegmentVector& tension, SegmentVector& slide);

/// Slack segments have enough thread in total: those that lack length take it from the parts with the least friction in
/// between.
/// @param factor  of the eyelets between the segments (count - 1)
/// @param slack   in: below 0 where length is missing; out: 0 or more (count)
/// @param slide   adds what slides through the eyelets (count - 1)
void dealOut(int count, const double* factor, double* slack, double* slide);

}  // namespace vibe::detail
