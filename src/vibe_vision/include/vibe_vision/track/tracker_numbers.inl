// Numbers of the tracker, for tracker_policy.hpp: name, default, unit, meaning, source or reason. vibe_tracker_numbers
// measures what a shift by a fifth moves.

VIBE_POLICY_SECTION("From frame to frame")
VIBE_REAL(close_enough, 1.2, "px", "deviation of a prediction below which a fit starts from it",
          "design choice: a fit converges from there")
VIBE_REAL(max_gap, 0.5, "s", "time without a measurement after which the motion is forgotten", "design choice")
VIBE_COUNT(forget_after, 60, "lost frames after which size, tilt, blur and light are forgotten",
           "design choice: 0.4 s at 147 Hz")
VIBE_COUNT(doubt_after, 3, "lost frames after which every other one is searched as if they were",
           "design choice: what was learnt may be wrong")
VIBE_REAL(same_motion, 0.2, "px",
          "length of the motion that prediction and fit may differ by before the fit is repeated", "design choice")
VIBE_REAL(same_bend, 0.03, "px", "the same of its acceleration", "design choice")
VIBE_REAL(filter_floor, 1e-6, "m",
          "deviation that a measurement has at least for the prediction; of a rotation 1000 rad/m times it",
          "design choice")

VIBE_POLICY_SECTION("What is taken for the marker")
VIBE_REAL(max_misfit, 4, "", "chi^2 per degree of freedom of a whole marker", "design choice")
VIBE_REAL(max_misfit_of_half, 1.5, "", "the same of half a marker, which fits other poses nearly as well",
          "design choice")
VIBE_REAL(sure_tilt, 3, "", "standard deviations of the tilt that are in doubt of the marker", "design choice")
VIBE_REAL(shear, 0.004, "", "tilt of a slanted ring away from the middle, times its aspect",
          "design choice: perspective turns the direction of its slant a little")
VIBE_REAL(weaker_edges, 0.4, "", "share of the edges of one direction that must be seen, of the share of all",
          "design choice")
VIBE_REAL(slack, 1, "px", "beyond the range and across the axis", "design choice")
VIBE_REAL(max_black, 0.75, "", "black over white", "design choice: paper and ink differ more")

VIBE_REAL(stripe_seen, 0.6, "", "share of the stripe that must be seen, of the share of all, to tell the rotation",
          "0.95 of an uncovered one, 0.9 behind a finger, 0.3 of a cover that it is not")

VIBE_POLICY_SECTION("Where it can be")
VIBE_REAL(reach_deviations, 6, "", "standard deviations of a prediction that an instrument may be away",
          "design choice")
VIBE_REAL(rest, 1e-4, "m", "by which anything may have moved", "design choice: a pixel of the design point")
VIBE_REAL(copy_moved, 4, "px", "by which what is followed must move to be no copy", "design choice: a search errs by 1")
VIBE_COUNT(copy_search, 4, "frames after which the axis is searched again while it may be a copy", "design choice")
VIBE_REAL(copy_step, 24, "px", "of the axis that is looked at for copies, as often as for distortions",
          "design choice: 500 px in 0.6 s")
VIBE_REAL(looks_alike, 0.9, "", "correlation along the axis from which something looks like the marker",
          "0.92 and more of markers, 0.78 at most of other things in the scenes")
VIBE_COUNT(jumps_to_believe, 3, "frames in a row that agree on a place out of reach until they are believed",
           "design choice")

VIBE_POLICY_SECTION("Search")
VIBE_REAL(search_margin, 3, "px", "around the range of the search", "design choice")
VIBE_COUNT(tries, 3, "candidates that a frame may cost", "design choice: bounds the time of a frame")
VIBE_COUNT(relax_after, 15, "lost frames after which a frame may cost one less", "design choice: 0.1 s at 147 Hz")
VIBE_REAL(good_loss, 0.25, "", "loss of a pixel below which no other candidate is looked at", "design choice")
VIBE_REAL(scale_step, 0.05, "", "logarithm of the size by which the search must differ to be taken",
          "design choice: the search knows the size no better")
