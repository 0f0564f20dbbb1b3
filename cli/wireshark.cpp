// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "cli/device.hpp"
#include "cli/extcap.hpp"
#include "harness/report/output_file.hpp"

namespace armjig::cli {
namespace {

constexpr auto kWiresharkHelp =
    "Lets Wireshark and tshark read what armjig records of a device.\n"
    "\n"
    "  armjig wireshark install                        dissectors and interfaces, for you\n"
    "  armjig wireshark install --to /tmp/plugins      elsewhere\n"
    "  armjig wireshark dissector DEVICE               one of them, on standard output\n"
    "\n"
    "They are made of the field lists of 'armjig decode', and have the same names:\n"
    "DEVICE.FIELD is a display filter.";

std::string script_of(const Device& device) {
  DissectedLinks links;
  if (const auto* server = std::get_if<OnServer>(&device.port)) links.tcp_port = server->tcp_port;
  const auto* stream = std::get_if<OnStream>(&device.port);
  if (stream != nullptr && stream->usb) {
    links.usb_product = std::uint32_t{stream->usb->vendor} << 16U | stream->usb->product;
  }
  return lua_dissector(device.name, device.title, device.dissection(), links);
}

Exit print_dissector(Devices devices, const std::string& name) {
  const auto device = find_device(devices, name);
  if (!device) return report(device.error());
  if ((*device)->dissection == nullptr) {
    return report({ErrorCode::kUnsupported, name, "there is no dissector for Wireshark of it"});
  }
  fmt::print("{}", script_of(**device));
  return Exit::kPassed;
}

namespace fs = std::filesystem;

/// Where scripts go, and the program that captures.
struct Folders {
  fs::path scripts;
  std::vector<fs::path> programs;
};

/// Where Wireshark looks for what is a user's own; nothing if the user has no home. Programs have
/// moved with Wireshark 4.2.
Folders personal_folders() {
  const auto of_environment = [](const char* name) {
    const auto* const value = std::getenv(name);
    return fs::path{value == nullptr ? "" : value};
  };
  const auto home = of_environment("HOME");
  if (home.empty()) return {};
  const auto own = of_environment("XDG_CONFIG_HOME");
  return {home / ".local/lib/wireshark/plugins",
          {(own.empty() ? home / ".config" : own) / "wireshark/extcap",
           home / ".local/lib/wireshark/extcap"}};
}

Outcome<void> write_file(const fs::path& path, const std::string& content) {
  std::error_code error;
  fs::create_directories(path.parent_path(), error);
  if (error) return tl::unexpected{problem_of_writing(path.parent_path(), error.value())};
  const auto file = OutputFile::open(path, OutputFile::Kind::kWhole);
  if (!file) return tl::unexpected{file.error()};
  if (auto written = (*file)->put(content); !written) return written;
  fmt::print("{}\n", path.string());
  return {};
}

Outcome<void> write_all_of(Devices devices, const Folders& folders) {
  for (const auto& device : devices) {
    if (device.dissection == nullptr) continue;
    const auto path = folders.scripts / fmt::format("armjig_{}.lua", device.name);
    if (auto written = write_file(path, script_of(device)); !written) return written;
  }
  std::error_code error;
  const auto program = fs::read_symlink("/proc/self/exe", error);
  if (error) return problem(ErrorCode::kCannotRead, "/proc/self/exe", "is /proc mounted?");
  for (const auto& folder : folders.programs) {
    const auto path = folder / "armjig";
    if (auto written = write_file(path, extcap_script(program)); !written) return written;
    constexpr auto kMayRun = fs::perms::owner_exec | fs::perms::group_exec | fs::perms::others_exec;
    fs::permissions(path, kMayRun, fs::perm_options::add, error);
    if (error) return tl::unexpected{problem_of_writing(path, error.value())};
  }
  return {};
}

Exit install(Devices devices, const std::string& to) {
  const auto folders = to.empty() ? personal_folders() : Folders{to, {fs::path{to} / "extcap"}};
  if (folders.scripts.empty()) {
    return report({ErrorCode::kBadValue, "HOME", "it is not set; give --to"});
  }
  const auto written = write_all_of(devices, folders);
  return written ? Exit::kPassed : report(written.error());
}

}  // namespace

void add_wireshark(CLI::App& app, Devices devices, Action& action) {
  auto* command = app.add_subcommand("wireshark", with_example(kWiresharkHelp, devices));
  command->require_subcommand(1);

  auto* dissector =
      command->add_subcommand("dissector", "prints the dissector of a device, a Lua script");
  const auto device = std::make_shared<std::string>();
  add_device_argument(*dissector, *device, devices);
  when_chosen(*dissector, action, [device, devices] { return print_dissector(devices, *device); });

  auto* installer = command->add_subcommand(
      "install", "writes the dissectors, and what captures, where they are found");
  const auto to = std::make_shared<std::string>();
  installer->add_option("--to", *to, "this folder, in place of your own ones")->type_name("DIR");
  when_chosen(*installer, action, [to, devices] { return install(devices, *to); });
  add_extcap(*command, devices, action);
}

}  // namespace armjig::cli
