#!/usr/bin/env bash
# Would the tests notice? A sample of small changes to the code, each built and tested: at least 92 % have to be
# noticed, and not by what blessing rewrites (golden summaries, snapshots, recorded bits).
#
#   tests/mutants.sh [COUNT [SEED [COMMIT]]] [--again]    200, 1 and HEAD without; some 20 s a change, minutes where missed
#
# The changes are those of cargo-mutants: an operator for another, a constant for a function, a deleted field or arm.
# Each meets the tests of its own crate first and, if they pass, all of the workspace; one of the flight model meets all
# that fly it, but none that reads a recorded flight. The sample is one of COMMIT, the tests are those of HEAD. What became
# of each stands in tests/mutants/COMMIT-SEED.jsonl, and a run of the same commit and seed that was stopped goes on
# there, on another machine too if that file is committed; --again tries what was missed once more.
set -euo pipefail
cd "$(dirname "$0")/.."
if ! cargo mutants --version >/dev/null 2>&1; then
    echo "skipped: needs cargo-mutants (cargo install cargo-mutants --locked)"
    exit 77
fi
exec python3 tests/mutants.py "$@"
