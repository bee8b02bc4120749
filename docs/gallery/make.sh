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
  exposure=1 paths=13 size=160
  case $name in
    furnace) exposure=0 paths=6 ;; # all of its paths are equal
    floor-and-light) exposure=0 ;;
    lit-box) paths=10 size=256 ;; # as its file says
  esac
  echo "$name"
  "$qrt" render "$scene" -o "docs/gallery/$name.png" --exposure "$exposure" \
    --set film.width=$size --set film.height=$size --set "sampling.path_bits=$paths" --quiet
done

# By gates alone: half a minute.
echo lit-box-gates
"$qrt" render scenes-yaml/lit-box.yaml -o docs/gallery/lit-box-gates.png --model gates \
  --estimator exact --exposure 1 --set sampling.path_bits=6 --quiet
