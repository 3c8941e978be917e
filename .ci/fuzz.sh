#!/bin/sh
# fuzz.sh MINUTES PYTHON    fuzzes the C interface and, beside it, the loading of snapshots, for so many minutes each. An input
# that goes wrong stays in build/fuzz-found, and its report is printed.
set -eu

seconds=$(awk "BEGIN { print int($1 * 60) + 1 }")
python=$2
echo "== calls and files, $seconds s each"
# Python itself is not built for the sanitizers: their library comes before all others, with the one that throws, which it looks for
# at once. Python's own leaks are not ours.
files=0
first="$(g++ -print-file-name=libasan.so) $(g++ -print-file-name=libstdc++.so)"
LD_PRELOAD="$first" ASAN_OPTIONS=detect_leaks=0 LANCER_LIBRARY="$PWD/build/sanitize/liblancer.so" \
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
# The last seed where it failed, else how many files met which end.
echo "files: $(cat build/fuzz-seed.txt)"
[ "$calls" -eq 0 ] && [ "$files" -eq 0 ]
