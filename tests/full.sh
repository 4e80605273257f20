#!/usr/bin/env bash
# Everything that `.ci/run` does not run because it takes long or needs more than most machines have: each
# step with its time and result, and a table at the end. Some hours on two processors.
#
#   tests/full.sh              every step
#   tests/full.sh STEP...      these
#   tests/full.sh --list       what there is
#
# TILTROTOR names a program that is there, for the steps that take one; the others build their own.
# What a step prints is kept in target/full/STEP.log, the table in target/full/summary.txt. A step that ends
# with 77 was skipped, for it lacks something. Ends with 1 when a step has failed.
set -uo pipefail
cd "$(dirname "$0")/.."
export CARGO_TERM_COLOR=never DEBIAN_FRONTEND=noninteractive

names=()
declare -A about commands
# step NAME WHAT COMMAND: a step; the command is one for bash. Of a script that is not there, the step is said
# to be missing.
step() { names+=("$1") about[$1]=$2 commands[$1]=$3; }

test=(cargo test --release --no-default-features --target-dir target/headless)
step chains "chains of three verbs from every altered log: none comes out clean" \
    "TILTROTOR_CHAINS=3 ${test[*]} --test trust no_verb_and_no_chain -- --nocapture"
step stretches "a log flown by many threads and in one pass: the same report" "${test[*]} --test stretches"
step bits "every bit of a real log flipped" "tests/integrity.sh bits"
step kills "a hundred flights killed, a full disk" "tests/integrity.sh kills"
step fuzz "20,000 changed logs, files, packets" "tests/integrity.sh fuzz"
step memory "memory does not grow with the flight" "tests/integrity.sh memory"
step faults "every writing verb, with a fault or killed at every kind of system call" 'tests/faults.sh ${TILTROTOR:-}'
step anomaly "the story of docs/anomaly.md is what the commands print" 'tests/anomaly.sh ${TILTROTOR:-}'
step determinism "the same bits by every build and processor at hand, 64-bit Arm included" \
    'if command -v qemu-aarch64 && command -v aarch64-linux-gnu-gcc; then export TILTROTOR_AARCH64=build; fi
    tests/determinism.sh whole'
step cross "other systems' programs" "tests/cross.sh"
step fmu-windows "the FMU's Windows library beside that for Linux" 'tests/fmu_windows.sh ${TILTROTOR:-}'
step verify-speed "how fast a log is verified" 'benches/verify_speed.sh ${TILTROTOR:-}'
step jsbsim "a tick beside JSBSim's" "benches/jsbsim_ratio.sh"
step second-simulator "the task and steady flight in a second simulator, JSBSim" 'tests/second_simulator.sh ${TILTROTOR:-}'
step python-ratio "a tick from Python beside one in Rust" "tests/python.sh && benches/python_ratio.sh"
step clusters "Dask, shards and DuckDB over many flights, as docs/clusters.md shows them" 'tests/python.sh ${TILTROTOR:-} && tests/clusters.sh'
step sdist "the Python package's source distribution, built from nothing else" 'tests/sdist.sh ${TILTROTOR:-}'
step notebooks "the notebooks of python/notebooks, from top to bottom" 'tests/python.sh ${TILTROTOR:-} && tests/notebooks.sh ${TILTROTOR:-}'
step pilot-matrix "every pilot model from every start that the command offers" tests/pilot_matrix.sh
step pilots "pilot models in wind and turbulence" tests/pilots.sh
step ten-thousand "ten thousand random flights" "nice -n 15 tests/ten_thousand.sh"
step mutants "a sample of small changes to the code: would the tests notice?" tests/mutants.sh
step rerun "a flight seen in the rerun viewer" \
    'cargo run --release -- demo --fast --force --no-flightgear --out target/full/demo.mcap &&
    cargo run --release -- view target/full/demo.mcap --force --save target/full/demo.rrd &&
    tests/rerun_screenshot.sh target/full/demo.rrd target/full/demo.png 15'
for script in tests/flightgear_*.sh tests/qemu_stick.sh tests/realtime.sh tests/keyboard_flight.sh; do
    name=$(basename "$script" .sh)
    step "${name//_/-}" "$(sed -n '2s/^# *//p' "$script" 2>/dev/null)" "$script"
done

if [ "${1:-}" = --list ]; then
    for name in "${names[@]}"; do printf '%-18s %s\n' "$name" "${about[$name]}"; done
    exit
fi
for name in "$@"; do
    [ -n "${commands[$name]:-}" ] || { echo "$0: no step $name; $0 --list says which there are" >&2; exit 2; }
done
[ $# -gt 0 ] || set -- "${names[@]}"

mkdir -p target/full
commit=$(git rev-parse --short HEAD)$(git diff --quiet HEAD || echo ", with changes")
table=$(mktemp)
trap 'rm -f "$table"' EXIT
failed=0
for name in "$@"; do
    command=${commands[$name]} log=target/full/$name.log
    script=$(grep -o '\(tests\|benches\)/[a-z_]*\.sh' <<<"$command" | tail -1)
    begun=$SECONDS
    if [ -n "$script" ] && [ ! -e "$script" ]; then
        result=missing note="$script is not there"
    else
        printf '== %s: %s\n' "$name" "${about[$name]}"
        bash -euo pipefail -c "$command" 2>&1 | tee "$log"
        case ${PIPESTATUS[0]} in
        0) result=passed ;;
        77) result=skipped ;;
        *) result=FAILED failed=$((failed + 1)) ;;
        esac
        note=$(grep -v '^ *$' "$log" | tail -1 | cut -c 1-90)
    fi
    took=$((SECONDS - begun))
    printf '%-18s %-8s %3d:%02d  %s\n' "$name" "$result" $((took / 60)) $((took % 60)) "$note" >>"$table"
done
{
    printf '\ncommit %s, %s, %d processors, %d:%02d min\n' "$commit" "$(date -u '+%Y-%m-%d %H:%M UTC')" \
        "$(nproc)" $((SECONDS / 60)) $((SECONDS % 60))
    cat "$table"
    echo "$failed of $# steps failed"
} | tee target/full/summary.txt
[ "$failed" = 0 ]
