// SPDX-License-Identifier: Apache-2.0
// The inputs that the fuzzers begin with and have found, as ordinary tests with any compiler. A
// broken promise aborts; the last file named on standard output is to blame.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

// Each target under a name of its own.
// NOLINTBEGIN(bugprone-suspicious-include)
#define LLVMFuzzerTestOneInput fuzz_capture_reader
#include "fuzz/capture_reader.cpp"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_dissectors
#include "fuzz/dissectors.cpp"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_kinovazed_arm
#include "fuzz/kinovazed_arm.cpp"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_kinovazed_drive
#include "fuzz/kinovazed_drive.cpp"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_kinovazed_server
#include "fuzz/kinovazed_server.cpp"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_kinovazed_session
#include "fuzz/kinovazed_session.cpp"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_kinovazed_steering
#include "fuzz/kinovazed_steering.cpp"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_kinovazed_wire
#include "fuzz/kinovazed_wire.cpp"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_morap_drive
#include "fuzz/morap_drive.cpp"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_morap_motion
#include "fuzz/morap_motion.cpp"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_morap_node
#include "fuzz/morap_node.cpp"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_morap_session
#include "fuzz/morap_session.cpp"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_morap_wire
#include "fuzz/morap_wire.cpp"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_parol6_arm
#include "fuzz/parol6_arm.cpp"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_parol6_board
#include "fuzz/parol6_board.cpp"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_parol6_drive
#include "fuzz/parol6_drive.cpp"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_parol6_frames
#include "fuzz/parol6_frames.cpp"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_parol6_session
#include "fuzz/parol6_session.cpp"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_parol6_splitter
#include "fuzz/parol6_splitter.cpp"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_parol6_way
#include "fuzz/parol6_way.cpp"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_parol6_wire
#include "fuzz/parol6_wire.cpp"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_rbtscript
#include "fuzz/rbtscript.cpp"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_telnet_com_port
#include "fuzz/telnet_com_port.cpp"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_texts
#include "fuzz/texts.cpp"
#undef LLVMFuzzerTestOneInput
#define LLVMFuzzerTestOneInput fuzz_trace_reader
#include "fuzz/trace_reader.cpp"
#undef LLVMFuzzerTestOneInput
// NOLINTEND(bugprone-suspicious-include)
#include "tests/unit/support/source_dir.hpp"

namespace armjig {
namespace {

namespace fs = std::filesystem;

struct FuzzTarget {
  std::string_view name;
  int (*run)(const std::uint8_t*, std::size_t);
};
std::ostream& operator<<(std::ostream& out, const FuzzTarget& target) { return out << target.name; }

constexpr std::array kTargets{FuzzTarget{"capture_reader", fuzz_capture_reader},
                              FuzzTarget{"dissectors", fuzz_dissectors},
                              FuzzTarget{"kinovazed_arm", fuzz_kinovazed_arm},
                              FuzzTarget{"kinovazed_drive", fuzz_kinovazed_drive},
                              FuzzTarget{"kinovazed_server", fuzz_kinovazed_server},
                              FuzzTarget{"kinovazed_session", fuzz_kinovazed_session},
                              FuzzTarget{"kinovazed_steering", fuzz_kinovazed_steering},
                              FuzzTarget{"kinovazed_wire", fuzz_kinovazed_wire},
                              FuzzTarget{"morap_drive", fuzz_morap_drive},
                              FuzzTarget{"morap_motion", fuzz_morap_motion},
                              FuzzTarget{"morap_node", fuzz_morap_node},
                              FuzzTarget{"morap_session", fuzz_morap_session},
                              FuzzTarget{"morap_wire", fuzz_morap_wire},
                              FuzzTarget{"parol6_arm", fuzz_parol6_arm},
                              FuzzTarget{"parol6_board", fuzz_parol6_board},
                              FuzzTarget{"parol6_drive", fuzz_parol6_drive},
                              FuzzTarget{"parol6_frames", fuzz_parol6_frames},
                              FuzzTarget{"parol6_session", fuzz_parol6_session},
                              FuzzTarget{"parol6_splitter", fuzz_parol6_splitter},
                              FuzzTarget{"parol6_way", fuzz_parol6_way},
                              FuzzTarget{"parol6_wire", fuzz_parol6_wire},
                              FuzzTarget{"rbtscript", fuzz_rbtscript},
                              FuzzTarget{"telnet_com_port", fuzz_telnet_com_port},
                              FuzzTarget{"texts", fuzz_texts},
                              FuzzTarget{"trace_reader", fuzz_trace_reader}};

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator{fs::path{source_dir()} / folder}) {
    files.push_back(entry.path());
  }
  std::ranges::sort(files);
  return files;
}

class FuzzCorpus : public testing::TestWithParam<FuzzTarget> {};

TEST_P(FuzzCorpus, BreaksNothing) {
  const auto inputs = files_in(fs::path{"fuzz/corpus"} / GetParam().name);
  ASSERT_FALSE(inputs.empty());
  for (const auto& file : inputs) {
    std::cout << file.string() << std::endl;  // NOLINT(performance-avoid-endl): before an abort
    std::ifstream in{file, std::ios::binary};
    const std::string input{std::istreambuf_iterator<char>{in}, {}};
    GetParam().run(reinterpret_cast<const std::uint8_t*>(input.data()), input.size());
  }
}

INSTANTIATE_TEST_SUITE_P(Of, FuzzCorpus, testing::ValuesIn(kTargets),
                         [](const auto& tested) { return std::string{tested.param.name}; });

TEST(FuzzTargets, AreAllTriedHere) {
  for (const auto& file : files_in("fuzz")) {
    if (file.extension() != ".cpp") continue;
    EXPECT_TRUE(std::ranges::count(kTargets, file.stem().string(), &FuzzTarget::name) == 1) << file;
  }
}

}  // namespace
}  // namespace armjig
