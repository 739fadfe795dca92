#!/usr/bin/env bash
# The tests, in two parts: core, products, simulator and library where qgis cannot be imported, then the plugin inside QGIS with calls of
# the real qgis_process; between them, where no tests are chosen, broken files of `make fuzz`, the same every
# time. Each part is spread over the processor's cores, one file of tests at a time, those with slow tests first. Arguments go to pytest, for example: tools/test.sh -k curbs, or
# tools/test.sh -m 'not slow'. LANEWRIGHT_TEST_WORKERS=0 runs everything in one process, for a debugger.
# A test that takes more than 10 minutes is ended, with the stacks of all threads. A process that dies, which QGIS does once in
# some runs, ends its part, for pytest-xdist 3.8 would wait for the new process for ever; the part then runs once more, or twice.
set -euo pipefail
source "$(dirname "${BASH_SOURCE[0]}")/env.sh"
cd "$LANEWRIGHT_ROOT"
cores="$(env -u OMP_NUM_THREADS nproc)" # nproc believes that variable, and env.sh sets it
part=("$LANEWRIGHT_BUILD/venv/bin/python" -m pytest -q
  -n "${LANEWRIGHT_TEST_WORKERS:-$((cores < 8 ? cores : 8))}" --dist loadfile --no-loadscope-reorder
  --max-worker-restart 0 --timeout 600 --timeout-method thread)
chosen=$#
scratch="$(mktemp -d)"
trap 'rm -rf "$scratch"' EXIT
# Surveys that tests make are made once and shared by all parts and processes of this run.
export LANEWRIGHT_MADE_ONCE="$scratch/made_once"
mkdir "$LANEWRIGHT_MADE_ONCE"
# With -k a part may have nothing to run (pytest says 5); without arguments that is a failure.
run() {
  local code=0 attempt
  for attempt in 1 2 3; do
    code=0
    "$@" | tee "$scratch/said" || code=$?
    [ "$attempt" -lt 3 ] && grep -q "crashed while running" "$scratch/said" || break
    echo "== a process of the tests died (see above): this part once more"
  done
  [ "$code" -eq 5 ] && [ "$chosen" -gt 0 ] && return 0
  return "$code"
}

echo "== core, products, simulator and library, where qgis cannot be imported"
LANEWRIGHT_WITHOUT_QGIS=1 run "${part[@]}" -p no:pytest_qgis -o addopts='--import-mode=importlib -p no:cacheprovider' tests/library tests/simulator tests/core tests/products "$@"
if [ "$chosen" -eq 0 ]; then
  echo "== readers fed with broken files"
  "$LANEWRIGHT_BUILD/venv/bin/python" tools/fuzz.py --runs 100
fi
echo "== the plugin inside QGIS, and real qgis_process"
run "${part[@]}" tests --ignore tests/core --ignore tests/products --ignore tests/simulator --ignore tests/library "$@"
