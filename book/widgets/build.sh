#!/usr/bin/env bash
# Makes qrt_NAME.wasm in book/interactive/dist, one for each of the book's interactive figures and one for
# its playground: qrt's own code, for figures small, for the playground quick. A page loads what its
# figure needs and no other's.
#
#   book/widgets/build.sh           exits 0 if it is made or was new enough, 3 if there is nothing
#                                   to make it with (one line says what is missing), 1 if it fails
#
# A compiler for wasm32-unknown-unknown is looked for, in this order:
#   - rustup's, with the sources of the standard library (rust-src), which makes the smallest;
#   - rustup's, with the target's standard library, if that is installed or can be, now;
#   - Debian's packages of rustc for the web, unpacked into a folder of their own, not installed
#     (140 MB to download, once).
# Binaryen's wasm-opt makes it a tenth smaller: the one that is installed, or Debian's, unpacked.
# Both go to $QRT_WASM_TOOLCHAIN, by default target/wasm-toolchain.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
root=$(cd "$here/../.." && pwd)
dist=$root/book/interactive/dist
# The features of qrt-figures. The playground comes first and the others in this order: the last one's
# time says whether all are new.
figures=(counting map circuit picture)
build=${CARGO_TARGET_DIR:-$root/target}/figures
tools=${QRT_WASM_TOOLCHAIN:-$root/target/wasm-toolchain}
triple=wasm32-unknown-unknown
# What an outer cargo tells its own children is not meant for this one.
unset RUSTFLAGS CARGO_ENCODED_RUSTFLAGS RUSTC RUSTC_WRAPPER RUSTC_WORKSPACE_WRAPPER CARGO_TARGET_DIR

lacks() {
  printf 'book/widgets/build.sh: %s\n' "$*" >&2
  exit 3
}

is_new() {
  local name
  for name in playground "${figures[@]}"; do
    [ -f "$dist/qrt_$name.wasm" ] || return 1
  done
  [ -z "$(
    find "$here" "$root/drawing" "$root/qrt-circuit" "$root/qrt-core" "$root/qrt-counting" \
      "$root/qrt-lab" "$root/qrt-machines" "$root/qrt-runtime" "$root/qrt-scene" \
      "$root/qrt-syntax" "$root/qrt-tracer" "$root/Cargo.toml" "$root/scenes-yaml" -type d -name target -prune -o \
      -type f -newer "$dist/qrt_${figures[-1]}.wasm" -print -quit
  )" ]
}

# Has this compiler the sources of its standard library? Or the target's, compiled?
has_sources() {
  [ -f "$(rustc --print sysroot)/lib/rustlib/src/rust/library/std/Cargo.toml" ]
}
has_target() {
  [ -n "$(find "$(rustc --print sysroot)/lib/rustlib/$triple/lib" -name 'libstd-*' 2>/dev/null)" ]
}

# Asks rustup for something; not for long.
ask_rustup() {
  command -v rustup >/dev/null && timeout 120 rustup "$@" >/dev/null 2>&1
}

