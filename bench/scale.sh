#!/usr/bin/env bash
# What more data cost: check, describe, and windows with one epoch of training, on the synthetic campaign at several scales.
# Prints seconds of processor time, microseconds a sample, and peak memory. The sets are made first where they are not
# there (a scale of 1000 is an hour of one core, and about 900 MB).
#
#     bench/scale.sh [FOLDER [SCALE ...]]        target/scale and 1 10 100 where nothing is said
set -euo pipefail
cd "$(dirname "$0")/.."
folder=${1:-target/scale}
shift || true
scales=("$@")
[ ${#scales[@]} -gt 0 ] || scales=(1 10 100)
binaries=${CARGO_TARGET_DIR:-target}/debug
cargo build --quiet -p acm-datasets -p acm-train
mkdir -p "$folder"

# the words of a command, its processor time in s, and its peak memory in MB
measured() {
    /usr/bin/time -f '%U %S %M' -o "$folder/time" "$@" > "$folder/output" 2>&1 || { cat "$folder/output" >&2; exit 1; }
    awk '{ printf "%.3f %.0f\n", $1 + $2, $3 / 1024 }' "$folder/time"
}

# scale, command, samples, times that it was done, processor time, memory
row() {
    awk -v scale="$1" -v command="$2" -v samples="$3" -v times="$4" -v seconds="$5" -v memory="$6" \
        'BEGIN { printf "| %5d | %-8s | %9d | %9.2f | %9.2f | %7d |\n", scale, command, samples, seconds / times, 1e6 * seconds / times / samples, memory }'
}

echo '| scale | command  |   samples | s (CPU)   | µs/sample | peak MB |'
echo '| ----: | -------- | --------: | --------: | --------: | ------: |'
for scale in "${scales[@]}"; do
    set="$folder/acm-twin-$scale"
    [ -f "$set/manifest.toml" ] && "$binaries/acm-data" check "$set" > /dev/null 2>&1 \
        || "$binaries/acm-data" generate --out "$set" --scale "$scale" > /dev/null
    samples=$("$binaries/acm-data" check "$set" | sed -E 's/.* ([0-9]+) samples.*/\1/')
    # short work is done several times
    times=$((samples < 1000000 ? 1 + 1000000 / samples : 1))
    for command in check describe; do
        read -r seconds memory < <(measured bash -c "for _ in \$(seq $times); do \"$binaries/acm-data\" $command \"$set\"; done")
        row "$scale" "$command" "$samples" "$times" "$seconds" "$memory"
    done
    rm -rf "$folder/run"
    read -r seconds memory < <(measured "$binaries/acm-train" --config bench/scale.toml --set "data=\"$(realpath "$set")\"" --out "$folder/run" --quiet)
    row "$scale" epoch "$samples" 1 "$seconds" "$memory"
done
rm -rf "$folder/run" "$folder/time" "$folder/output"
