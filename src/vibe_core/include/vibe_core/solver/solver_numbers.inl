// Numbers of the rooms solver and dynamics, for step_policy.hpp: name, default, unit, meaning, source or measurement.
// What only says "below rounding" or belongs to a published method is here as well, so that it can be shifted; what it
// costs to shift a number is measured, see docs/policy.md.

VIBE_POLICY_SECTION("Where a solve starts")
VIBE_REAL(guess_growth, 2, "",
          "elastic energy of an extrapolated guess over that of the last step, above which the guess is dropped",
          "a guess along a smooth motion changes the energy by a few percent per step")
VIBE_REAL(misled_part, 0.5, "",
          "first direction from the predicted positions over the predicted motion, above which the step starts from "
          "the present positions",
          "where the motion goes on as it was, it is a few hundredths to a third")
VIBE_REAL(margin_of_one, 2, "",
          "stiffness of the factor over that of the body where a step has one iteration",
          "such a step is unstable where the true stiffness exceeds that of the factor; with two iterations only beyond "
          "twice that (computation.md, the time step)")
VIBE_REAL(safe_strain, 0.02, "", "strain that a last, unverified move may bring to the shortest edge",
          "elastic forces are linear up to strains of this order, so that such a move cannot raise the energy")
VIBE_REAL(usual_growth, 1.5, "",
          "length of a first move over its running mean, beyond which a short move is verified as well",
          "larger moves mean that something new acts")
VIBE_REAL(usual_share, 0.1, "", "weight of the last step in that running mean", "a memory of ten steps")

VIBE_POLICY_SECTION("How a solve iterates")
VIBE_REAL(sufficient_decrease, 1e-4, "", "share of the linear prediction by which the energy must fall (Armijo)",
          "Nocedal, Wright 2006, Numerical Optimization, section 3.1: 1e-4")
VIBE_REAL(shortest_part, 0.1, "", "smallest next part of a direction over the one that was too long",
          "Nocedal, Wright 2006, section 3.5: quadratic interpolation, safeguarded")
VIBE_REAL(longest_part, 0.5, "", "largest next part of a direction over the one that was too long",
          "Nocedal, Wright 2006, section 3.5")
VIBE_REAL(energy_roundings, 10, "",
          "rounding errors of a value that may hide a decrease; then the slope decides (approximate Wolfe)",
          "Hager, Zhang 2005, doi 10.1137/030601880, equation 2.4; the errors of many elements seldom add up to more")
VIBE_REAL(elastic_noise, 1e-6, "", "rounding error of the elastic energy over the energy",
          "single precision, in which triangles are evaluated: 6e-8, times what several thousand of them add up to")
VIBE_REAL(gas_noise, 1e-7, "", "the same of the energy of the gas over pressure times volume",
          "the volume is a sum in double precision of terms in single precision")
VIBE_COUNT(search_trials, 5, "trials along a direction before it counts as useless",
           "at the shortest, a part of 1e-4 of a direction, which is below what a step can use")
VIBE_REAL(unmet_roundings, 100, "",
          "residual of the constraints over the resolution of single precision, above which it is not rounding",
          "a row sums up to some ten nodes, each a few roundings off")
VIBE_REAL(small_residual, 1e-4, "", "residual of the rows over the length of the direction, below which they hardly move",
          "a pair of the history with larger row moves would repeat them in later directions")
VIBE_REAL(row_roundings, 10, "", "the same residual over the resolution of single precision",
          "a row sums up to some ten nodes")
VIBE_REAL(thread_residual, 1.0 / 3, "", "residual of a thread's row over the length of the direction, as for other rows",
          "threads are elastic")
VIBE_REAL(pair_cosine, 1e-8, "", "smallest cosine between move and change of gradient of a pair that is kept",
          "rounding of single precision; below it the curvature has no correct digit")
VIBE_REAL(contraction, 0.5, "", "length of a direction over the one before, below which the iteration contracts",
          "halving per iteration is the weakest rate that bounds what is left by the last move")
VIBE_REAL(rest_part, 0.01, "", "what is left after the last move of a step over its first direction",
          "measured: a force that a device renders from one frame to the next is 5 % of its change off, with 0.02 7 %, "
          "with 0.005 4.5 %")
