#!/bin/sh
# cross.sh PLATFORM ZIG TARGET... [-- CMAKE_OPTION...]    builds targets of core for a platform into build/platforms/PLATFORM
set -eu

platform=$1 zig=$2
shift 2
targets=
while [ $# -gt 0 ] && [ "$1" != -- ]; do
  targets="$targets $1"
  shift
done
[ $# -eq 0 ] || shift
folder=build/platforms/$platform
mkdir -p "$folder"
# zig has its own cache of compiled files.
if ! cmake -S core -B "$folder" -G Ninja -DCMAKE_TOOLCHAIN_FILE="$PWD/core/toolchains/zig.cmake" -DLANCER_PLATFORM="$platform" \
  -DLANCER_ZIG="$zig" -DCMAKE_C_COMPILER_LAUNCHER= -DCMAKE_CXX_COMPILER_LAUNCHER= -DLANCER_LIBRARY_DIR="$PWD/$folder/lib" \
  "$@" >"$folder/configure.log" 2>&1; then
  cat "$folder/configure.log"
  exit 1
fi
# shellcheck disable=SC2086 # names of targets
cmake --build "$folder" -j "${JOBS:-2}" --target $targets -- --quiet
