// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "emulators/memory/hosted.hpp"
#include "harness/wire/dissector.hpp"

/// A link that does to single pieces what links do: loses one, doubles it, holds it back, lets the
/// next one pass it.
namespace armjig {

/// What passed in one piece: bytes that were written together, or a part of a bus transaction.
/// The same program says the same things in the same order even if its times differ, so a piece is
/// known by what it is and by how many like it came before.
struct PieceName {
  Direction direction{};
  std::string name;   ///< of its first message; of a bus `write 12` or `read 12`, with the address
  std::size_t nth{};  ///< of that name, from 1

  friend auto operator<=>(const PieceName&, const PieceName&) = default;
};

struct PassedPiece {
  PieceName name;
  Instant time{};
};

struct Perturbation {
  enum class Kind : std::uint8_t { kLost, kTwice, kLate, kSwapped };
  Kind kind{};
  PieceName piece;
  Duration delay{};  ///< of `kLate`

  friend bool operator==(const Perturbation&, const Perturbation&) = default;
};

/// `lost`, `doubled`, `late`, `swapped with the next`
[[nodiscard]] std::string_view to_string(Perturbation::Kind kind) noexcept;

/// What a piece is called. Each is looked at for itself, so the end of a message that came in two
/// is called `bytes`.
[[nodiscard]] std::string name_of_piece(MakeDissector make_dissector, Direction direction,
                                        Bytes bytes);

/// Decides about each piece, and notes what passed. It belongs to whoever looks at it afterwards,
/// must outlive the device, and is not for two threads at once.
class Gate {
 public:
  using Counts = std::map<std::pair<Direction, std::string>, std::size_t>;

  /// `counts`: of pieces that passed before. `make_dissector` of a bus is not asked.
  explicit Gate(MakeDissector make_dissector, std::vector<Perturbation> wanted = {},
                Counts counts = {})
      : make_dissector_{make_dissector}, wanted_{std::move(wanted)}, counts_{std::move(counts)} {}

  /// What is to become of the piece that passes now; none: it passes.
  const Perturbation* pass(Instant time, Direction direction, Bytes bytes);
  /// The same of a part of a bus transaction.
  const Perturbation* pass(Instant time, std::uint8_t address, bool is_read);

  [[nodiscard]] const std::vector<PassedPiece>& passed() const noexcept { return passed_; }
  [[nodiscard]] const Counts& counts() const noexcept { return counts_; }

 private:
  const Perturbation* pass(Instant time, Direction direction, std::string name);

  MakeDissector make_dissector_;
  std::vector<Perturbation> wanted_;
  Counts counts_;
  std::vector<PassedPiece> passed_;
};

/// The same device behind such a link. A piece that is held back is passed by those after it. On a
/// bus one that is lost is not acknowledged, one that is late holds the clock, and of two that are
/// swapped the first, a write, is acknowledged at once and comes after the second.
[[nodiscard]] std::unique_ptr<HostedStream> put_behind(Gate& gate,
                                                       std::unique_ptr<HostedStream> device);
[[nodiscard]] std::unique_ptr<HostedServer> put_behind(Gate& gate,
                                                       std::unique_ptr<HostedServer> device);
[[nodiscard]] std::unique_ptr<HostedBus> put_behind(Gate& gate, std::unique_ptr<HostedBus> device);

}  // namespace armjig