VIBE_COUNT(satisfy_after, 5, "iterations after which the constraints are met exactly, whatever that costs in energy",
           "about half of what a step may take, so that as many remain to reduce the energy again")

VIBE_POLICY_SECTION("When a step counts as arrived")
VIBE_REAL(arrived, 0.5, "", "length of the last direction over the first, or over the way foreseen, above which a step counts as not arrived",
          "a step that leaves half of its move has not found the equilibrium")
VIBE_REAL(nearly_arrived, 0.1, "", "as `arrived`, where no part of the last direction lowered the energy",
          "near the end that may be due to rounding")
VIBE_REAL(position_roundings, 10, "", "as `nearly_arrived`, over the rounding error of a position instead of the first direction",
          "in some directions energies are less certain")
VIBE_COUNT(fallback_steps, 3, "steps with backward Euler after a step that did not arrive, which may be one of them",
           "measured: ten cost twice as many iterations each, and an error of 6.5 instead of 5.6 % in the cinch of a "
           "sixth set")
VIBE_REAL(fallback_max_move, 0.05, "",
          "largest move of an iteration with backward Euler, or of a static one, over the size of the body",
          "about a fold of the wall of a stomach (1 cm in 20 cm), within which the linearization is of some use")
VIBE_COUNT(least_spare, 2, "evaluations of the last solve of a step beyond its iterations",
           "one for its start and one for a shorter move")
VIBE_REAL(least_slope_part, 1e-3, "",
          "part of the step between the two points of evaluation, below which the force of the elements is taken as "
          "constant in the account of the works",
          "their difference is rounding there")
VIBE_REAL(least_curved_part, 0.3, "", "the same for the curvature of that force",
          "rounding enters with the third power of this part")

VIBE_POLICY_SECTION("Static solves")
VIBE_COUNT(refactor_every, 6, "iterations between two factors",
           "a factor costs about as much as ten iterations; six is the history that a new factor discards")
VIBE_COUNT(refactor_slow, 3, "the same where the iterations contract slowly", "half of it")
VIBE_REAL(slow_contraction, 0.3, "", "length of a direction over the one before, above which a solve counts as slow",
          "at this rate six iterations gain three decimals")

VIBE_POLICY_SECTION("Rows: constraints, contacts, threads")
VIBE_REAL(left_out_depth, 1e-4, "m", "depth in the tool at which a contact without a row is given one",
          "a tenth of half a wall; the guard of the tool would stop wall and tool")
VIBE_COUNT(contact_exchanges, 3, "times that contacts may take each other's rows before a step moves",
           "each costs a direction; what is then left out stops the motion of the step")
VIBE_REAL(shared_softness, 1e-6, "", "added to the compliance of a contact's row, over the row's own",
          "ten times the rounding of the columns; contacts that their nodes cannot distinguish share the force")
VIBE_COUNT(first_sweeps, 4, "sweeps of projected Gauss-Seidel that look for the contacts that act",
           "they cost a tenth of a factorization of 30 contacts")
VIBE_COUNT(factorizations, 8, "factorizations of one solution of the contacts",
           "measured: presses with up to 100 contacts take 1 to 5")
VIBE_COUNT(contact_steps, 24, "Newton steps of one solution of the contacts", "most of them with a kept factor")
VIBE_COUNT(last_sweeps, 40, "sweeps where those were not enough", "as much work as a few factorizations")
VIBE_REAL(contact_tolerance, 1e-9, "m", "violation of a contact's condition below which its solution is reached",
          "a hundredth of the tolerance of a step")
VIBE_REAL(kept_contraction, 0.3, "", "violation over the one before, above which a kept factor is not good enough",
          "a factorization costs about as much as ten steps with a kept factor")
VIBE_REAL(shortest_segment, 1e-6, "m", "shortest segment of thread that has a direction",
          "far below the size of a bite, far above rounding")
VIBE_REAL(slack_tension, 1e-6, "N", "tension of a slack segment for its resistance to being turned",
          "keeps the compliance finite at a force that nobody can measure")