# Debian's packages of these names, unpacked; nothing is installed.
unpack() {
  command -v apt-get >/dev/null && command -v dpkg >/dev/null || return 1
  [ "$(dpkg --print-architecture)" = amd64 ] || return 1
  mkdir -p "$tools/packages" "$tools/root"
  local done=0 package
  (cd "$tools/packages" && apt-get -qq download "$@" 2>/dev/null) || done=1
  for package in "$tools"/packages/*.deb; do
    [ "$done" = 0 ] && dpkg -x "$package" "$tools/root" || done=1
  done
  rm -rf "$tools/packages" "$tools/root/usr/share"
  return "$done"
}

debian_rustc() {
  LD_LIBRARY_PATH=$tools/root/usr/lib/x86_64-linux-gnu "$tools/root/usr/bin/rustc" "$@"
}

# Debian's compiler, its libraries and the standard library's sources, whatever their version is.
unpack_debian_rustc() {
  local std llvm
  std=$(apt-cache depends libstd-rust-web-dev 2>/dev/null |
    sed -n 's/^ *Depends: *\(libstd-rust-web-[0-9.]*\)$/\1/p' | head -n 1)
  [ -n "$std" ] || return 1
  llvm=$(apt-cache depends "$std" | sed -n 's/^ *Depends: *\(libllvm[0-9.]*\)$/\1/p' | head -n 1)
  rm -rf "$tools/root"
  unpack rustc-web libstd-rust-web-dev "$std" rust-web-src ${llvm:+"$llvm"} || return 1
  # Of the sources, the standard library's alone.
  find "$tools"/root/usr/src/rustc-* -mindepth 1 -maxdepth 1 ! -name library -exec rm -rf {} +
}

# A linker: rustup brings one along, Debian's compiler does not.
linker() {
  local found
  found=$(find "$(rustc --print sysroot 2>/dev/null)" "${RUSTUP_HOME:-$HOME/.rustup}/toolchains" \
    -name rust-lld -type f 2>/dev/null | head -n 1)
  [ -n "$found" ] || found=$(command -v wasm-ld || command -v rust-lld) || return 1
  printf '%s\n' "$found"
}

if is_new; then
  exit 0
fi
command -v cargo >/dev/null || lacks "cargo is not installed"
cd "$here"

# Waits for a cargo whose words go to the log, and now and then says what it is at.
progress() {
  local begin=$SECONDS told=$SECONDS
  while kill -0 "$1" 2>/dev/null; do
    sleep 0.2
    if [ $((SECONDS - told)) -ge 20 ]; then
      told=$SECONDS
      printf '  %s s: %s\n' $((SECONDS - begin)) "$(grep -a Compiling "$build/log" | tail -n 1 | sed 's/^ *//; s/ (.*//')" >&2
    fi
  done
  wait "$1"
}

# Compiles the module $1, by the profile $2 of the package qrt-$2, into $build/modules; the other
# arguments are cargo's.
compile_one() {
  local name=$1 kind=$2
  shift 2
  cargo rustc --locked --ignore-rust-version --package "qrt-$kind" --profile "$kind" --lib \
    --crate-type cdylib --target "$triple" --target-dir "$build" "$@" 2>"$build/log" &
  progress "$!" || return 1
  cp "$build/$triple/$kind/qrt_$kind.wasm" "$build/modules/qrt_$name.wasm"
}

# Compiles all; the arguments are cargo's.
compile() {
  local figure
  printf 'compiling qrt for browsers: %s\n' \
    'two to four minutes on two cores, the first time and after changes of its crates' >&2
  for figure in "${figures[@]}"; do
    compile_one "$figure" figures --no-default-features --features "$figure" "$@" || return 1
  done
  compile_one playground playground "$@"
}

# Compiles the standard library along, without the texts of its panics, which nobody would see.
compile_all() {
  local flags="-Zunstable-options -Cpanic=immediate-abort"
  # shellcheck disable=SC2086 # Two words.
  RUSTC_BOOTSTRAP=1 "${RUSTC:-rustc}" $flags --target "$triple" --print cfg >/dev/null 2>&1 || flags=
  RUSTC_BOOTSTRAP=1 CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_RUSTFLAGS=$flags \
    compile -Zbuild-std=std,panic_abort -Zbuild-std-features=optimize_for_size
}

fail() {
  cat "$build/log" >&2
  if grep -qE 'failed to (download|get|fetch)|[Cc]ould not resolve' "$build/log"; then
    lacks "crates cannot be downloaded"
  fi
  exit 1
}

mkdir -p "$build/modules" "$dist"
if has_sources || ask_rustup component add rust-src; then
  compile_all || { has_target || ask_rustup target add "$triple" && compile; } || fail
elif has_target || ask_rustup target add "$triple"; then
  compile || fail
else
  debian_rustc --version >/dev/null 2>&1 || unpack_debian_rustc || true
  debian_rustc --version >/dev/null 2>&1 ||
    lacks "no compiler for $triple: \`rustup target add $triple\` installs one"
  CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER=$(linker) || lacks "no linker for $triple"
  export CARGO_TARGET_WASM32_UNKNOWN_UNKNOWN_LINKER
  LD_LIBRARY_PATH=$tools/root/usr/lib/x86_64-linux-gnu${LD_LIBRARY_PATH:+:$LD_LIBRARY_PATH} \
    RUSTC=$tools/root/usr/bin/rustc compile_all || fail
fi

# The module $1, by wasm-opt with the options from $2 on, also where only these libraries are there.
optimise() {
  local module=$1
  shift
  LD_LIBRARY_PATH=$tools/root/usr/lib/x86_64-linux-gnu "$@" --strip-debug --strip-producers \
    --enable-bulk-memory --enable-sign-ext --enable-nontrapping-float-to-int \
    --enable-mutable-globals --enable-multivalue --enable-reference-types \
    "$module" -o "$module.small" 2>/dev/null
}

own=$tools/root/usr/bin/wasm-opt
for name in playground "${figures[@]}"; do
  made=$build/modules/qrt_$name.wasm
  level=-Oz
  [ "$name" != playground ] || level=-O2
  if ! optimise "$made" wasm-opt "$level" &&
    ! { { [ -x "$own" ] || unpack binaryen; } && optimise "$made" "$own" "$level"; }; then
    cp "$made" "$made.small"
  fi
  printf 'qrt_%s.wasm: %s bytes of WebAssembly\n' "$name" "$(wc -c <"$made.small")"
done
for name in playground "${figures[@]}"; do
  mv "$build/modules/qrt_$name.wasm.small" "$dist/qrt_$name.wasm"
  touch "$dist/qrt_$name.wasm"
done
