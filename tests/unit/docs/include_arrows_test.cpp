// SPDX-License-Identifier: Apache-2.0
// The picture of docs/architecture.md holds: who includes whom, and one namespace per room.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "tests/unit/docs/generated.hpp"
#include "tests/unit/support/source_dir.hpp"

namespace armjig {
namespace {

namespace fs = std::filesystem;

using docs::Room;

// From the bottom up, but a folder or file stands before the folder that it is in. A new arrow is a
// new word here, and belongs in the picture too.
constexpr Room kRooms[] = {
    {"harness/core", ""},
    {"harness/wire", "harness/core"},
    {"harness/files", "harness/core"},
    {"harness/capture", "harness/core harness/wire harness/files"},
    {"harness/foreign", "harness/core harness/wire harness/files harness/capture"},
    {"harness/arm", "harness/core harness/wire"},
    {"harness/urdf", "harness/core harness/files harness/arm"},
    {"harness/config", "harness/core harness/files"},
    {"harness/compare", "harness/core harness/wire harness/files harness/capture harness/config"},
    {"harness/link", "harness/core harness/wire"},
    {"harness/timing", "harness/core"},
    {"harness/motion", "harness/core harness/wire harness/arm"},
    {"harness/report", "harness/core"},
    {"harness/mealy", "harness/core harness/report"},
    {"harness/drive",
     "harness/core harness/wire harness/arm harness/config harness/link harness/timing "
     "harness/motion"},
    {"harness/rig", "harness/core harness/wire harness/capture harness/link harness/report"},
    {"harness/summary", "harness/core harness/wire harness/capture harness/timing harness/report"},
    {"harness/script",
     "harness/core harness/wire harness/arm harness/motion harness/report harness/drive "
     "harness/rig"},
    {"harness/console",
     "harness/core harness/wire harness/capture harness/arm harness/link harness/timing "
     "harness/motion harness/drive harness/rig"},
    {"harness/latency",
     "harness/core harness/wire harness/capture harness/link harness/timing harness/report "
     "harness/drive harness/rig"},
    {"emulators/faults", "harness/core harness/wire"},
    {"emulators/demo", "harness/core harness/wire emulators/faults"},
    {"emulators/i2c", "harness/core"},
    {"emulators/kinovazed", "harness/core harness/wire harness/arm emulators/faults"},
    {"emulators/morap", "harness/core harness/wire emulators/faults emulators/i2c"},
    {"emulators/parol6", "harness/core harness/wire emulators/faults"},
    {"emulators/sessions",
     "harness/core harness/wire emulators/kinovazed emulators/morap emulators/parol6"},
    {"emulators/replay",
     "harness/core harness/wire harness/capture harness/link emulators/demo emulators/i2c "
     "emulators/kinovazed emulators/morap emulators/parol6 emulators/memory"},
    {"emulators/campaign",
     "harness/core harness/wire harness/files harness/capture harness/config harness/compare "
     "harness/link harness/rig harness/report harness/mealy emulators/sessions emulators/memory "
     "emulators/replay"},
    {"emulators/memory", "harness/core harness/link emulators/i2c"},
    {"emulators/usb", "harness/core harness/link"},
    {"emulators/host",
     "harness/core harness/wire harness/link harness/timing emulators/memory emulators/usb"},
    {"emulators/shadow",
     "harness/core harness/wire harness/capture harness/compare emulators/memory"},
    {"emulators/lab", "harness/core harness/link emulators/memory emulators/usb emulators/host"},
    {"conformance/kinovazed/mutants.cpp", "conformance emulators/kinovazed"},
    {"conformance/morap/mutants.cpp", "conformance emulators/morap"},
    {"conformance/morap/target.cpp", "conformance harness/config emulators/morap"},
    {"conformance/parol6/mutants.cpp", "conformance emulators/parol6"},
    {"conformance",
     "harness/core harness/wire harness/files harness/config harness/link harness/drive "
     "harness/rig harness/report emulators/faults emulators/memory"},
    {"cli/devices", "cli harness emulators conformance"},
    {"cli", "harness emulators conformance"},
};

// What a room adds to armjig::<device>. harness/wire adds nothing: everybody sees its words.
struct Inner {
  const char* files;  ///< a pattern; its last group is the device
  std::string_view name;
};
const Inner kInner[] = {
    {"harness/wire/(\\w+)/.*", ""},
    {"harness/drive/(\\w+)/.*", "::drive"},
    {"harness/motion/(\\w+)/.*", "::planning"},
    {"harness/rig/(\\w+)_judge\\..*", "::rig"},
    {"emulators/(demo|kinovazed|morap|parol6)/.*", "::emulation"},
    {"emulators/replay/(demo|kinovazed|morap|parol6)(_\\w+)?\\..*", "::replay"},
    {"emulators/shadow/(kinovazed|morap|parol6)_figures\\..*", "::shadow"},
    {"emulators/sessions/(kinovazed|morap|parol6)\\..*", "::sessions"},
    {"harness/console/(\\w+)/.*", "::console"},
    {"harness/latency/(kinovazed|morap|parol6)_(?:probe|follower)\\..*", "::latency"},
    {"cli/devices/(\\w+)\\..*", ""},
    {"conformance/(\\w+)/host/.*", "::programs"},
    {"conformance/(\\w+)/(?!host/).*", "::conformance"},
};

struct Line {
  std::string file;
  int number;
  std::string text;
};

/// The lines of all sources that the pattern matches as a whole.
std::vector<Line> lines_of_sources(const char* pattern) {
  const std::regex wanted{pattern};
  const fs::path root{source_dir()};
  std::vector<Line> lines;
  for (const auto* const top : {"harness", "emulators", "conformance", "cli"}) {
    for (const auto& entry : fs::recursive_directory_iterator{root / top}) {
      if (entry.path().extension() != ".hpp" && entry.path().extension() != ".cpp") continue;
      std::ifstream in{entry.path()};
      int number = 0;
      for (std::string text; std::getline(in, text);) {
        ++number;
        if (!std::regex_match(text, wanted)) continue;
        lines.push_back({entry.path().lexically_relative(root).generic_string(), number, text});
      }
    }
  }
  return lines;
}

bool is_below(std::string_view file, std::string_view folder) {
  return file == folder ||
         (file.starts_with(folder) && file.substr(folder.size()).starts_with('/'));
}

bool may_include(const Room& room, std::string_view file) {
  std::istringstream uses{std::string{room.uses}};
  for (std::string folder; uses >> folder;) {
    if (is_below(file, folder)) return true;
  }
  return is_below(file, room.folder);
}

TEST(IncludeArrows, PointOnlyWhereTheTableSays) {
  const std::regex quoted{"#include \"(.*)\""};
  const auto includes = lines_of_sources("#include \".*\"");
  EXPECT_GT(includes.size(), 500U);
  for (const auto& include : includes) {
    const auto room = std::ranges::find_if(
        kRooms, [&](const Room& one) { return is_below(include.file, one.folder); });
    ASSERT_NE(room, std::end(kRooms)) << include.file << " is in no room of the table";
    const auto target = std::regex_replace(include.text, quoted, "$1");
    EXPECT_TRUE(may_include(*room, target))
        << include.file << ":" << include.number << ": " << room->folder << " -> " << target;
  }
}

TEST(IncludeArrows, JudgesDoNotSeeWhatTheyJudge) {
  // The guards, all judges of programs, and the suites but for the list of what can be broken and
  // the opening of what is emulated.
  const std::regex judge{
      "harness/.*|conformance/(demo|kinovazed|morap|parol6)/(?!mutants\\.cpp|target\\.cpp).*"};
  for (const auto& include : lines_of_sources("#include \"emulators/.*")) {
    EXPECT_FALSE(std::regex_match(include.file, judge))
        << include.file << ":" << include.number << ": " << include.text;
  }
}

TEST(IncludeArrows, OnlyEntriesBringDevicesToWhatIsForAll) {
  for (const auto& include :
       lines_of_sources("#include \".*(demo|kinovazed|morap|parol6)[/_.].*\"")) {
    const auto folder = fs::path{include.file}.parent_path().generic_string();
    for (const auto* const shared : {"cli", "conformance", "harness/console"}) {
      EXPECT_NE(folder, shared) << include.file << ":" << include.number << ": " << include.text;
    }
  }
}

/// Whether the line opens that namespace or one in it.
bool is_namespace(std::string_view line, std::string_view name) {
  return line.starts_with(std::string{name} + " {") || line.starts_with(std::string{name} + "::");
}

TEST(Namespaces, OfADeviceHaveOneForEachRoom) {
  for (const auto& line : lines_of_sources("namespace armjig::\\w.* \\{.*")) {
    for (const auto& inner : kInner) {
      std::smatch device;
      if (!std::regex_match(line.file, device, std::regex{inner.files})) continue;
      const auto outer = "namespace armjig::" + device[1].str();
      const auto inner_of_room = outer + std::string{inner.name};
      if (!is_namespace(line.text, outer)) continue;
      EXPECT_TRUE(is_namespace(line.text, inner_of_room))
          << line.file << ":" << line.number << ": not in " << inner_of_room;
    }
  }
}

}  // namespace
std::span<const Room> docs::rooms() noexcept { return kRooms; }

}  // namespace armjig
