#!/usr/bin/env bash
# What marking a class costs, beside copying what it writes: both in one run, so that the ratio holds whatever the machine.
#
#   benches/class.sh [STUDENTS] [LAB]
#
# Generates a class of different submissions (seeded, always the same), marks it on one core and on two, once more with nothing
# changed, and copies the output with `cp -r`: every byte of it, not only a note that both are the same. Each is done three times
# in turn; the best counts.
set -euo pipefail
cd "$(dirname "$0")/.."
students=${1:-3000}
lab=${2:-ee361-lab3}

cargo build --release --locked --quiet --bin polemark --example generate_class
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
target/release/examples/generate_class --students "$students" --seed 1 --lab "$lab" --form folder --out "$work/class" >"$work/log"
polemark() {
    target/release/polemark grade "$work/class/submissions" --lab "$lab" --out "$work/out" "$@" >"$work/log"
}

declare -A best
# name, command: keeps the least seconds.
timed() {
    local name=$1 seconds
    shift
    seconds=$({ TIMEFORMAT=%R; time "$@"; } 2>&1)
    if [[ -z ${best[$name]:-} ]] || awk "BEGIN {exit !($seconds < ${best[$name]})}"; then best[$name]=$seconds; fi
}

for _ in 1 2 3; do
    for threads in 1 2; do
        rm -rf "$work/out"
        timed "marked on $threads core(s)" polemark --threads "$threads"
    done
    timed "again, nothing changed" polemark --threads 2
    rm -rf "$work/copy"
    timed "cp -r" cp -r --reflink=never "$work/out" "$work/copy"
done

bytes=$(find "$work/out" -type f -printf '%s\n' | awk '{ sum += $1 } END { print sum }')
echo "$students submissions of $lab, $(awk "BEGIN {printf \"%.0f MB written, %.0f kB a submission\", $bytes / 1e6, $bytes / 1e3 / $students}")"
printf '%-24s %9s %14s %12s\n' '' seconds 'submissions/s' 'of cp -r'
for name in 'marked on 1 core(s)' 'marked on 2 core(s)' 'again, nothing changed' 'cp -r'; do
    awk -v name="$name" -v seconds="${best[$name]}" -v copy="${best['cp -r']}" -v students="$students" \
        'BEGIN { printf "%-24s %9.2f %14.0f %11.1f×\n", name, seconds, students / seconds, seconds / copy }'
done
