# The site of the documentation: it is made without a problem, no page of reference is empty, and its search finds.
# kind: computing
# cost: 60
# packages: docs vibe_msgs vibe_core vibe_bringup vibe_python
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"

lists() { (cd "$root/docs/site" && /usr/bin/python3 -B -c "import reference, sys; sys.exit(reference.empty('$1'))"); }
check 'docs: a page with rows lists something' lists '# Keys\n\n| key | unit |\n|---|---|\n| `a` | m |\n'
check 'docs: a table without rows is seen' fails lists '# Keys\n\n| key | unit |\n|---|---|\n'
check 'docs: a page without tables and headings is seen' fails lists '# Command lines\n\nWhat `--help` prints.\n'

ordinaryBuild 'the site' lib/vibe_core/vibe_headless
said=$("$root/scripts/docs" --output "$scratch/docs" 2>&1)
status=$?
case $said in *'docs: missing: '*) echo "skipped the site: $said"; exit 0 ;; esac
made() { printf '%s\n' "$said"; return "$status"; }
check 'docs: the site is made, and nothing is wrong with it' made
command -v node >/dev/null || { echo 'skipped the search (it needs Node)'; exit 0; }
node "$root/docs/site/search_test.js" "$scratch/docs/html" || echo 'not ok docs: the search cannot be asked'
