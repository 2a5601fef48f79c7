# Counts of instructions: what the script refuses, and how it reads what callgrind writes. What it counts, scripts/accuracy
# does.
# kind: computing
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"

cat >"$scratch/counted" <<'FILE'
version: 1
events: Ir
fl=(1) ???
fn=(1) vibe::benchmarks::countedStep(vibe::Simulation&, vibe::StepInput const&)
0 6
cfi=(1)
cfn=(2) vibe::Simulation::step(vibe::StepInput const&)
calls=2 0
0 4000000

fn=(2)
0 900000
cfn=(3) vibe::QuasiNewton::applyInverse(double const*)
calls=4 0
0 3000000
cfn=(4) vibe::FactorSchedule::provide(int)
calls=1 0
* 100000

fn=(3)
+12 2000000
cfn=(5) vibe::ConstraintSchur::eliminate(int)
calls=4 0
-3 1000000

fn=(4)
0 100000

fn=(5)
0 1000000
FILE

# The first step of a run is not counted: it makes the first factor.
check 'instructions per step, with those of what is called' \
  prints '^free +2 +2\.000 +0\.000 +0\.050 +0\.000 +1\.500 +0\.500 +0\.000 +0\.000$' \
  /usr/bin/python3 -B "$root/scripts/lib/instructions.py" none --read "$scratch/counted" free
sed -i 's/countedStep/notCounted/' "$scratch/counted"
check 'a file without a step is refused' refuses 1 "has counted no step of 'free'" \
  /usr/bin/python3 -B "$root/scripts/lib/instructions.py" none --read "$scratch/counted" free
check 'an unknown state is refused' refuses 2 "there is no state 'juggled'; choose of free" "$root/scripts/instructions" juggled
check 'a scene that is missing is refused' refuses 2 "there is no file 'none.yaml'" "$root/scripts/instructions" --scene none.yaml
