// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "emulators/memory/hosted.hpp"

/// Cores (`hosted_by`) of hosted devices around other ones.
namespace armjig::hosted_by {

/// Has the inner one. What derives from it says what `act` does.
template <class HostedType>
class Around : public HostedType {
 public:
  using Hosted = HostedType;
  explicit Around(std::unique_ptr<Hosted> device) : device_{std::move(device)} {}

 protected:
  [[nodiscard]] Hosted& device() noexcept { return *device_; }
  [[nodiscard]] const Hosted& device() const noexcept { return *device_; }

 private:
  std::unique_ptr<Hosted> device_;
};

/// The same of one that sends by itself: what it sends is kept here in the form that the outer one
/// gives it.
template <class Hosted>
class SenderAround : public Around<Hosted> {
 public:
  using Around<Hosted>::Around;
  using Sent =
      std::remove_const_t<typename decltype(std::declval<const Hosted&>().sent())::element_type>;

  [[nodiscard]] std::span<const Sent> sent() const override { return sent_; }
  void clear_sent() override { sent_.clear(); }

 protected:
  /// Hands `take(Sent)` what the inner one has sent.
  template <class Take>
  void take_sent(Take take) {
    for (const auto& one : this->device().sent()) take(one);
    this->device().clear_sent();
  }

  std::vector<Sent> sent_;
};

/// Does `work()`, then `then()`, and answers what the work did.
template <class Work, class Then>
auto do_then(Work work, Then then) {
  if constexpr (std::is_void_v<decltype(work())>) {
    work();
    then();
  } else {
    auto answer = work();
    then();
    return answer;
  }
}

}  // namespace armjig::hosted_by
