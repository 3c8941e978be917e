#!/bin/sh
# packages.sh SET...    installs the missing packages of the named sets (build, run, test, fuzz, format, platforms, and povray,
# llvm for the benchmark's peers) with one call of apt-get. Each package is detected by its content (a command, a library, a
# header), so that a copy from elsewhere suffices.
set -eu

command_is_there() { command -v "$1" >/dev/null 2>&1; }
library_is_there() { printf '%s\n' "$libraries" | grep -q "^[[:space:]]*$1 "; }
file_is_there() { for file in $1; do [ -e "$file" ] && return 0; done; return 1; }
python_has() { command_is_there "$1" && "$1" -c "import $2" >/dev/null 2>&1; }

python=${PYTHON:-python3}
if [ "$python" != python3 ] && ! "$python" -c "" >/dev/null 2>&1; then
  echo "PYTHON=$python: this machine has no such Python." >&2
  exit 1
fi

missing=
want() { # PACKAGE PROBE ARGUMENT...
  package=$1
  shift
  "$@" || missing="$missing $package"
}

want_build() {
  want g++ command_is_there "${CXX:-g++}"
  want cmake command_is_there cmake
  want ninja-build command_is_there ninja
  want libglm-dev file_is_there "/usr/include/glm/glm.hpp /usr/local/include/glm/glm.hpp"
}

# Blender's Python module links against the X libraries even without windows, and aborts without EGL when it draws strokes of
# grease pencil.
want_run() {
  want_build
  want python3 command_is_there "$python"
  want "${python##*/}-venv" python_has "$python" "venv, ensurepip"
  want libx11-6 library_is_there libX11.so.6
  want libxext6 library_is_there libXext.so.6
  want libxrender1 library_is_there libXrender.so.1
  want libxfixes3 library_is_there libXfixes.so.3
  want libxi6 library_is_there libXi.so.6
  want libxkbcommon0 library_is_there libxkbcommon.so.0
  want libsm6 library_is_there libSM.so.6
  want libice6 library_is_there libICE.so.6
  want libgl1 library_is_there libGL.so.1
  want libegl1 library_is_there libEGL.so.1
}

want_test() {
  want_run
  want libgtest-dev file_is_there "/usr/include/gtest/gtest.h /usr/local/include/gtest/gtest.h"
  want blender command_is_there blender
  want python3-numpy python_has /usr/bin/python3 numpy
  want xvfb command_is_there Xvfb
  want xdotool command_is_there xdotool
  want imagemagick command_is_there import
  want libgl1-mesa-dri file_is_there "/usr/lib/*/dri/*_dri.so /usr/lib/dri/*_dri.so"
  want nodejs command_is_there node
  want munge file_is_there "/usr/sbin/munged"
  want slurmctld file_is_there "/usr/sbin/slurmctld"
  want slurmd file_is_there "/usr/sbin/slurmd"
  want slurm-client command_is_there sbatch
}

# A compiler with sanitizers and libFuzzer.
want_fuzz() {
  want_test
  want clang-19 command_is_there clang++-19
  want libclang-rt-19-dev file_is_there "/usr/lib/llvm-19/lib/clang/19/lib/linux/libclang_rt.fuzzer-*.a"
}

# Programs that run and inspect the libraries of other systems.
want_platforms() {
  want_test
  want debootstrap command_is_there debootstrap
  want iproute2 command_is_there ip
  want qemu-user-static command_is_there qemu-aarch64-static
  want wine64 file_is_there "/usr/lib/wine/wine64"
  want llvm command_is_there llvm-readobj
  want maven command_is_there mvn
}

want_povray() {
  want povray command_is_there povray
}

# Mitsuba compiles its kernels with this library.
want_llvm() {
  want libllvm19 library_is_there libLLVM.so.19.1
}

want_format() {
  want python3 command_is_there "$python"
  want "${python##*/}-venv" python_has "$python" "venv, ensurepip"
}

libraries=$(PATH="$PATH:/usr/sbin:/sbin" ldconfig -p 2>/dev/null || true)
for set in "$@"; do
  "want_$set"
done
missing=$(printf '%s\n' $missing | sort -u | tr '\n' ' ')
[ -n "$(printf '%s' "$missing" | tr -d ' ')" ] || exit 0

if ! command_is_there apt-get; then
  echo "Lancer needs these packages (names of Debian), and this machine has no apt-get to install them: $missing" >&2
  exit 1
fi
sudo=
if [ "$(id -u)" -ne 0 ]; then
  if ! command_is_there sudo; then
    echo "Lancer needs these packages, whose installation requires root: apt-get install $missing" >&2
    exit 1
  fi
  sudo=sudo
fi
echo "== packages: $missing"
mkdir -p build
log=build/packages.log
if ! { $sudo apt-get update -qq && $sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends $missing; } \
  >"$log" 2>&1 </dev/null; then
  cat "$log" >&2
  echo "The packages could not be installed: $missing" >&2
  exit 1
fi
