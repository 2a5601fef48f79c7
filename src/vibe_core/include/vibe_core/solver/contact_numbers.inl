// Numbers of the rooms tool, self_contact, tool_contact, haptics and constraints, for step_policy.hpp: name, default,
// unit, meaning, source or measurement.

VIBE_POLICY_SECTION("Hand and shaft of the tool")
VIBE_COUNT(hand_stall_steps, 6, "steps until a joint that tissue has stopped tries to go on",
           "design choice: the tissue has a few steps to yield to a tool that stands still, and the hand tries often "
           "enough to go on with it")
VIBE_REAL(hand_slows_force, 10, "N", "force on the tool at which the hand slows down",
          "design choice: forces in endoscopic suturing reach 8 N (Trejos 2011)")
VIBE_REAL(hand_stops_force, 20, "N", "force on the tool at which the hand stops",
          "design choice: a force across the shaft, which the entry bears, reaches no joint of the hand")
VIBE_REAL(shaft_shortest_bend, 6e-5, "m", "free length of the shaft below which it does not bend",
          "design choice: a hundredth of the tube's radius")
VIBE_REAL(shaft_spring_back, 0.3, "m/s", "speed of the tip with which a loaded scope springs back at most",
          "design choice: twice what the hand moves at, which keeps the way of a step below a wall's thickness or two")

VIBE_POLICY_SECTION("Inverse kinematics")
VIBE_REAL(ik_direction_weight, 0.02, "m/rad", "length that counts as much as an error of the direction",
          "design choice: a millimetre for 3 degrees, so that the tip reaches its target before its direction")
VIBE_REAL(ik_good_cost, 1e-6, "m^2", "square of the error above which other turns and bends are tried",
          "design choice: 1 mm, less than a bite is wide")
VIBE_COUNT(ik_max_iterations, 100, "iterations of a descent, at most",
           "design choice: far more than targets within reach need")
VIBE_REAL(ik_first_damping, 1e-3, "", "damping of the first iteration over the diagonal of the normal matrix",
          "design choice: below the 1e-2 of Marquardt 1963, because targets are near the start")
VIBE_REAL(ik_damping_growth, 4, "", "factor of the damping after a step that makes the error no smaller",
          "design choice: below the 10 of Marquardt 1963, for finer changes")
VIBE_REAL(ik_damping_fall, 5, "", "divisor of the damping after a step that makes the error smaller",
          "design choice: below the 10 of Marquardt 1963, for finer changes")
VIBE_REAL(ik_most_damping, 1e9, "", "damping at which the descent ends", "design choice: such a step moves nothing")
VIBE_REAL(ik_idle_damping, 1e-7, "m^2", "what keeps inputs without effect still, as the rotation of a straight scope",
          "design choice: far below the squares of lever arms, which are above 1 mm")
VIBE_REAL(ik_worth_a_step, 1e-10, "", "promised decrease over the error below which the descent ends",
          "design choice: far below what can be seen, far above rounding; a target out of reach has no other end")
VIBE_REAL(ik_small_bend, 0.2, "", "first bend that is tried, over the largest", "design choice: both sides of a third")
VIBE_REAL(ik_large_bend, 0.6, "", "second bend that is tried, over the largest", "design choice: both sides of a third")
VIBE_REAL(ik_better_cost, 4, "", "times by which another turn or bend lessens the square of the error to be chosen",
          "design choice: half the error, so that a tool that follows a moving target does not jump for a small gain")

VIBE_POLICY_SECTION("Forces of walls that meet")
VIBE_REAL(wall_reach, 1.6, "thicknesses", "distance along the surface within which it is one wall",
          "about a half circle whose diameter is the thickness: sharper folds are below the resolution of the mesh")
VIBE_REAL(wall_softness, 0.1, "", "modulus of the contact over that of the wall",
          "mucosa is in contact: 0.56 kPa in vivo against 5.69 kPa of the muscularis (Dargar et al. 2019)")
