#pragma once

#include <vector>

#include "solver/elastic_body.hpp"
#include "vibe_core/model/model.hpp"
#include "vibe_core/state/state.hpp"

namespace vibe {

/// The sutures of the state that pull, as loads of the tissue: a spot per bite, a thread per suture.
void fillThreads(const Model& model, const State& state, BodyLoads& loads);
/// Lengths and tensions after a step back to the sutures.
void storeThreads(const BodyLoads& loads, State& state);

/// Distances between the spots of the threads, segment by segment [m].
void segmentLengths(const BodyLoads& loads, const State& state, std::vector<double>& lengths);
/// What threads whose tensions have changed from those of the state to those of the loads did to the tissue between two
/// sets of segmentLengths() [J].
double threadWork(const BodyLoads& loads, const State& state, const std::vector<double>& before,
                  const std::vector<double>& after);

}  // namespace vibe
