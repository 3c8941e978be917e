#!/bin/sh
# check.sh [COMPILER]    compiles check.cu for a graphics processor with clang; no such processor and no CUDA is needed.
set -eu
cd "$(dirname "$0")/.."
compiler=${1:-$(command -v clang++-19 || command -v clang++)} || { echo "device-check needs clang++-19" >&2; exit 1; }
exec "$compiler" -x cuda --cuda-device-only --cuda-gpu-arch=sm_90 -nocudainc -nocudalib -std=c++20 -O1 -DNDEBUG \
  -ffp-contract=off -Wall -Wextra -Werror -Wno-bitwise-instead-of-logical -S -o /dev/null -Isrc -Iinclude device/check.cu
