// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "emulators/faults/fault.hpp"
#include "emulators/faults/named_fault.hpp"
#include "emulators/morap/defects/quirks.hpp"
#include "emulators/morap/node.hpp"
#include "emulators/morap/pen.hpp"
#include "harness/core/error.hpp"

namespace armjig::morap::emulation {

/// In a motor status a command does something else.
struct WrongRow {
  MotorStatus status{};
  CommandId id{};
  std::optional<CommandId> acts_as;  ///< one without payload; none: nothing at all
};

/// A field of a command or of a reading is wrong on the wire.
struct FieldFault {
  CommandId id{};  ///< of the command, or of what is read
  Fault::Kind kind{};
  std::string field;
};

/// What is wrong with a node in what it hears and says, and with the pen on its bus. What is wrong
/// inside is in its `NodeSetup`.
struct Defects {
  std::vector<FieldFault> heard;
  std::vector<FieldFault> sent;
  std::vector<WrongRow> rows;
  std::vector<const Quirk*> quirks;
  PenSetup pen;  ///< of the pen that is beside it
};

/// A fault of an emulated node as users write it; it changes `setup` or `defects`:
///
///     in.KIND:COMMAND.FIELD     a field of a command; the kinds are those of `parse_fault`
///     out.KIND:READING.FIELD    a field of what is read
///     row:STATUS.COMMAND.ACTION in that status a command is ignored, or acts as another one
///     law:NAME                  a figure or habit of the control law is another one
///     eeprom:NAME               a constant or stored parameter is another one
///     profile:NAME              one difference of the profile turned round
///     quirk:NAME                a wrong behaviour
///     rare:NAME                 one that no suite asks for
///     pen:NAME                  a wrong behaviour of the pen
///
/// Problems: `kBadValue`.
[[nodiscard]] Outcome<void> add_fault(std::string_view text, NodeSetup& setup, Defects& defects);

/// Every fault that there is, as `add_fault` reads it.
[[nodiscard]] std::vector<NamedFault> all_faults();

/// A node with defects: an `EmulatedBusDevice`. Without any it is the node itself.
class DefectiveNode {
 public:
  DefectiveNode(const NodeSetup& setup, Defects defects);

  [[nodiscard]] bool acknowledges(std::uint8_t address) const noexcept;
  void start(Instant time, bool is_read);
  [[nodiscard]] bool write(Instant time, std::byte byte);
  [[nodiscard]] std::byte read(Instant time);
  void stop(Instant time);
  [[nodiscard]] Duration stretch() const;
  void advance_to(Instant time) noexcept { node_.advance_to(time); }
  void restart(Instant time);
  [[nodiscard]] Node& node() noexcept { return node_; }

  /// What no bus can do:
  ///
  ///     power     off and on
  ///     shaft     0: held, from the next power-up on; 1: free, with its motor and load
  ///     encoder   turns a held shaft by so many counts
  ///     adc       what the current sense of a held motor reads
  ///
  /// False: there is no such thing.
  [[nodiscard]] bool set_input(Instant time, std::string_view name, std::int64_t value);

 private:
  /// Of one transaction.
  struct Transaction {
    bool is_read = false;
    bool is_done = false;  ///< the command is complete
    std::size_t read = 0;  ///< bytes
    std::vector<std::byte> bytes;
    std::vector<std::byte> truth;  ///< of an answer, as the node would give it
  };

  void obey(Instant time);
  void replay(Instant time, Bytes command);
  [[nodiscard]] std::vector<std::byte> heard(Instant time);
  void say(Instant time);

  NodeSetup setup_;
  std::optional<PlantParameters> plant_;  ///< of a free shaft
  Defects defects_;
  Node node_;
  Transaction transaction_;
  std::vector<std::optional<std::int64_t>> field_memories_;
  std::vector<QuirkMemory> quirk_memories_;
};
static_assert(EmulatedBusDevice<DefectiveNode>);

}  // namespace armjig::morap::emulation
