#pragma once
#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "suture/capstan.hpp"

namespace vibe::detail {

// Sizes vary, storage does not: nothing here allocates.
using SegmentVector = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMaxThreadSegments, 1>;
using SegmentMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, kMaxThreadSegments, kMaxThreadSegments>;
/// Two columns b, g: the quantity is b + t g at the place t of the path.
using SegmentPath = Eigen::Matrix<double, Eigen::Dynamic, 2, 0, kMaxThreadSegments, 2>;

/// What an eyelet does. Smooth ones (factor 1) let thread slide either way.
enum class Eyelet : std::int8_t { Backward = -1, Sticks = 0, Forward = 1, Smooth = 2 };
using Eyelets = std::array<Eyelet, kMaxThreadSegments>;
using Tight = std::array<bool, kMaxThreadSegments>;

/// Below this a capstan factor counts as 1.
constexpr double kSmoothFactor = 1 + 1e-12;

/// Tensions and slides that meet slack = 0 in all tight segments, if every eyelet does what is said: the tensions of
/// segments that slide into each other have known ratios, and the sum of their conditions knows no slide.
/// Segments that are not tight have no tension, and nothing slides through their eyelets here.
/// @return  false if that has no solution
bool solveLinked(const SegmentMatrix& compliance, const SegmentPath& residual, const SegmentVector& factor,
                 const Eyelets& eyelets, const Tight& tight, SegmentPath& tension, SegmentPath& slide);

/// Follows the solutions of a thread without knots that lacks length in all, from the frictionless one (t = 0, where
/// lack is C times one tension, of the same sum) to the one asked for (t = 1).
/// @return  false if the path does not get there; tension and slide are then those of the furthest place
bool updatePath(const SegmentMatrix& compliance, const SegmentVector& residual, const SegmentVector& factor,
                Eyelets& eyelets, SegmentVector& tension, SegmentVector& slide);

}  // namespace vibe::detail
