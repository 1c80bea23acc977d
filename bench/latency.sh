#!/usr/bin/env bash
# One step beside a robot, here and in PyTorch and ONNX Runtime: in turns, round after round, on one pinned core; one table.
#
#   bench/latency.sh --python PYTHON [--rounds N]
#
# PYTHON has torch, ncps, onnx and onnxruntime. A figure is the median over rounds of each round's median, and of its 99 %
# point, in microseconds. The peers compute the network alone; they are held against our network alone and against all
# that our estimator does for a sample: scaling, network, nominal model.
set -euo pipefail
cd "$(dirname "$0")/.."
rounds=5 python=''
while [ $# -gt 0 ]; do
    case $1 in
        --rounds) rounds=$2; shift 2 ;;
        --python) python=$2; shift 2 ;;
        *) echo "unknown argument $1; see the head of $0" >&2; exit 2 ;;
    esac
done
[ -n "$python" ] || { echo "--python is missing; see the head of $0" >&2; exit 2; }
core=$(($(nproc) - 1))
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

cargo build -q -p acm-stream --example latency
step="${CARGO_TARGET_DIR:-target}/debug/examples/latency"
for ((round = 1; round <= rounds; round++)); do
    echo "round $round of $rounds" >&2
    taskset -c "$core" "$step" 20000 >> "$out/lines"
    taskset -c "$core" "$python" bench/peers_latency.py --steps 20000 >> "$out/lines" 2> "$out/errors" ||
        { cat "$out/errors" >&2; exit 1; }
done

grep -m1 'model name' /proc/cpuinfo || true
date -u +%F
awk -f bench/latency.awk "$out/lines"
