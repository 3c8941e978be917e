#!/bin/sh
# test_platforms.sh PYTHON PLATFORM...    runs the C++ tests and those of the bindings with the libraries of other platforms: of
# Linux on the oldest supported Debian, of arm64 under qemu, of Windows under wine. Libraries that cannot be run here are
# inspected. A part of a picture must have the same bytes as here. The zips of this machine's platform are installed, also from a
# repository, and Rendered shading runs in windows of the next Debian's Blender.
set -eu

case $1 in
/*) python=$1 ;;
*) python=$PWD/$1 ;;
esac
shift
JOBS=${JOBS:-2}
places=$PWD/build/platforms
roots=$places/roots
oldest=bullseye
# A complete Windows Python from Maven's registry, with a C library of Microsoft's: wine's own lacks functions that numpy calls.
windows_python=org.bytedeco:cpython:3.12.1-1.5.10:jar:windows-x86_64
windows_runtime=org.bytedeco:javacpp:1.5.10:jar:windows-x86_64
# Dependencies of the bindings' tests; tests that need a compiler or another process, or measure time, run only on this
# platform.
packages="numpy scipy pytest pytest-timeout iniconfig packaging pluggy pygments colorama trimesh mpmath"
tests="abi/test_abi abi/test_abi_handles abi/test_abi_sessions abi/test_abi_states abi/test_library_file abi/test_snapshot
  abi/test_picture_parts abi/test_part_bytes
  physics/test_classic physics/test_camera physics/test_nodes physics/test_pass_values blender/test_uses"

say() { echo "== $*"; }
as_root() { if [ "$(id -u)" -eq 0 ]; then "$@"; else sudo "$@"; fi; }

# root NAME RELEASE ARCHITECTURE PACKAGES: unpacks a Debian's packages into a folder without setting them up.
root() {
  [ ! -e "$roots/$1.done" ] || return 0
  say "root $1: Debian $2, $3"
  mkdir -p "$roots"
  as_root rm -rf "${roots:?}/$1"
  as_root debootstrap --foreign --variant=minbase --arch="$3" ${4:+--include="$4"} "$2" "$roots/$1" >"$roots/$1.log" 2>&1 ||
    { tail -20 "$roots/$1.log"; exit 1; }
  for package in "$roots/$1"/var/cache/apt/archives/*.deb; do as_root dpkg-deb -x "$package" "$roots/$1"; done
  touch "$roots/$1.done"
}

# Sets up the next Debian with its Blender, for next_blender.sh.
next_debian() {
  [ ! -e "$roots/trixie.done" ] || return 0
  say "root trixie: Debian 13 and its Blender"
  mkdir -p "$roots"
  as_root rm -rf "$roots/trixie"
  as_root debootstrap --variant=minbase --include=blender,python3-numpy,libgl1-mesa-dri,libegl1 trixie "$roots/trixie" \
    >"$roots/trixie.log" 2>&1 || { tail -20 "$roots/trixie.log"; exit 1; }
  touch "$roots/trixie.done"
}

# wheels FOLDER PYTHON_VERSION PIP_PLATFORM...
wheels() {
  [ ! -e "$1.done" ] || return 0
  folder=$1 version=$2
  shift 2
  say "Python packages: $folder"
  rm -rf "$folder"
  for name in "$@"; do set -- "$@" --platform "$name"; shift; done
  # shellcheck disable=SC2086 # names of packages
  "$python" -m pip install --quiet --disable-pip-version-check --no-deps --only-binary :all: --target "$folder" \
    --python-version "$version" "$@" $packages
  touch "$folder.done"
}

# stage PLATFORM: copies the project as it would be on the other system.
stage() {
  tree=$places/$1/tree
  rm -rf "$tree"
  mkdir -p "$tree/core"
  cp -a .ci LICENSE addon blender_tests scenes pyproject.toml "$tree"
  cp -a core/include "$tree/core"
  rm -rf "$tree/addon/lib"
  cp -a "$places/$1/lib" "$tree/addon/lib"
}

# files: the tests' paths in the staged tree.
files() { for name in $tests; do printf 'blender_tests/%s.py ' "$name"; done; }

# cpp PLATFORM COMMAND...: runs the C++ tests and all inputs found by fuzzing, with a command that runs the platform's programs.
# One process per processor shares the tests: under qemu they take the better part of an hour.
cpp() {
  platform=$1 ending='' shard=0
  shift
  [ "$platform" != windows-x64 ] || ending=.exe
  say "$platform: C++ tests"
  while [ "$shard" -lt "$JOBS" ]; do
    GTEST_TOTAL_SHARDS=$JOBS GTEST_SHARD_INDEX=$shard "$@" "$places/$platform/lancer_tests$ending" \
      --gtest_filter="${LANCER_CPP_TESTS:-*}" </dev/null 2>&1 | cat >"$places/$platform/tests-$shard.log" &
    shard=$((shard + 1))
  done
  wait
  failed=
  while [ "$shard" -gt 0 ]; do
    shard=$((shard - 1))
    log=$places/$platform/tests-$shard.log
    grep -E '^\[  (PASSED|FAILED)|Failure' "$log" || true
    { grep -q '^\[  PASSED  \]' "$log" && ! grep -q '^\[  FAILED' "$log"; } || failed="$failed $log"
  done
  [ -z "$failed" ] || { say "$platform: C++ tests failed or did not finish:$failed"; exit 1; }
  "$@" "$places/$platform/lancer_replay$ending" core/fuzz/corpus </dev/null >"$places/$platform/replay.log" 2>&1
}

# python_tests PLATFORM COMMAND...: runs the tests of the bindings. Output goes through a pipe, because wine's Python cannot
# write to a file.
python_tests() {
  platform=$1
  shift
  say "$platform: tests of the bindings"
  # shellcheck disable=SC2046 # names of files
  (cd "$places/$platform/tree" && "$@" -m pytest -q -p no:cacheprovider -m "not slow" $(files) </dev/null 2>&1) |
    tee "$places/$platform/bindings.log" | tail -3
  grep -qE '^[0-9]+ passed' "$places/$platform/bindings.log"
  same_parts "$platform" "$@"
}

# same_parts PLATFORM COMMAND...: renders some samples of a picture there and here, which must give the same bytes.
same_parts() {
  tree=$places/$1/tree
  say "$1: the bytes of a part of a picture"
  shift
  here="env -u PYTHONHOME -u PYTHONPATH $python"
  options="--samples 64 --part 2/2 --threads 2 --output"
  env -u PYTHONHOME PYTHONPATH=blender_tests/helpers:. "$python" -c 'import sys, picture_parts
picture_parts.room(64, (43, 39), max_bounces=8).save(sys.argv[1])' "$tree/scene.npz"
  # shellcheck disable=SC2086 # words
  $here -m addon.farm part "$tree/scene.npz" $options "$tree/here.lancer"
  # shellcheck disable=SC2086 # words
  (cd "$tree" && "$@" -m addon.farm part scene.npz $options there.lancer </dev/null 2>&1 | cat)
  cmp "$tree/there.lancer" "$tree/here.lancer"
}

linux_x64() {
  root "$oldest" "$oldest" amd64 ""
  system=$roots/$oldest/lib/x86_64-linux-gnu
  set -- "$system/ld-linux-x86-64.so.2" --library-path "$system:$roots/$oldest/usr/lib/x86_64-linux-gnu"
  say "linux-x64: the library with the C library of $oldest"
  "$@" "$places/linux-x64/lancer_render"
  cpp linux-x64 "$@"
  stage linux-x64
  python_tests linux-x64 "$python"
  say "linux-x64: the zips in the Blenders that are here, and the wheel"
  "$python" .ci/package.py "$places" linux-x64
  in_blender "" blender/test_install.py blender/test_repository.py farm/test_wheel.py
  next_debian
  say "linux-x64: the zips and Rendered shading in the next Debian's Blender"
  in_blender "$PWD/.ci/next_blender.sh" blender/test_install.py blender/test_repository.py blender/test_viewport.py \
    -k "not module"
}

# in_blender PROGRAM FILE... [OPTION...]: runs tests with the zips and the library of linux-x64, in Debian's Blender if PROGRAM
# is empty.
in_blender() {
  program=$1 zips=$PWD/build/addons
  shift
  (cd "$places/linux-x64/tree/blender_tests" && TMPDIR=/tmp LANCER_TEST_ZIPS=$zips LANCER_TEST_BLENDER=$program \
    "$python" -m pytest -q -p no:cacheprovider "$@")
}

linux_arm64() {
  root arm64 bookworm arm64 python3
  cpp linux-arm64 qemu-aarch64-static -L "$roots/arm64"
  wheels "$places/python-arm64" 3.11 manylinux_2_28_aarch64 manylinux_2_27_aarch64 manylinux2014_aarch64
  stage linux-arm64
  PYTHONPATH=$places/python-arm64 PYTHONDONTWRITEBYTECODE=1 \
    python_tests linux-arm64 qemu-aarch64-static -L "$roots/arm64" "$roots/arm64/usr/bin/python3.11"
}

windows_x64() {
  # A separate home, without the engines of .NET and HTML.
  export WINEPREFIX="$places/wine" WINEDEBUG=-all WINEDLLOVERRIDES="mscoree,mshtml=;ucrtbase=n,b"
  if [ ! -e "$WINEPREFIX.done" ]; then
    say "Windows' Python"
    mkdir -p "$places/jars"
    for artifact in $windows_python $windows_runtime; do
      mvn -q -B org.apache.maven.plugins:maven-dependency-plugin:3.6.1:copy -Dartifact="$artifact" \
        -DoutputDirectory="$places/jars"
    done
    rm -rf "$places/windows" && mkdir -p "$places/windows"
    "$python" -c 'import sys, zipfile
for path in sys.argv[2:]:
    zipfile.ZipFile(path).extractall(sys.argv[1])' "$places/windows" "$places"/jars/*.jar
    # This module calls functions that wine lacks; Python works without it.
    find "$places/windows" -name _wmi.pyd -delete
    home=$places/windows/org/bytedeco/cpython/windows-x86_64
    cp "$home"/lib/vcruntime*.dll "$places/windows/org/bytedeco/javacpp/windows-x86_64/ucrtbase.dll" "$home"
    /usr/lib/wine/wine64 wineboot -i >/dev/null 2>&1 || true
    touch "$WINEPREFIX.done"
  fi
  home=$places/windows/org/bytedeco/cpython/windows-x86_64
  WINEDLLOVERRIDES="mscoree,mshtml=" cpp windows-x64 /usr/lib/wine/wine64
  wheels "$places/python-windows" 3.12 win_amd64
  stage windows-x64
  PYTHONHOME="Z:$home" PYTHONPATH="Z:$places/python-windows" PYTHONDONTWRITEBYTECODE=1 \
    python_tests windows-x64 /usr/lib/wine/wine64 "$home/python.exe"
}

for platform in "$@"; do
  say "$platform"
  case $platform in
  macos-*) .ci/cross.sh "$platform" "$LANCER_ZIG" lancer ;;
  linux-*) .ci/cross.sh "$platform" "$LANCER_ZIG" lancer lancer_tests lancer_replay lancer_render -- -DLANCER_TESTS=ON ;;
  *) .ci/cross.sh "$platform" "$LANCER_ZIG" lancer lancer_tests lancer_replay -- -DLANCER_TESTS=ON ;;
  esac
  for library in "$places/$platform/lib/"*lancer.dylib "$places/$platform/lib/"*lancer.so "$places/$platform/lib/"*lancer.dll; do
    [ ! -e "$library" ] || "$python" .ci/check_library.py "$platform" "$library"
  done
  case $platform in
  linux-x64) linux_x64 ;;
  linux-arm64) linux_arm64 ;;
  windows-x64) windows_x64 ;;
  macos-*) say "$platform: inspected, not run: this machine cannot run it" ;;
  esac
done
