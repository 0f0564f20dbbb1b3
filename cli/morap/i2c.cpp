// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "cli/checks.hpp"
#include "cli/morap/bus_session.hpp"
#include "cli/morap/commands.hpp"
#include "harness/capture/message_json.hpp"
#include "harness/core/hex.hpp"
#include "harness/wire/dissector.hpp"
#include "harness/wire/morap/dissector.hpp"
#include "harness/wire/morap/message.hpp"
#include "harness/wire/morap/pen.hpp"

namespace armjig::cli {
namespace {

using morap::drive::BusCode;
using morap::drive::Master;

constexpr auto kI2cHelp =
    "Single transactions on an I2C bus, and what they mean to MORAP nodes and the pen.\n"
    "\n"
    "  armjig i2c scan --target i2c:/dev/i2c-1\n"
    "  armjig i2c read 0x12 4 --select 80 --target i2c:/dev/i2c-1     choose, stop, read four "
    "bytes\n"
    "  armjig i2c write 0x12 83 --target i2c-tiny-usb:                hexadecimal digits\n"
    "  armjig i2c write 0x12 01 00 00 80 3F --target i2c:/dev/i2c-1 --allow move\n"
    "\n"
    "Exit codes: 0 acknowledged, 1 a byte was refused, 3 no such bus or nobody at the address, 4 "
    "a\n"
    "scan found nobody.";

constexpr std::size_t kLongestRead = 8192;

struct I2cOptions {
  TargetOptions target;
  unsigned address = 0;
  std::size_t count = 1;
  std::vector<std::string> hex;
  std::vector<std::string> select;
  bool wants_json = false;
};

std::string guess(BusAddress address) {
  if (address.value == morap::pen::kAddress) return "MORAP pen end-effector (or node 9)";
  const auto node = morap::node_of(address.value);
  if (node <= morap::kLastDocumentedNode) return fmt::format("MORAP node {}", node);
  if (node < morap::kLastNode) return fmt::format("MORAP node {}, not documented", node);
  return "unknown";
}

/// Transactions as they pass, with their meaning.
class Transcript {
 public:
  explicit Transcript(bool wants_json) : wants_json_{wants_json} {}

  void add(Instant time, BusAddress address, Access access, Bytes data) {
    const auto read = access == Access::kRead ? 1U : 0U;
    std::vector<std::byte> bytes{static_cast<std::byte>(unsigned{address.value} << 1U | read)};
    bytes.insert(bytes.end(), data.begin(), data.end());
    std::vector<Message> messages;
    dissector_->feed(read == 1 ? Direction::kFromDevice : Direction::kToDevice, time, bytes,
                     messages);
    for (const auto& message : messages) {
      fmt::print("{}\n", wants_json_ ? to_json(message) : to_text(message));
    }
  }

 private:
  bool wants_json_;
  std::unique_ptr<Dissector> dissector_ = morap::make_dissector();
};

Outcome<std::vector<std::byte>> parse_bytes(const std::vector<std::string>& words) {
  std::string text;
  for (const auto& word : words) text += word + ' ';
  auto bytes = from_hex(text);
  if (bytes) return *std::move(bytes);
  return problem(bytes.error().code, fmt::format("'{}'", text.substr(0, text.size() - 1)),
                 "write two digits for each byte");
}

Exit scan(const Device& device, const I2cOptions& options) {
  auto rig = open_bus_rig(device, options.target);
  if (!rig) return report(rig.error());
  const auto found = Master{rig->port()}.scan();
  if (found.code != BusCode::kOk) return report(found.code, {}, *rig);
  for (const auto address : found.addresses) {
    if (options.wants_json) {
      const nlohmann::ordered_json one{{"address", address.value}, {"guess", guess(address)}};
      fmt::print("{}\n", one.dump());
    } else {
      fmt::print("0x{:02X}  {}\n", address.value, guess(address));
    }
  }
  if (!found.addresses.empty()) return Exit::kPassed;
  fmt::print(stderr, "armjig: {}: nobody answers on this bus\n", options.target.target);
  return Exit::kNothing;
}

/// Opens the bus and does `work(master, address, bytes)`, which answers how its last transaction
/// ended.
template <class Work>
Exit with_bytes(const Device& device, const I2cOptions& options,
                const std::vector<std::string>& words, Work work) {
  const auto bytes = parse_bytes(words);
  if (!bytes) return report(bytes.error());
  auto rig = open_bus_rig(device, options.target);
  if (!rig) return report(rig.error());
  const BusAddress address{static_cast<std::uint8_t>(options.address)};
  Master master{rig->port()};
  const auto code = work(master, address, *bytes);
  return code == BusCode::kOk ? Exit::kPassed : report(code, address, *rig);
}

Exit write(const Device& device, const I2cOptions& options) {
  const auto transmit = [&](Master& master, BusAddress address, Bytes bytes) {
    const auto code = master.transmit(address, bytes);
    if (code != BusCode::kOk) return code;
    Transcript{options.wants_json}.add(master.now(), address, Access::kWrite, bytes);
    return code;
  };
  return with_bytes(device, options, options.hex, transmit);
}

Exit read(const Device& device, const I2cOptions& options) {
  const auto receive = [&](Master& master, BusAddress address, Bytes choice) {
    Transcript transcript{options.wants_json};
    if (!choice.empty()) {
      const auto code = master.transmit(address, choice);
      if (code != BusCode::kOk) return code;
      transcript.add(master.now(), address, Access::kWrite, choice);
    }
    std::vector<std::byte> bytes(options.count);
    const auto code = master.receive(address, bytes);
    if (code == BusCode::kOk) transcript.add(master.now(), address, Access::kRead, bytes);
    return code;
  };
  return with_bytes(device, options, options.select, receive);
}

using RunOnBus = Exit (*)(const Device& device, const I2cOptions& options);

CLI::App* add(CLI::App& app, const Device& device, Action& action, const char* name,
              const char* help, const std::shared_ptr<I2cOptions>& options, RunOnBus run) {
  auto* command = app.add_subcommand(name, help);
  add_target_options(*command, options->target);
  command->add_flag("--json", options->wants_json, "one JSON object a line");
  when_chosen(*command, action, [options, run, &device] { return run(device, *options); });
  return command;
}

void add_address(CLI::App& command, I2cOptions& options) {
  command.add_option("ADDRESS", options.address, "seven bits, as in 0x12")
      ->required()
      ->type_name("")
      ->transform(whole(0, 0x7F));
}

}  // namespace

void add_i2c(CLI::App& app, const Device& device, Action& action) {
  auto* i2c = app.add_subcommand("i2c", kI2cHelp);
  i2c->require_subcommand(1);
  const auto options = std::make_shared<I2cOptions>();
  add(*i2c, device, action, "scan", "Who answers, at the addresses 08 to 77.", options, scan);
  auto* reading = add(*i2c, device, action, "read", "Reads bytes from a device.", options, read);
  add_address(*reading, *options);
  reading->add_option("COUNT", options->count, "how many bytes (default: 1)")
      ->type_name("")
      ->transform(whole(1, kLongestRead));
  reading
      ->add_option("--select", options->select,
                   "write these bytes first, in a transaction of their own")
      ->type_name("HEX");
  auto* writing = add(*i2c, device, action, "write", "Writes bytes to a device; none: is it there?",
                      options, write);
  add_address(*writing, *options);
  writing->add_option("HEX", options->hex, "hexadecimal digits, in any number of words")
      ->type_name("");
}

}  // namespace armjig::cli