VIBE_REAL(soft_turn, 1, "N/m", "stiffness of a thread across its direction that needs neither a coupling nor a row",
          "a hundredth of that of a wall of 2 mm (some 100 N/m); the iterations find its effect")
VIBE_REAL(missing_turn, 0.25, "", "part of that stiffness that may be missing in the factor without a row",
          "a quasi-Newton iteration then reduces the error in its direction to a third at least")
VIBE_COUNT(shell_shares, 4, "shares into which a shell is divided for several threads, at most",
           "each share costs copies along its border")

VIBE_POLICY_SECTION("The tool in a step")
VIBE_REAL(earlier_normals, 0.05, "",
          "how much earlier than the forces of the step the normals of tool contacts are taken, in steps",
          "measured: vertices that come into contact within a step drive a tip that slides by 0.2 % of its normal force "
          "at 60 Hz; with this it is braked by a tenth of that instead")
VIBE_REAL(miss_speed, 6e-3, "m/s",
          "speed with which the tool at a contact leaves where it was expected, above which the step is solved again",
          "0.1 mm at 60 Hz, which turns the normal of a tip by a degree")
VIBE_REAL(far_speed, 0.06, "m/s", "the same above which it is not",
          "1 mm at 60 Hz, a few degrees; a tool that is thrown about is not where any guess has it")
VIBE_REAL(aim_foreseen, 2, "", "way to where the tool is then expected over how far it came in the first direction",
          "normals turn with the tip that they push aside, and a direction finds less than a solve")
VIBE_REAL(aim_solved, 1.6, "", "the same over how far it came in the first solve",
          "measured: where a tip slides, each solve finds 0.2 to 0.6 of what the one before has missed")
VIBE_REAL(stopped_part, 0.1, "", "share of its way below which a joint counts as stopped",
          "a joint that makes a tenth of its way pushes on")

VIBE_POLICY_SECTION("Rest, loss and recovery")
VIBE_REAL(hold_time, 0.75, "s", "time for which the hand holds all joints still until it counts as holding",
          "design choice: longer than a pause within a motion, shorter than a look at the wall")
VIBE_REAL(hold_tolerance, 5e-8, "m", "move below which a step ends while the hand holds, instead of StepSettings::tolerance",
          "3 um/s at 60 Hz, below what counts as rest, and above rounding in single precision")
VIBE_REAL(rest_speed, 2e-6, "m/s", "speed below which tissue counts as at rest",
          "a micrometre in half a second, far below what a camera or a hand resolves")
VIBE_COUNT(rest_steps, 15, "steps at rest before the tissue sleeps",
           "a quarter of a second, longer than a slow oscillation stays near its turning point at this speed")
VIBE_COUNT(wake_every, 30, "steps after which a sleeping tissue is computed once",
           "the state may have come from another scene, in which it was at rest; half a second passes until that shows")
VIBE_REAL(recovery_time, 0.5, "s", "time in which lost tissue is led back to rest",
          "short, but long enough to be seen as a motion")
VIBE_REAL(recovery_rate, 20, "1/s", "rate of the exponential approach to rest",
          "e^-10 of the distance remains after the recovery time")
VIBE_COUNT(recovery_attempts, 8,
           "times that nodes are held back which would lead a recovering wall through the tool, before all of it waits",
           "what is held back spreads by a ring of triangles each time")
VIBE_COUNT(check_every, 10, "steps between checks for an organ that is inside out", "a check is a pass over all triangles")
VIBE_REAL(jammed_rate, 6, "1/s",
          "rate at which the guard against crossings gives energy back, over the energy of the wall, above which walls "
          "are jammed",
          "measured: a fold that is drawn through its own loops has 40 to 60, one that is pressed together hardly any")
VIBE_REAL(jammed_time, 1, "s", "time for which walls are jammed until they are led back to rest",
          "folds that slip past each other are free within some steps")
VIBE_REAL(held_part, 0.5, "", "share of the wall's tension that the gas has to bear for a state to count as held by it",
          "half; the rest is motion and what else pulls")
VIBE_REAL(burst_stretch, 1.25, "",
          "stretch over that of the limit pressure from which a wall counts as bursting while an insufflator works",
          "a shape other than a sphere reaches its own limit before")