VIBE_REAL(wall_onset, 0.25, "", "strain over which contact sets in, on both sides of the thickness",
          "design choice: smooth enough that a Newton step from outside ends inside")
VIBE_REAL(wall_straight_below, 0.2, "thicknesses", "distance below which the energy is extended linearly",
          "design choice: walls that meet do not come so near, and those that an iterate moves through are pushed back")
VIBE_REAL(wall_facing_cosine, 0.3, "", "cosine between normals of walls in contact, at most",
          "design choice: the next wall along a line faces this one; flanks of one fold are not pushed apart")
VIBE_REAL(wall_friction, 0.05, "", "coefficient of Coulomb friction of mucosa on mucosa",
          "upper end of 0.007 to 0.054, measured with a sled on the lumen of small bowel (Terry et al. 2013, Tribol "
          "Lett 51:377, doi 10.1007/s11249-013-0167-1)")
VIBE_REAL(wall_sliding_speed, 5e-3, "m/s",
          "speed from which friction is that of Coulomb; below it is viscous, as of a film of mucus",
          "design choice: a tenth of the usual speed of folds that are drawn together")
VIBE_REAL(wall_core, 0.3, "thicknesses", "thickness of two half walls whose mucosa is squeezed flat",
          "design choice: far below what usual pressures leave, far above the minimum distance")
VIBE_REAL(wall_core_search, 0.5, "thicknesses", "distance up to which spots are looked for where these meet",
          "design choice: above (1 + wall_onset) wall_core, so that walls meet in the solution of a step before they "
          "reach the minimum distance")
VIBE_REAL(wall_fold_core, 0.5, "", "thickness of a bar within one wall over the distance of its ends at rest, at most",
          "design choice: a wall that is squeezed along itself to 5/8 does not feel it, a sharp fold does")
VIBE_REAL(wall_sharing, 0.1, "thicknesses", "how much farther than another spot in its direction a spot still acts",
          "design choice: far below the distance itself, far above what a step moves a wall that rests")
VIBE_REAL(wall_least_reach, 5e-4, "m", "approach of two walls in a step for which contacts are looked for, at least",
          "design choice: a quarter of a usual wall, so that a search is seldom repeated for slow motions")
VIBE_REAL(wall_reach_per_move, 2.5, "", "approach of two walls in a step over the largest move of a node",
          "two nodes approach each other with up to twice the largest speed; the rest is for acceleration")

VIBE_POLICY_SECTION("Search of walls that meet: cost alone, the lists contain all that counts")
VIBE_REAL(search_slack, 0.3, "thicknesses", "motion of a node until the next search around it",
          "design choice: what is found is little more than what is near, and slow nodes need few searches")
VIBE_REAL(search_spare, 1.05, "", "distance for which near vertices are listed, over the one that is asked for",
          "design choice: the distance changes with the speed of the walls, and a new list costs much")
VIBE_REAL(search_too_far, 0.3, "", "distance that is asked for over the one that is listed, below which a list is made",
          "design choice: a list that is too long costs in each step")
VIBE_REAL(ball_steps, 4, "", "radius of a ball over the way of its vertex in a step; it holds for about twice as many",
          "design choice: vertices that move together are searched anew once in about eight steps")
VIBE_REAL(ball_largest, 1.5, "slacks", "radius of a ball for such a time, at most",
          "design choice: more is near a larger ball")
VIBE_REAL(ball_fast_spare, 0.5, "slacks", "how much farther a faster vertex may end than expected",
          "design choice: fast vertices are searched more often")
VIBE_REAL(ball_lead, 0.8, "radii", "how far the centre of a ball lies ahead of its vertex",
          "design choice: the vertex crosses most of the ball, and may slow down")
VIBE_REAL(ball_too_large, 1.9, "", "radius of a ball that is made smaller, over the one for its vertex now",
          "design choice: balls of vertices that slow down shrink, but not with every change of speed")
VIBE_REAL(cone_turn, 0.15, "", "width of a usual cone of normals, as a chord of the unit sphere",
          "design choice: walls whose normals differ by less than a right angle are not compared although both cones "
          "are taken off the least cosine of walls that face each other")
