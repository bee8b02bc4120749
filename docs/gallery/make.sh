#!/usr/bin/env bash
# Renders every scene of scenes-yaml/ for the README: docs/gallery/make.sh [QRT]
#
# QRT is the command, by default built and run through cargo. A few minutes on two cores.
set -euo pipefail
cd "$(dirname "$0")/../.."
qrt=${1:-target/release/qrt}
[ $# -gt 0 ] || cargo build --release

for scene in scenes-yaml/*.yaml; do
  name=$(basename "$scene" .yaml)
  exposure=1 paths=13
  case $name in
    furnace) exposure=0 paths=6 ;; # all of its paths are equal
    floor-and-light) exposure=0 ;;
  esac
  echo "$name"
  "$qrt" render "$scene" -o "docs/gallery/$name.png" --exposure "$exposure" \
    --set film.width=160 --set film.height=160 --set "sampling.path_bits=$paths" --quiet
done

# By gates alone: two minutes.
echo cornell-box-gates
"$qrt" render scenes-yaml/cornell-box.yaml -o docs/gallery/cornell-box-gates.png --model gates \
  --estimator exact --quiet