VIBE_REAL(known_rotation, 0.3, "rad", "deviation of a predicted rotation from which a fit starts",
          "design choice: a fit converges from there")
VIBE_REAL(search_visible, 0.7, "", "share of a sleeve that a search must see",
          "design choice: part of the bars also fits at other places")
VIBE_REAL(whole_from, 0.88, "", "visible share from which a sleeve begins to count as whole", "design choice")
VIBE_REAL(whole, 0.94, "", "visible share from which it is whole", "design choice")
VIBE_REAL(part_misfit, 1.5, "", "misfit that a search accepts of a part of a sleeve", "design choice")
VIBE_REAL(whole_misfit, 4, "", "the same of a whole sleeve", "design choice")
VIBE_REAL(known_place, 3, "px", "deviation of a prediction that tells a sleeve from where else its bars would fit",
          "design choice: where else its bars would fit is further away")
VIBE_REAL(near, 3, "", "standard deviations of such a prediction in which the sleeve is", "design choice")
VIBE_REAL(nearby_place, 12, "px", "deviation of a prediction around which places are tried",
          "design choice: 40 places are as costly as a fit")
VIBE_REAL(nearby_reach, 2.5, "", "the same in which places are tried", "design choice")
VIBE_REAL(nearby_visible, 0.5, "", "share of a sleeve that must be seen there", "design choice")
VIBE_REAL(expected_place, 30, "px", "deviation of a prediction in which a part of a sleeve is taken whose stripe is seen",
          "0.5 to 1.3 deviations of parts of the sleeve, with 5 to 20 px, behind the bar of the scenes")
VIBE_REAL(expected_stripe, 0.85, "", "share of its stripe that must be seen",
          "0.88 to 0.96 of parts of the sleeve, 0.84 at most of other places, behind the bar of the scenes")
VIBE_REAL(saturated_share, 0.5, "", "share of saturated pixels along the axis for the reason `saturated`",
          "design choice: of what is reported only")
VIBE_REAL(clipped_share, 0.2, "", "share of saturated pixels of a marker for the same reason",
          "design choice: of what is reported only")
VIBE_REAL(dark_contrasts, 2, "", "brightest pixel, in least contrasts, for the reason `dark`",
          "design choice: of what is reported only")

VIBE_POLICY_SECTION("Learning and doubts")
VIBE_REAL(good_look, 0.6, "", "share of the marker that must be seen to learn size, tilt and blur from it",
          "design choice: what covers a marker changes its look")
VIBE_REAL(search_doubt, 0.1, "", "share of the first variance of size, tilt and blur that a search leaves of a ring",
          "design choice")
VIBE_REAL(odd_rows, 0.1, "", "share of a marker that is in rows that do not agree, for the doubt `rows`",
          "0.01 at most in the standard scenes without highlights, 0.04 to 1 of stale and lost rows")
VIBE_REAL(strange_light, 25, "", "mean squared normalised innovation of the brightness, for the doubt `light`",
          "design choice: five standard deviations")
VIBE_REAL(telling_motion, 2, "px", "motion during the exposure whose length a picture shows", "design choice")
VIBE_COUNT(first_looks, 16, "moving frames that are all looked at for distortions", "design choice: 0.1 s at 147 Hz")
VIBE_COUNT(look_every, 4, "of later ones, every how many", "design choice: a look costs half a step of the fit")
VIBE_REAL(telling_speed, 0.05, "m/s", "from which a picture would be sheared", "design choice")
VIBE_REAL(unchecked_shift, 2.5e-4, "m", "deviation by an unknown shutter that is worth a doubt",
          "design choice: half of what counts as wrong")
VIBE_REAL(uneven, 0.028, "1/px", "bars apart, by optics that blur not as a Gaussian, per square of the blur",
          "design choice")
