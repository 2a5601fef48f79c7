// Numbers of the rooms solver and dynamics, for step_policy.hpp: name, default, unit, meaning, source or measurement.

VIBE_POLICY_SECTION("Where a step starts")
VIBE_REAL(guess_growth, 2, "",
          "elastic energy of an extrapolated guess over that of the last step, above which the guess is dropped",
          "a guess along a smooth motion changes the energy by a few percent per step")
