#!/bin/sh
# Ten thousand random flights across the envelope and far beyond it, twenty seconds each.
#
#   tests/ten_thousand.sh [FLIGHTS]
#
# Some ten minutes of CPU. A flight that breaks is named by seed, tick and commit; fly it again with
# TILTROTOR_SEED=<seed> tests/ten_thousand.sh
set -eu
cd "$(dirname "$0")/.."
TILTROTOR_FLIGHTS="${1:-10000}" exec cargo test --release -p engine --test violent_flights -- --nocapture
