#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The mutator that AFL++ takes as a library can be built with its flags, loaded by a program that
# has nothing of a target, and mutates frames into frames. AFL++ itself is not needed.
set -euo pipefail
cd "$(dirname "$0")/.."
build=build/afl
cmake -G Ninja -S . -B "$build" -DCMAKE_BUILD_TYPE= -DCMAKE_CXX_COMPILER="${CXX:-clang++-19}" \
  -DCMAKE_CXX_FLAGS='-O2 -fsanitize-coverage=trace-pc-guard -DFMT_HEADER_ONLY' \
  -DARMJIG_FUZZING_ENGINE=none -DARMJIG_BUILD_FUZZERS=ON -DARMJIG_BUILD_TESTS=OFF \
  -DARMJIG_UNITE=ON >/dev/null
cmake --build "$build" --target fuzz_parol6_splitter_afl
python3 - "$build/fuzz/libfuzz_parol6_splitter_afl.so" fuzz/corpus/parol6_splitter/* <<'END'
import ctypes, pathlib, sys

library = ctypes.CDLL(sys.argv[1])
library.afl_custom_init.restype = ctypes.c_void_p
library.afl_custom_fuzz.restype = ctypes.c_size_t
library.afl_custom_fuzz.argtypes = [ctypes.c_void_p, ctypes.c_char_p, ctypes.c_size_t,
                                    ctypes.POINTER(ctypes.POINTER(ctypes.c_uint8)),
                                    ctypes.c_char_p, ctypes.c_size_t, ctypes.c_size_t]
mutator = library.afl_custom_init(None, 1)
MOST = 4096
out = ctypes.POINTER(ctypes.c_uint8)()
changed = whole = 0
for path in sys.argv[2:]:
    seed = pathlib.Path(path).read_bytes()
    for _ in range(100):
        size = library.afl_custom_fuzz(mutator, seed, len(seed), out, None, 0, MOST)
        if size > MOST:
            sys.exit(f"{path}: {size} bytes are more than there is room for")
        mutant = bytes(out[:size])
        changed += mutant != seed
        whole += mutant.count(b"\xff\xff\xff")
library.afl_custom_deinit(ctypes.c_void_p(mutator))
if not changed or not whole:
    sys.exit(f"{changed} inputs changed, {whole} frames begin in what became of them")
print(f"afl-mutator: {changed} inputs changed, {whole} frames begin in what became of them")
END
