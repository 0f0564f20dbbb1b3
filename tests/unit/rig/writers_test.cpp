// SPDX-License-Identifier: Apache-2.0
// Who can write to a device, and that all of them pass the guard. The sources are searched for each
// step of the way from a target string to a byte on a wire; whoever appears on it has to be listed
// here, with the reason why that is safe.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <regex.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/unit/support/source_dir.hpp"

namespace armjig {
namespace {

namespace fs = std::filesystem;

/// A file on the way, from the root of the tree, and why it may be there.
struct Allowed {
  const char* file;
  const char* reason;
};

/// One step of the way.
struct Step {
  const char* what;
  const char* pattern;
  std::vector<Allowed> allowed;
};

// Everything that is not in the test program. emulators/ is the other end of the wire.
constexpr std::array kRooms{"cli", "conformance", "emulators", "fuzz", "harness"};

std::string read(const fs::path& path) {
  std::ifstream in{path, std::ios::binary};
  return {std::istreambuf_iterator<char>{in}, {}};
}

/// Comments may say what they like.
std::string without_comments(const std::string& source) {
  std::string code;
  for (std::size_t begin = 0; begin < source.size();) {
    const auto comment = std::min(source.find("//", begin), source.size());
    code.append(source, begin, comment - begin);
    begin = std::min(source.find('\n', comment), source.size());
  }
  return code;
}

struct Source {
  std::string file;
  std::string code;
};

const std::vector<Source>& sources() {
  static const auto all = [] {
    std::vector<Source> found;
    const fs::path root{source_dir()};
    for (const auto* room : kRooms) {
      for (const auto& entry : fs::recursive_directory_iterator{root / room}) {
        const auto extension = entry.path().extension();
        if (extension != ".cpp" && extension != ".hpp") continue;
        found.push_back({fs::relative(entry.path(), root).generic_string(),
                         without_comments(read(entry.path()))});
      }
    }
    return found;
  }();
  return all;
}

/// By the C library, because std::regex took twenty seconds.
std::vector<std::string> files_with(const std::string& pattern) {
  regex_t regex;
  EXPECT_EQ(regcomp(&regex, pattern.c_str(), REG_EXTENDED | REG_NOSUB), 0) << pattern;
  std::vector<std::string> files;
  for (const auto& source : sources()) {
    if (regexec(&regex, source.code.c_str(), 0, nullptr, 0) == 0) files.push_back(source.file);
  }
  regfree(&regex);
  return files;
}

const std::vector<Step>& steps() {
  static const std::vector<Step> all{
      {"opening a device that is not emulated",
       R"(\b(open_pty|open_tcp_stream|open_rfc2217|speak_rfc2217|open_serial|open_usb_stream|open_i2c_dev|open_i2c_tiny_usb|make_tcp_session|open_tcp_server)\s*\()",
       {{"harness/link/i2c_dev.cpp", "makes them"},
        {"harness/link/i2c_dev.hpp", "declares them"},
        {"harness/link/i2c_tiny_usb.cpp", "makes them"},
        {"harness/link/i2c_tiny_usb.hpp", "declares them"},
        {"harness/link/real_streams.cpp", "makes them"},
        {"harness/link/real_streams.hpp", "declares them"},
        {"harness/link/rfc2217_stream.cpp", "makes them"},
        {"harness/link/rfc2217_stream.hpp", "declares them"},
        {"harness/link/serial_stream.cpp", "makes them"},
        {"harness/link/serial_stream.hpp", "declares them"},
        {"harness/link/tcp_session.cpp", "makes them"},
        {"harness/link/tcp_session.hpp", "declares them"},
        {"harness/link/usb_stream.cpp", "makes them"},
        {"harness/link/usb_stream.hpp", "declares them"},
        {"harness/rig/real_target.cpp", "in open_target (next step)"}}},
      {"opening a target without a guard",
       R"(\bopen_target\b)",
       {{"harness/rig/real_target.cpp", "makes it"},
        {"harness/rig/real_target.hpp", "declares it"},
        {"cli/reference.cpp", "opens nothing but what this process emulates, on a link of its own"},
        {"cli/presented.cpp", "a cable between a program and the device: nothing of ours is sent"},
        {"cli/device.hpp", "makes it Wiring::open_real (next step), and does not call it"}}},
      {"opening a real target by its wiring",
       R"(\bopen_real\b)",
       {{"harness/rig/wiring.hpp", "declares it"},
        {"harness/rig/rig.cpp", "guards what is not emulated; rig_test.cpp shows that"},
        {"cli/device.hpp", "says what it is"}}},
      {"making a rig around a port that is open already, without a guard",
       R"(\bRig\s*(<[^<>]*>)?(\s+\w+)?\s*\{)",
       {{"harness/rig/rig.hpp", "declares it"},
        {"harness/rig/rig.cpp", "puts the guard there, or had a guarded server before"}}},
      {"opening a rig",
       R"(\bRig\s*(<[^<>]*>)?::open\s*\(|\b(open_rig|with_rig)\s*(<\w+>)?\s*\()",
       {{"harness/rig/rig.cpp", "makes it"},
        {"cli/device.hpp", "makes the rig of a device's entry"},
        {"cli/device.cpp", "hands it to the entry's bench, console or watch"},
        {"cli/morap/bus_session.cpp", "for every subcommand that has a bus behind --target"},
        {"cli/replaying.cpp", "with the guard; asks before for what the recording needs"},
        {"cli/fuzz_material.cpp", "with the guard; leaves out before what it would refuse"},
        {"cli/parol6/run.cpp", "hands its port to a drive loop"}}},
      {"writing to a port",
       R"((\.|->)(write|transfer)\s*\()",
       {{"harness/link/real_streams.cpp", "passes on what it is given"},
        {"harness/link/rfc2217_stream.cpp", "passes on what it is given, escaped"},
        {"harness/console/generic.cpp", "the port of the rig that it was given"},
        {"harness/rig/stream_link.cpp", "the bus of the rig that it was given"},
        {"harness/latency/path.cpp", "the port of the rig that it was given"},
        {"harness/latency/parol6_follower.cpp", "the port of a rig that is emulated"},
        {"harness/console/watched.cpp", "the port of the rig that it was given"},
        {"conformance/stream_bench.cpp", "the port of the rig that `armjig conformance` opened"},
        {"conformance/bus_bench.cpp", "the bus of the rig that `armjig conformance` opened"},
        {"conformance/morap/chapters/bus.cpp", "the same bus, by way of the bench"},
        {"conformance/morap/chapters/pen.cpp",
         "the same bus, to the pen on it, by way of the bench"},
        {"emulators/memory/impaired.cpp", "hands on to an emulated bus what is left"},
        {"emulators/memory/overheard.cpp", "hands on what a program writes to an emulated bus"},
        {"emulators/campaign/stage.cpp", "to the emulated bus of a stand-in"},
        {"emulators/replay/perturbed.cpp", "hands it on, too, or not"},
        {"emulators/replay/recorded_host.cpp", "to an emulated bus"},
        {"emulators/shadow/shadow.cpp", "to an emulated bus"},
        {"emulators/morap/defects/defects.cpp", "an emulated node"},
        {"harness/drive/parol6/drive_loop.cpp", "whoever makes a loop hands it the port of a rig"},
        {"emulators/lab/i2c_adapter.cpp", "the other end: a virtual bus for other programs"},
        {"emulators/lab/i2c_calls.cpp", "the other end: a virtual bus for other programs"},
        {"emulators/memory/hosted.hpp", "to an emulated bus"},
        {"emulators/usb/tiny_usb.cpp", "the other end: an adapter in front of an emulated bus"},
        {"emulators/i2c/bus.cpp", "to the emulated devices on it"},
        {"emulators/i2c/bus.hpp", "to an emulated device"},
        {"emulators/host/relay.cpp", "passes on what a program sends: a cable without a guard"},
        {"emulators/kinovazed/server.cpp", "to its log"},
        {"emulators/morap/step_response.cpp", "to an emulated bus"},
        {"emulators/replay/morap.cpp", "to an emulated bus"},
        {"emulators/replay/host_role.cpp", "the port of the rig that it was given"},
        {"emulators/replay/on_port.cpp", "to an emulated device in memory"},
        {"emulators/replay/replay.cpp", "makes the lines of a recording of them"},
        {"cli/devices/morap_machine.cpp", "writes down what the port of a rig is given to play"},
        {"fuzz/morap_motion.cpp", "a bus of its own, in memory"},
        {"fuzz/morap_node.cpp", "buses of its own, in memory"},
        {"harness/drive/morap/master.cpp", "whoever makes a master hands it a port"},
        {"harness/link/bus_port.cpp", "to an emulated device"},
        {"harness/link/emulated_bus_port.hpp", "to an emulated bus"},
        {"harness/link/i2c_tiny_usb.cpp", "makes them"},
        {"harness/link/impaired_bus.cpp", "passes on what it is given"},
        {"harness/link/impaired_stream.cpp", "passes on what it is given"},
        {"harness/link/reopening_ports.cpp", "passes on what it is given"},
        {"harness/rig/guarded_ports.cpp", "is the guard"},
        {"harness/rig/guarded_ports.hpp", "is the guard"},
        {"harness/rig/logged_ports.cpp", "passes on what it is given"},
        {"harness/rig/stoppable_ports.cpp", "passes on what it is given"},
        {"harness/core/emulation.hpp", "a concept of emulated devices, no code"}}},
      {"sending in a session",
       R"(\b(SessionPort|make_port)\b)",
       {{"harness/link/impaired_session.cpp", "passes on what it is given"},
        {"harness/link/impaired_session.hpp", "passes on what it is given"},
        {"harness/link/memory_session.hpp", "to an emulated device in memory"},
        {"harness/link/port_around.hpp", "passes on what it is given"},
        {"harness/link/session_port.hpp", "declares it"},
        {"harness/link/session_source.hpp", "declares what makes several"},
        {"harness/link/session_stream.cpp", "passes on what it is given"},
        {"harness/link/session_stream.hpp", "passes on what it is given"},
        {"harness/link/tcp_session.cpp", "makes them"},
        {"harness/link/tcp_session.hpp", "declares them"},
        {"emulators/host/relay.cpp", "passes on what a program sends: a cable without a guard"},
        {"emulators/campaign/stage.cpp",
         "of the rig that it was given; connects, and says nothing"},
        {"emulators/replay/host_role.cpp", "the port of the rig that it was given"},
        {"emulators/replay/on_port.cpp", "to an emulated device in memory"},
        {"harness/console/kinovazed/console.cpp", "of the rig that it was given, to a client"},
        {"harness/drive/kinovazed/client.cpp", "whoever makes a client hands it the port of a rig"},
        {"harness/drive/kinovazed/client.hpp", "whoever makes a client hands it the port of a rig"},
        {"harness/rig/guarded_ports.cpp", "is the guard"},
        {"harness/rig/guarded_ports.hpp", "is the guard"},
        {"harness/rig/logged_ports.cpp", "passes on what it is given"},
        {"harness/rig/logged_ports.hpp", "passes on what it is given"},
        {"harness/rig/rig.cpp", "puts impairments around it, outside the guard"},
        {"harness/rig/stoppable_ports.cpp", "passes on what it is given"},
        {"conformance/kinovazed/server_bench.cpp", "of the rig that it was given"},
        {"conformance/kinovazed/server_bench.hpp", "of the rig that it was given"}}},
      {"system calls that put bytes on a wire",
       R"(\W::(write|pwrite|writev|send|sendto|sendmsg|sp_\w*write)\s*\()",
       {{"cli/serving.cpp", "to itself, in a signal: it has to end"},
        {"emulators/host/pty_link.cpp", "an emulated device answers its client"},
        {"harness/link/descriptor.cpp", "for the real ports of this room"},
        {"harness/latency/path.cpp", "only as many bytes as the guard has just admitted"},
        {"harness/report/output_file.cpp", "files of a user"},
        {"harness/rig/supervisor.cpp", "the stop, which is always allowed; and to its parent"}}},
      {"getting at the file behind a port",
       R"(lifeline\(\))",
       {{"harness/link/endpoint.hpp", "declares it"},
        {"harness/link/descriptor.hpp", "answers it"},
        {"harness/link/i2c_dev.cpp", "answers it"},
        {"harness/link/i2c_tiny_usb.cpp", "answers it"},
        {"harness/link/real_streams.cpp", "answers it"},
        {"harness/link/rfc2217_stream.cpp", "answers what is inside"},
        {"harness/link/tcp_session.cpp", "answers it"},
        {"harness/link/usb_stream.cpp", "answers it"},
        {"harness/link/port_around.hpp", "passes on what it is given"},
        {"harness/rig/guarded_ports.hpp", "passes on what it is given"},
        {"harness/rig/direct_line.cpp", "of guarded ports only, together with their guard"},
        {"emulators/host/relay.cpp", "waits until it is readable"},
        {"harness/rig/guarded_ports.cpp",
         "hands it to the supervisor, which sends only the stop"}}},
      {"sending through the file behind a port",
       R"(\bsend_last\w*\s*\(|\bline\.send\s*\()",
       {{"harness/link/descriptor.hpp", "declares it"},
        {"harness/link/descriptor.cpp", "makes it"},
        {"harness/link/i2c_dev.cpp", "makes it"},
        {"harness/link/i2c_tiny_usb.cpp", "makes it"},
        {"harness/link/real_streams.cpp", "makes the terminal raw first"},
        {"harness/link/rfc2217_stream.cpp", "escapes the message first"},
        {"harness/link/usb_control.hpp", "declares it"},
        {"harness/link/usb_control.cpp", "makes it"},
        {"harness/link/usb_stream.cpp", "makes it"},
        {"harness/rig/supervisor.cpp", "the stop, which is always allowed"}}},
      {"talking to drivers",
       R"(\b(I2C_RDWR|USBDEVFS_\w+)\b)",
       {{"harness/link/i2c_dev.cpp", "I2C buses"},
        {"harness/link/usb_control.cpp", "the last message of a program that has gone"},
        {"harness/link/usb_stream.cpp", "the same for boards"},
        {"emulators/lab/i2c_calls.cpp", "the emulated bus answers its client"}}},
      {"opening files by system call",
       R"([^_[:alnum:]>]::(open|openat|socket|posix_openpt|sp_open)\s*\()",
       {{"emulators/host/pseudo_terminal.cpp",
         "the terminal on which an emulated device is served"},
        {"harness/link/i2c_dev.cpp", "I2C buses"},
        {"harness/link/descriptor.cpp", "terminals"},
        {"harness/link/serial_stream.cpp", "sets a terminal up by libserialport"},
        {"cli/outputs.cpp", "what stands for standard streams that were closed"},
        {"harness/files/user_file.cpp", "to read; neither devices nor folders"},
        {"harness/report/output_file.cpp",
         "files of a user, which it does not open if they are ports"},
        {"harness/rig/doctor.cpp", "a pseudo-terminal, to see whether there are any"}}},
      {"libraries that reach hardware",
       R"(#include <(libserialport\.h|libusb[^>]*|linux/i2c[^>]*|i2c/[^>]*|linux/spi[^>]*)>)",
       {{"emulators/lab/i2c_adapter.hpp", "the emulated bus answers its client"},
        {"emulators/lab/i2c_calls.cpp", "the emulated bus answers its client"},
        {"harness/link/i2c_dev.cpp", "I2C buses"},
        {"harness/link/serial_stream.cpp", "sets serial ports up"},
        {"harness/link/usb_control.cpp", "for i2c_tiny_usb"},
        {"harness/link/usb_device.cpp", "finds and opens devices, and says nothing to them"},
        {"harness/link/usb_stream.cpp", "serial ports of USB boards"}}},
  };
  return all;
}

TEST(Writers, EachOneIsListedWithAReason) {
  for (const auto& step : steps()) {
    std::vector<std::string> listed;
    for (const auto& allowed : step.allowed) listed.emplace_back(allowed.file);
    EXPECT_THAT(files_with(step.pattern), ::testing::UnorderedElementsAreArray(listed))
        << "for " << step.what
        << ". A new file must not get around the guard: let it write to the port of a Rig, then "
           "list it here with the reason.";
  }
}

TEST(Writers, TheSearchFindsWhatIsThere) {
  EXPECT_GT(sources().size(), 100U);
  EXPECT_EQ(without_comments("a // open_pty(\nb"), "a \nb");
  EXPECT_THAT(files_with(R"(no_such_function_anywhere\()"), ::testing::IsEmpty());
}

TEST(Writers, TheOnlyWayToARigIsTheOneThatGuards) {
  // Rig::open, step by step: what was opened goes into a guard unless it is emulated, and nothing
  // after that takes it out again.
  const auto code = without_comments(read(fs::path{source_dir()} / "harness/rig/rig.cpp"));
  const auto opened = code.find("port = open_port(");
  const auto asked = code.find("if (!options.target.is_emulated())");
  const auto guarded = code.find("guard_port(wiring, std::move(rig.port_)");
  EXPECT_LT(opened, asked);
  EXPECT_LT(asked, guarded);
  EXPECT_NE(guarded, std::string::npos);
  EXPECT_EQ(code.find("= open_port(", opened + 1 + sizeof "port "), std::string::npos) << "twice";
  for (const auto* guard : {"GuardedStream, GuardedBus>;", "GuardedPort<Port>::guard(",
                            "make_unique<GuardedSource>("}) {
    EXPECT_NE(code.find(guard), std::string::npos) << guard;
  }
}

}  // namespace
}  // namespace armjig
