// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "emulators/memory/hosted.hpp"

namespace armjig {

/// A hosted device around another one, which does what is not about time and traffic by itself.
template <class Hosted>
class HostedAround : public Hosted {
 public:
  explicit HostedAround(std::unique_ptr<Hosted> device) : device_{std::move(device)} {}

  [[nodiscard]] std::span<const DeviceInput> inputs() const override { return device_->inputs(); }
  [[nodiscard]] std::vector<std::string> take_log() override { return device_->take_log(); }
  [[nodiscard]] std::optional<int> wakes_by() const override { return device_->wakes_by(); }
  [[nodiscard]] bool is_gone() const override { return device_->is_gone(); }

 protected:
  [[nodiscard]] Hosted& device() noexcept { return *device_; }
  [[nodiscard]] const Hosted& device() const noexcept { return *device_; }

 private:
  std::unique_ptr<Hosted> device_;
};

/// The same of one that sends by itself: what it sends is kept here in the form that the outer one
/// gives it.
template <class Hosted>
class SenderAround : public HostedAround<Hosted> {
 public:
  using HostedAround<Hosted>::HostedAround;
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

}  // namespace armjig
