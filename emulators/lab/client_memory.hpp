// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <umockdev.h>

#include <cstddef>
#include <cstring>
#include <memory>
#include <span>
#include <vector>

#include "harness/core/bytes.hpp"

/// What the answers to calls of programs share.
namespace armjig::lab {

struct GObjectUnref {
  void operator()(void* object) const noexcept { g_object_unref(object); }
};
template <class T>
using GObjectRef = std::unique_ptr<T, GObjectUnref>;

/// A piece of the memory of the program whose call is answered.
class ClientMemory {
 public:
  /// Takes over the reference.
  explicit ClientMemory(UMockdevIoctlData* data) noexcept : data_{data} {}

  [[nodiscard]] explicit operator bool() const noexcept { return data_ != nullptr; }
  [[nodiscard]] std::span<const std::byte> bytes() const noexcept {
    return {reinterpret_cast<const std::byte*>(data_->data),
            static_cast<std::size_t>(data_->data_len)};
  }
  /// Requires at least as many bytes.
  template <class T>
  [[nodiscard]] T as(std::size_t offset = 0) const noexcept {
    T value;
    std::memcpy(&value, bytes().data() + offset, sizeof value);
    return value;
  }
  void set(Bytes bytes) {
    std::vector<std::byte> copy{bytes.begin(), bytes.end()};
    umockdev_ioctl_data_update(data_.get(), 0, reinterpret_cast<guint8*>(copy.data()),
                               static_cast<gint>(copy.size()));
  }
  /// What the pointer at `offset` leads to; none if it leads nowhere.
  [[nodiscard]] ClientMemory behind(std::size_t offset, std::size_t size) const {
    GError* error = nullptr;
    auto* found = umockdev_ioctl_data_resolve(data_.get(), offset, size, &error);
    g_clear_error(&error);
    return ClientMemory{found};
  }

 private:
  GObjectRef<UMockdevIoctlData> data_;
};

}  // namespace armjig::lab
