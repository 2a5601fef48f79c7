# vibe_technique as a lab meets it: names sets, refuses bad files in one sentence, prints the tables of the docs.
# kind: computing
# packages: docs vibe_core
source "$(dirname -- "${BASH_SOURCE[0]}")/../lib/check.sh"

program=$root/devel${VIBE_VARIANT:-}/lib/vibe_core/vibe_technique
[ -x "$program" ] || skip 'vibe_technique (not built; scripts/build builds it)'
docs=$root/docs/technique.md

# codeBlock N: the text of the N-th block of code of the docs.
codeBlock() {
  awk -v wanted="$1" '/^```/ { ++fence; next } fence == 2 * wanted - 1' "$docs"
}

printsWhatTheDocsShow() {
  codeBlock 2 >"$scratch/log.csv"
  [ "$("$program" "$scratch/log.csv")" = "$(codeBlock 3)" ] || { "$program" "$scratch/log.csv"; return 1; }
  [ "$("$program" - <"$scratch/log.csv")" = "$(codeBlock 3)" ]
}

printedRuleMissesTheU() {
  codeBlock 2 >"$scratch/log.csv"
  "$program" --rule printed "$scratch/log.csv" | cut -d, -f 3 | tr '\n' ' ' | grep -qx 'technique other z '
}

# Nothing on standard output: a reader downstream must not take half a file for a whole one.
saysNothingElse() {
  [ -z "$("$program" "$1" 2>"$scratch/said")" ]
}

tablesAreThoseOfTheDocs() {
  diff <(sed -n '/^<!-- table -->/,/^<!-- end of table -->/p' "$docs" | sed '1d;$d') \
    <("$program" --table 200 --seed 2026)
}

printf '0,0,0\n1,0,0\n\n1,1\n' >"$scratch/column.csv"
printf '0,0,0\n1,0,nan\n' >"$scratch/nan.csv"
printf '0,0,0\n1,o,0\n' >"$scratch/word.csv"
: >"$scratch/empty.csv"

check 'vibe_technique prints what the docs show' printsWhatTheDocsShow
check 'vibe_technique: the printed rule misses the U' printedRuleMissesTheU
check 'vibe_technique --help' "$program" --help
check 'vibe_technique: missing column' refuses 2 'column.csv:4: .*columns.*x,y,z' "$program" "$scratch/column.csv"
check 'vibe_technique: not finite' refuses 2 'nan.csv:2: .*not finite' "$program" "$scratch/nan.csv"
check 'vibe_technique: no number' refuses 2 "word.csv:2: y 'o' is not a number" "$program" "$scratch/word.csv"
check 'vibe_technique: empty file' refuses 2 'empty.csv holds no bite' "$program" "$scratch/empty.csv"
check 'vibe_technique: missing file' refuses 2 'cannot be opened' "$program" "$scratch/none.csv"
check 'vibe_technique: a folder' refuses 2 'could not be read' "$program" "$scratch"
check 'vibe_technique: no file named' refuses 2 'Name one file' "$program"
check 'vibe_technique: unknown rule' refuses 2 "--rule: best not in .*corrected,printed" "$program" --rule best "$scratch/nan.csv"
check 'vibe_technique: unknown option' refuses 2 "'--loud' is unknown" "$program" --loud
check 'vibe_technique: bad input prints no rows' saysNothingElse "$scratch/column.csv"
if [ -z "${VIBE_VARIANT:-}" ]; then check 'tables in docs/technique.md are what is measured' tablesAreThoseOfTheDocs; fi