VIBE_REAL(cone_loose_turn, 0.4, "", "width of a cone where cones cannot tell walls apart anyway",
          "design choice: it is seldom renewed")
VIBE_REAL(cone_too_wide, 1.5, "", "width over the usual one from which a cone is made anew in each step",
          "design choice: a triangle that turned fast once does not stay in a wide cone")
VIBE_COUNT(tree_leaf, 4, "triangles of a leaf", "design choice: boxes of so few are cheap to compare")
VIBE_COUNT(tree_largest_graph, 64, "triangles of a part that may count as free of overhangs, at most",
           "design choice: about as wide as the part of the surface that is one wall")
VIBE_COUNT(tree_part, 64, "triangles of a part whose balls are renewed together", "design choice: about 10 mm wide")
VIBE_REAL(tree_least_height, 0.1, "", "cosine between normals and the direction without overhangs, at least",
          "design choice: nearly a right angle; the rest is for rounding and for triangles that turn in the step")
VIBE_REAL(tree_rough_cosine, 0.82, "", "cosine of a cone below which it tells nothing about what its triangle faces",
          "half of the angle between normals that do not face each other: acos(0.3) / 2 is 36 degrees, this is 35")

VIBE_POLICY_SECTION("Paths of walls at the end of a step")
VIBE_REAL(path_floor, 0.05, "thicknesses", "distance that walls keep on their paths",
          "design choice: forces stop walls at six times as much")
VIBE_REAL(path_floor_in_wall, 1e-5, "m", "distance that parts of one wall keep on their paths",
          "design choice: so small that a part without overhang does not come so near to itself unless its triangles "
          "degenerate, and need not be searched")
VIBE_REAL(path_least_distance, 1e-6, "m", "distance that never gets smaller",
          "far above rounding, far below a wall")
VIBE_REAL(path_kept_share, 0.9, "", "part of a distance below the floor that stays in a step",
          "design choice: what is nearer already may come nearer by a tenth, and never meets")
VIBE_COUNT(path_rounds, 5, "rounds of shortening until nodes that still collide are stopped in place",
           "design choice: a node that still collides has more than one obstacle")
VIBE_COUNT(path_stop_rounds, 200, "rounds of stopping until all nodes are stopped",
           "design choice: a stop spreads by an edge in a round")
VIBE_COUNT(path_advances, 30, "advances towards a collision, at most",
           "design choice: then the path ends where it is free for certain")
VIBE_REAL(path_least_advance, 1e-3, "", "part of a path below which an advance is the last",
          "design choice: a micrometre of a way of a millimetre")
VIBE_COUNT(path_searches, 20, "searches of shortened paths until all moves of a step are given up",
           "design choice: far more than a motion that converges needs")
VIBE_COUNT(path_patience, 4, "of these, searches until nodes that still collide are stopped in place",
           "design choice: what still collides then is stuck between walls")
VIBE_REAL(stop_stretch, 0.1, "", "stretch of an edge in a step because one of its nodes stops earlier than the other",
          "design choice: a tenth, which a step can resolve")
VIBE_REAL(stop_fewer, 1e-3, "", "part of this stretch that is not worth another change", "design choice: ends sweeps")
VIBE_COUNT(stop_sweeps, 100, "sweeps over the triangles while stops spread, at most",
           "design choice: a stop spreads by an edge and more in a sweep")

VIBE_POLICY_SECTION("Contacts of the tool")
VIBE_REAL(touch_margin, 2e-3, "m", "predicted distance up to which points of the wall become contacts",
          "design choice: covers 0.12 m/s that the prediction from velocities does not foresee in a step of 1/60 s")
VIBE_REAL(touch_confined, 17, "", "stiffness of tissue that cannot yield sideways over its Young's modulus",
          "(1 - nu) / ((1 + nu) (1 - 2 nu)) for nu = 0.49: soft tissue hardly changes its volume, and the scene's ratio "
          "is that of the membrane")
