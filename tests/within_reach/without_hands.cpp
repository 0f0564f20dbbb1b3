// SPDX-License-Identifier: Apache-2.0
#include "tests/within_reach/without_hands.hpp"

#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

#include "harness/link/port_around.hpp"

namespace armjig::test {
namespace {

template <class Around>
class Handless : public Around {
 public:
  using Around::Around;
  bool touch(std::string_view /*input*/, std::int64_t /*value*/) override { return false; }
  std::optional<std::int64_t> observe(std::string_view /*output*/) override { return std::nullopt; }
};

class HandlessStream final : public Handless<StreamAround> {
 public:
  using Handless::Handless;
  Result<void> write(Bytes bytes) override { return inner().write(bytes); }
  Result<std::size_t> read(std::span<std::byte> into, Instant deadline) override {
    return inner().read(into, deadline);
  }
};

class HandlessBus final : public Handless<BusAround> {
 public:
  using Handless::Handless;
  [[nodiscard]] bool has_operations() const noexcept override { return false; }
  Result<Transfer> transfer(std::span<const BusMessage> messages) override {
    return inner().transfer(messages);
  }
  Result<Ack> start(BusAddress /*address*/, Access /*access*/) override {
    return fail(ErrorCode::kUnsupported);
  }
  Result<Ack> write(std::byte /*byte*/) override { return fail(ErrorCode::kUnsupported); }
  Result<std::byte> read(Ack /*reply*/) override { return fail(ErrorCode::kUnsupported); }
  Result<void> stop() override { return fail(ErrorCode::kUnsupported); }
};

std::unique_ptr<SessionPort> as_it_is(std::unique_ptr<SessionPort> port) { return port; }

}  // namespace

std::unique_ptr<StreamPort> without_hands(std::unique_ptr<StreamPort> port) {
  return std::make_unique<HandlessStream>(std::move(port));
}

std::unique_ptr<SessionSource> without_hands(std::unique_ptr<SessionSource> port) {
  return std::make_unique<Handless<SourceAround>>(std::move(port), as_it_is);
}

std::unique_ptr<BusPort> without_hands(std::unique_ptr<BusPort> port) {
  return std::make_unique<HandlessBus>(std::move(port));
}

}  // namespace armjig::test
