// SPDX-License-Identifier: Apache-2.0
// The inputs that the fuzzers begin with and have found, as ordinary tests with any compiler. A
// broken promise aborts; the last file named on standard output is to blame.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <string>
#include <vector>

// Each target under a name of its own.
// NOLINTBEGIN(bugprone-suspicious-include)
#define LLVMFuzzerTestOneInput fuzz_capture_reader
#include "fuzz/capture_reader.cpp"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_kinovazed_server
#include "fuzz/kinovazed_server.cpp"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_morap_node
#include "fuzz/morap_node.cpp"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_morap_wire
#include "fuzz/morap_wire.cpp"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_parol6_board
#include "fuzz/parol6_board.cpp"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_parol6_splitter
#include "fuzz/parol6_splitter.cpp"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_rbtscript
#include "fuzz/rbtscript.cpp"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_telnet_com_port
#include "fuzz/telnet_com_port.cpp"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_trace_reader
#include "fuzz/trace_reader.cpp"
#include "tests/unit/support/source_dir.hpp"
#undef LLVMFuzzerTestOneInput
// NOLINTEND(bugprone-suspicious-include)

namespace armjig {
namespace {

namespace fs = std::filesystem;

using FuzzTarget = int (*)(const std::uint8_t*, std::size_t);

void run_corpus(FuzzTarget target, const char* name) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator{fs::path{source_dir()} / "fuzz/corpus" / name}) {
    files.push_back(entry.path());
  }
  ASSERT_FALSE(files.empty());
  std::ranges::sort(files);
  for (const auto& file : files) {
    std::cout << file.string() << std::endl;  // NOLINT(performance-avoid-endl): before an abort
    std::ifstream in{file, std::ios::binary};
    const std::string input{std::istreambuf_iterator<char>{in}, {}};
    target(reinterpret_cast<const std::uint8_t*>(input.data()), input.size());
  }
}

TEST(FuzzCorpus, MorapMessagesComeBack) { run_corpus(fuzz_morap_wire, "morap_wire"); }

TEST(FuzzCorpus, CuttingTheStreamDifferentlyChangesNothing) {
  run_corpus(fuzz_parol6_splitter, "parol6_splitter");
}

TEST(FuzzCorpus, NoClientEndsTheEmulatedServer) {
  run_corpus(fuzz_kinovazed_server, "kinovazed_server");
}

TEST(FuzzCorpus, CoastingOverPassesCannotBeNoticed) {
  run_corpus(fuzz_parol6_board, "parol6_board");
}

TEST(FuzzCorpus, LeapingOverTicksCannotBeNoticed) { run_corpus(fuzz_morap_node, "morap_node"); }

TEST(FuzzCorpus, AnyTextIsAProgramOrRefused) { run_corpus(fuzz_rbtscript, "rbtscript"); }

TEST(FuzzCorpus, AnyFileIsACaptureOrRefused) { run_corpus(fuzz_capture_reader, "capture_reader"); }

TEST(FuzzCorpus, CuttingAClientOfRfc2217DifferentlyChangesNothing) {
  run_corpus(fuzz_telnet_com_port, "telnet_com_port");
}

TEST(FuzzCorpus, AnyTextIsATraceOrRefused) { run_corpus(fuzz_trace_reader, "trace_reader"); }

}  // namespace
}  // namespace armjig