VIBE_REAL(touch_sticks, 0.999, "", "share of the largest friction above which a contact counts as sliding",
          "the iterations of contacts stop within this of the cone")
VIBE_REAL(touch_push_out, 0.1, "m/s", "speed at which a particle that is found inside the tool is pushed out, at most",
          "design choice: the usual 2 to 3 mm of overlap are gone within 0.03 s, and the push adds little energy")
VIBE_REAL(touch_kept_between, 0.25, "half walls", "distance that the wall keeps between points that touch",
          "design choice: far from crossing, and a scope in a stomach of a few thousand particles needs no such points")
VIBE_REAL(touch_nearest, 0.5, "half walls", "distance of a triangle below which its nearest point is a contact as well",
          "design choice: more than points between vertices are meant to keep, and more than the guard keeps")
VIBE_REAL(touch_least_yielding, 0.1, "", "weight of vertices that can move at such a point, at least",
          "design choice: with less, a force on the point moves what is held and not what is near")
VIBE_REAL(touch_usual_stretch, 1.15, "", "stretch of the wall for which points between vertices are made at least",
          "design choice: that of an insufflated stomach, so that edges have the same points from step to step")
VIBE_REAL(touch_fade_in, 0.5, "", "how much longer a part of an edge is until what halves it keeps the whole distance",
          "design choice: the edge follows the point's distance by less than a third; with half of this, walls still "
          "trembled")
VIBE_COUNT(touch_pierced_parts, 4, "parts of the edges of a triangle through which a shape already passes",
           "design choice: points within, three of them, push it aside")
VIBE_COUNT(touch_most_parts, 8, "parts of an edge that are not halved any more",
           "design choice: a needle of half a millimetre in a mesh of 10 mm")
VIBE_REAL(touch_deepest, 0.5, "radii", "depth below a shape's surface up to which a path is followed to take a normal",
          "design choice: the axis itself has none")
VIBE_REAL(touch_deepest_in_wall, 0.5, "half walls", "the same where a shape has no radius",
          "design choice: halfway between touching and crossing")
VIBE_REAL(touch_along, 0.9, "", "cosine between the normals at the ends of a step up to which one between is taken",
          "design choice: 25 degrees, which a tip reaches at 0.2 m/s; beyond, the distance is far from linear")
VIBE_REAL(touch_corner, 3e-4, "m", "depth within another shape from which a shape cannot touch",
          "walls that are held in a corner move less in a step before they rest; with 0.1 mm some trembled")
VIBE_REAL(touch_corner_slack, 0.3, "", "part of this depth by which such a contact keeps less",
          "design choice: what is beyond a corner is so far beyond it in the next step; from 0.5 on some walls trembled")
VIBE_REAL(touch_beside, 3e-4, "m", "how much farther than the nearest shape others still count",
          "walls that rest move less in a step; a scope that lies in the wall has twice as many contacts without it")
VIBE_REAL(touch_kept, 1e-4, "m", "way of a point beside its link up to which its contact stays as it is while the hand holds",
          "1.3 degrees of a tip's normal, a quarter of the angle of friction")
VIBE_REAL(touch_kept_growth, 1, "1/s", "rate at which this way grows while the hand holds, over the way",
          "what goes to and fro farther than this comes to rest later")
VIBE_REAL(touch_kept_most, 5e-4, "m", "the largest such way",
          "design choice: about the angle of friction at a tip")
VIBE_REAL(touch_within, 1e-6, "m", "distance up to which the round end of a shape counts as inside another shape",
          "design choice: far above rounding of shapes in single precision")

VIBE_POLICY_SECTION("Tool and wall on their ways")
VIBE_REAL(sweep_turn_margin, 0.25, "ways", "growth of the box around a turning shape without radius",
          "covers turns of two radians")
VIBE_COUNT(sweep_advances, 40, "advances towards a contact, at most",
           "design choice: each takes nine tenths of what is free, so that a tenth is left after a few")
VIBE_REAL(sweep_share, 0.9, "", "part of the distance above the floor that a shape without segment goes at once",
          "design choice: the bound of its speed is not exact where it turns")
