#!/usr/bin/env bash
# Renders every scene of scenes-yaml/ for the README: docs/gallery/make.sh [QRT]
#
# QRT is the command, by default built and run through cargo. A few minutes on two cores.
set -euo pipefail
cd "$(dirname "$0")/../.."
qrt=${1:-target/release/qrt}
[ $# -gt 0 ] || cargo build --release

# As cornell-box.yaml and the others say, and with their lamps sampled at every surface that reflects.
lit='{ bits: [8, 8], light: [8, 8] }'
for scene in scenes-yaml/*.yaml; do
  name=$(basename "$scene" .yaml)
  exposure=1 paths=10
  sets=(--set sampling.lights=auto --set "sampling.depths=[{ bits: [8, 8] }, $lit, $lit]")
  case $name in
    furnace) exposure=0 paths=6 sets=() ;; # nothing but lamps; all of its paths are equal
    floor-and-light) exposure=0 ;;
    lit-box) sets=() ;; # as its file says
    terrace | weekend) continue ;; # below
    cornell-glass) paths=11 sets=(--set sampling.lights=auto --set "sampling.depths=[{ bits: [8, 8] }, $lit, $lit, $lit, $lit]") ;;
  esac
  echo "$name"
  "$qrt" render "$scene" -o "docs/gallery/$name.png" --exposure "$exposure" "${sets[@]}" \
    --set film.width=256 --set film.height=256 --set "sampling.path_bits=$paths" --estimator sine --quiet
done

# All paths' mean: the scale of a scene with a sun asks for many queries. Half a minute.
echo terrace
"$qrt" render scenes-yaml/terrace.yaml -o docs/gallery/terrace.png --estimator exact --exposure=-1.5 \
  --set film.width=256 --set film.height=256 --set camera.perspective.vfov=44 --quiet

# By gates alone: half a minute.
echo lit-box-gates
"$qrt" render scenes-yaml/lit-box.yaml -o docs/gallery/lit-box-gates.png --model gates \
  --estimator exact --exposure 1 --set sampling.path_bits=6 --quiet

# A mesh of 1,536 triangles by gates alone: ten minutes of processor time. ImageMagick makes 4 x 4 of each pixel.
echo knot-gates
"$qrt" render scenes-yaml/knot.yaml -o docs/gallery/knot-gates.png --model gates --estimator exact --exposure 1 \
  --set circuit.uncompute=keep --set sampling.lights=auto --set "sampling.depths=[{ bits: [8, 8] }, $lit, $lit]" \
  --set sampling.path_bits=8 --quiet
magick docs/gallery/knot-gates.png -scale 256x256 docs/gallery/knot-gates.png

# The cover by gates alone and counted: seven minutes of processor time, and two.
echo weekend
small=(--set film.width=200 --set film.height=112)
"$qrt" render scenes-yaml/weekend.yaml -o docs/cover/weekend-gates.png --model gates \
  --estimator exact "${small[@]}" --set sampling.path_bits=6 --quiet
"$qrt" render scenes-yaml/weekend.yaml -o docs/cover/weekend-counted.png "${small[@]}" --quiet

# By complete counting circuits, as amplitudes: a minute on one core. ImageMagick makes 32 x 32 of each pixel.
echo shadow-simulated
"$qrt" simulate scenes-yaml/small/shadow.yaml --film docs/gallery/shadow-simulated.png
magick docs/gallery/shadow-simulated.png -scale 256x256 docs/gallery/shadow-simulated.png
