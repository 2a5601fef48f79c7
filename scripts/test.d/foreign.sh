# A workspace that another user has built, or that is read-only: nothing is built, and what could not be is one sentence.
# kind: computing
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"

unset VIBE_WORKSPACE_IS_BUILT
workspace=$scratch/workspace
chmod 755 "$scratch"
mkdir -p "$workspace/src/vibe_sim" "$workspace/build"
cp -r "$root/scripts" "$workspace/"
touch "$workspace/src/vibe_sim/a.cpp"

# asOther COMMAND...: as a user who cannot write to the workspace
asOther() {
  if [ "$(id -u)" -eq 0 ]; then
    setpriv --reuid=65534 --regid=65534 --clear-groups -- "$@"
  else
    chmod a-w "$workspace/build"
    "$@"
  fi
}

# isBuilt PACKAGES AGE: as scripts/build leaves it, before or after the source was written
isBuilt() {
  printf '%s\n' "$1" >"$workspace/build/vibe_built"
  touch -d "$2" "$workspace/build/vibe_built"
  chmod 755 "$workspace/build"
}

session=$(bash -c 'source "$0/scripts/lib/parts.sh" && packagesOf session' "$root" | tr ' ' ';')
build=$workspace/scripts/build
check 'what is not built cannot be told' refuses 1 'vibe_built cannot be read.*cannot write to it' asOther "$build" --part session
isBuilt everything 'now + 1 hour'
check 'there is nothing to do' asOther "$build" --quiet --part session
check 'nor for everything' asOther "$build"
isBuilt "$session" 'now + 1 hour'
check 'nor for the part that is there' asOther "$build" --part session
check 'a part that is not there is named' refuses 1 "vibe_firmware of the part 'devices' is not built.*let '.*' run scripts/build" \
  asOther "$build" --part session --part devices
check 'nor is a part the whole' refuses 1 'only a part is built' asOther "$build"
isBuilt everything 'now - 1 hour'
check 'a source that is newer is named' refuses 1 'vibe_sim/a.cpp is newer than what is built' asOther "$build" --part session
isBuilt everything 'now'
touch -d 'now - 2 hours' "$workspace/src/vibe_sim/a.cpp"
mkdir -p "$workspace/src/vibe_sim/test" "$workspace/src/vibe_vision" "$workspace/docs"
for name in vibe_sim/README.md vibe_sim/node.py vibe_sim/scene.yaml vibe_sim/test/b.cpp vibe_vision/c.cpp; do
  touch -d 'now + 1 hour' "$workspace/src/$name"
done
check 'what is not compiled, or not for this part, may be newer' asOther "$build" --part session
check 'another part is' refuses 1 'vibe_vision/c.cpp is newer' asOther "$build" --part session --part vision
check 'and tests are' refuses 1 'vibe_sim/test/b.cpp is newer' asOther "$build" --part session --tests
touch -d 'now + 1 hour' "$workspace/src/vibe_sim/CMakeLists.txt"
check 'and what a build is made of' refuses 1 'vibe_sim/CMakeLists.txt is newer' asOther "$build" --part session
chmod -R u+w "$workspace"