VIBE_REAL(sweep_kept, 0.1, "", "part of the distance above the floor at the start at which an approach ends",
          "design choice: normals are taken there; a tenth of the way is far from the singular case")
VIBE_REAL(sweep_aim, 0.5, "", "part of that at which advances along straight lines aim",
          "design choice: halfway, so that they end below what is kept and above the floor")
VIBE_REAL(near_spare, 4e-3, "m", "distance up to which pairs of shapes and triangles are listed beyond what a step needs",
          "design choice: a press in steps of a millisecond needs another list after some 30 searches; cost alone")
VIBE_COUNT(near_group, 16, "triangles whose box is compared at once",
           "design choice: a patch about as wide as a shape; cost alone")
VIBE_REAL(guard_kept, 0.05, "thicknesses", "distance that the guard keeps between a shape and the mid-surface",
          "design choice: far below what contacts keep, far above rounding and what a joint's path differs from a "
          "straight one")
VIBE_REAL(guard_nearer, 0.9, "", "part of a smaller distance that stays in a step",
          "design choice: what is nearer already may come nearer by a tenth, and never meets")
VIBE_REAL(guard_least, 1e-3, "thicknesses", "distance below which only rounding may bring the two nearer",
          "a distance that shrinks by a part of itself in every step would become too small to get free from")
VIBE_COUNT(guard_attempts, 4, "attempts to stop the tool on its way before it stays where it was",
           "design choice: each costs a search")
VIBE_REAL(guard_taken, 0.9, "", "part of the free part of the way that the tool takes",
          "design choice: leaves a distance from which the next step can go on")
VIBE_REAL(guard_joint_part, 0.25, "", "part of what is left of its way that a joint tries where it cannot go all of it",
          "design choice: one more attempt per joint, each costs a search")

VIBE_POLICY_SECTION("Impedance for haptic devices")
VIBE_REAL(haptic_interval, 0.25, "s", "time between renewals of the stiffness, at least",
          "design choice: the wall hardly changes in the time of a hand's reaction")
VIBE_REAL(haptic_double_cost, 2, "", "time of an operation in double precision over one in single",
          "half as many numbers in a register")
VIBE_REAL(haptic_far, 5e-4, "m", "move of a node that triggers a renewal",
          "design choice: a quarter of a usual wall")
VIBE_REAL(haptic_least_step, 2e-5, "m", "move of the tool in a frame from which a slope is taken, at least",
          "design choice: 1.2 mm/s at 60 Hz; a shorter one says more of the solution than of the wall")
VIBE_REAL(haptic_least_stiffness, 1e-3, "", "stiffness over the largest below which a direction has no equilibrium",
          "design choice: the equilibrium would be a thousand times as far away")
VIBE_REAL(haptic_firm, 1e-5, "m/N", "compliance of the rows for the moving mass",
          "design choice: a thousandth of that of a wall; several points may have the same nearest node")
VIBE_REAL(haptic_least_slope, 0.2, "", "observed slope over the expected one, below which it is not taken for a slope",
          "design choice: contact that opens in the frame looks softer")
VIBE_REAL(haptic_most_slope, 2, "", "observed slope over the expected one, above which it is not taken for a slope",
          "design choice: contact that closes in the frame looks stiffer")
VIBE_REAL(haptic_most_skew, 2, "", "inverse cosine of the angle between a step and the change of force, at most",
          "design choice: 60 degrees; beyond, only the size of the change along the step counts")
VIBE_REAL(haptic_mass_spring, 1, "1/s^2", "stiffness per mass of a weak spring on each node of the static stiffness",
          "a free body has a singular stiffness; the slowest modes of organs are above 10 rad/s, so this is below a "
          "hundredth of any stiffness there")

VIBE_POLICY_SECTION("Grip")
VIBE_REAL(grip_claw_radius, 0.5, "", "distance of the claws from the middle, in standard deviations of the disc",
          "the hold does not depend on it; with this no weight of a full disc is negative")
