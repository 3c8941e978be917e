#!/bin/sh
# fuzz.sh MINUTES PYTHON    fuzzes the C interface and, at the same time, the loading of snapshots, for so many minutes. An
# input that fails stays in build/fuzz-found, and its report is printed.
set -eu

seconds=$(awk "BEGIN { print int($1 * 60) + 1 }")
python=$2
echo "== calls and files, $seconds s each"
# Python itself is built without sanitizers: preload their library before all others, with libstdc++, whose exceptions it
# intercepts at start-up. Leaks of Python itself are ignored.
files=0
runtime="$(dirname "$(clang++-19 --rtlib=compiler-rt -print-libgcc-file-name)")/libclang_rt.asan-$(uname -m).so"
first="$runtime $(g++ -print-file-name=libstdc++.so)"
LD_PRELOAD="$first" ASAN_OPTIONS=detect_leaks=0 LANCER_LIBRARY="$PWD/build/sanitized/liblancer.so" \
  "$python" blender_tests/helpers/broken_files.py build/fuzz-seed.txt build/fuzz-found "$(date +%s)" 1 "$seconds" \
  >build/fuzz-files.log 2>&1 &
worker=$!
calls=0
build/fuzz/lancer_fuzz -max_total_time="$seconds" -max_len=4096 -timeout=60 -rss_limit_mb=4096 -print_final_stats=1 \
  -artifact_prefix=build/fuzz-found/ build/fuzz-corpus core/fuzz/corpus >build/fuzz.log 2>&1 || calls=$?
wait "$worker" || files=$?
times
[ "$calls" -eq 0 ] || tail -60 build/fuzz.log
grep -E '^stat::' build/fuzz.log || true
[ "$files" -eq 0 ] || tail -60 build/fuzz-files.log
# The last seed after a failure, else the number of files by result.
echo "files: $(cat build/fuzz-seed.txt)"
[ "$calls" -eq 0 ] && [ "$files" -eq 0 ]
