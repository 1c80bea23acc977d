#!/usr/bin/env bash
# One training step of the three networks, beside PyTorch and JAX: alternately, round after round, on one pinned core
# and then on two; one table of medians and ratios.
#
#   bench/run.sh [--rounds N] [--peers DIR --python PYTHON]
#
# DIR holds bench_torch.py and bench_jax.py, PYTHON has torch, ncps, jax, equinox and optax. Without them only this
# project is timed, fused and in plain burn operations. Times are of the processor on one core, of the clock on two.
set -euo pipefail
cd "$(dirname "$0")/.."
rounds=5 peers='' python=python3
while [ $# -gt 0 ]; do
    case $1 in
        --rounds) rounds=$2; shift 2 ;;
        --peers)  peers=$2;  shift 2 ;;
        --python) python=$2; shift 2 ;;
        *) echo "unknown argument $1; see the head of $0" >&2; exit 2 ;;
    esac
done
core=$(($(nproc) - 1))
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

cargo build -q -p acm-train --example training_step
step="${CARGO_TARGET_DIR:-target}/debug/examples/training_step"

one_core() {
    taskset -c "$core" "$step" --rounds 60
    taskset -c "$core" "$step" --rounds 20 --plain
    [ -z "$peers" ] && return
    (cd "$peers" && taskset -c "$core" "$python" bench_jax.py --reps 30)
    (cd "$peers" && taskset -c "$core" "$python" bench_torch.py --threads 1 --reps 20)
}
two_cores() {
    "$step" --rounds 60 --threads 2
    [ -z "$peers" ] && return
    (cd "$peers" && "$python" bench_jax.py --reps 30)
    (cd "$peers" && "$python" bench_torch.py --threads 2 --reps 20)
}
for ((round = 1; round <= rounds; round++)); do
    echo "round $round of $rounds" >&2
    one_core >> "$out/1" 2> "$out/errors" || { cat "$out/errors" >&2; exit 1; }
    two_cores >> "$out/2" 2> "$out/errors" || { cat "$out/errors" >&2; exit 1; }
done

grep -m1 'model name' /proc/cpuinfo || true
date -u +%F
awk -f bench/table.awk time=cpu "$out/1"
echo
awk -f bench/table.awk time=wall "$out/2"
