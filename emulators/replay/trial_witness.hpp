// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <set>
#include <utility>

#include "emulators/replay/what_if.hpp"

namespace armjig {

/// Tells a judge what passes, and keeps what the device says. Bytes of it that are no message, and
/// a connection that it ends before its client does, break `device`.
class TrialWitness final : public Overhearer {
 public:
  /// `judge` may be nullptr. It has to outlive this.
  TrialWitness(MakeDissector make_dissector, TrialJudge* judge);

  void to_device(Instant time, Bytes bytes) override;
  void from_device(Instant time, Bytes bytes) override;
  void on_connection(const ConnectionEvent& event) override;
  void on_bus(const BusPart& part) override;
  void on_input(Instant time, std::string_view name, std::int64_t value) override;
  void wait_until(Instant time) override;
  void overlook(Instant from, Instant to) override;

  [[nodiscard]] std::vector<SaidPiece> take_said() { return std::move(said_); }
  [[nodiscard]] std::vector<Breakage> finish();
  [[nodiscard]] std::size_t said() const noexcept { return said_.size(); }

 private:
  void note_who_stays(const ConnectionEvent& event);
  void look_at(Instant time, std::uint32_t lane, Direction direction, Bytes bytes);

  MakeDissector make_dissector_;
  TrialJudge* judge_;
  std::map<std::uint32_t, std::unique_ptr<Dissector>> dissectors_;
  std::set<ConnectionId> left_;  ///< connections whose client said its last
  std::vector<Message> messages_;
  std::vector<SaidPiece> said_;
  std::vector<Breakage> broken_;
};

}  // namespace armjig
