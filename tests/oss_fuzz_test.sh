#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# fuzz/oss-fuzz keeps the contract of OSS-Fuzz: what it leaves in OUT runs by itself, elsewhere, with
# its dictionary and its seeds, and finds what is wrong.
#
#   tests/oss_fuzz_test.sh [TARGET...]     those instead of one small target
set -euo pipefail
cd "$(dirname "$0")/.."
targets=("$@")
((${#targets[@]} > 0)) || targets=(parol6_splitter)
work=build/oss-fuzz
export CXX=${CXX:-clang++-19} OUT=$PWD/$work/out WORK=$PWD/$work/work
export CXXFLAGS='-O1 -fsanitize=address,fuzzer-no-link' LIB_FUZZING_ENGINE=-fsanitize=fuzzer
rm -rf "$OUT"
elsewhere=$(mktemp -d)
trap 'rm -rf "$elsewhere"' EXIT

fail() {
  echo "$1"
  exit 1
}

if env -u LIB_FUZZING_ENGINE fuzz/oss-fuzz parol6_splitter 2>"$elsewhere/err"; then
  fail 'it built without an engine'
fi
grep -q 'LIB_FUZZING_ENGINE is not set' "$elsewhere/err" || fail 'it does not say what is missing'
fuzz/oss-fuzz "${targets[@]}"
cp -r "$OUT" "$elsewhere/out"
for target in "${targets[@]}"; do
  name=fuzz_$target
  mkdir "$elsewhere/$target"
  python3 -m zipfile -e "$elsewhere/out/${name}_seed_corpus.zip" "$elsewhere/$target"
  cmp <(ls "$elsewhere/$target") <(ls "fuzz/corpus/$target") || fail "not the seeds of $target"
  [[ -s $elsewhere/out/$name.options ]] || fail "$target has no options"
  (cd "$elsewhere" && env -i "out/$name" -runs=2000 -dict="out/$name.dict" "$target") ||
    fail "$target does not run elsewhere"
done
echo "oss-fuzz: ${#targets[@]} targets run elsewhere"
