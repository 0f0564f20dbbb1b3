// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <span>

namespace armjig::arm {

inline constexpr std::size_t kMaxJoints = 16;

/// One `T` for each moving joint of an arm, from the base on. Never on the heap.
template <class T>
class PerJoint {
 public:
  constexpr PerJoint() noexcept = default;
  /// Requires `size <= kMaxJoints`.
  constexpr explicit PerJoint(std::size_t size) noexcept : size_{size} {
    assert(size <= kMaxJoints);
  }
  constexpr explicit PerJoint(std::span<const T> values) noexcept : PerJoint(values.size()) {
    std::ranges::copy(values, begin());
  }

  [[nodiscard]] constexpr std::size_t size() const noexcept { return size_; }
  [[nodiscard]] constexpr T& operator[](std::size_t joint) noexcept { return values_[joint]; }
  [[nodiscard]] constexpr const T& operator[](std::size_t joint) const noexcept {
    return values_[joint];
  }
  [[nodiscard]] constexpr T* data() noexcept { return values_.data(); }
  [[nodiscard]] constexpr const T* data() const noexcept { return values_.data(); }
  [[nodiscard]] constexpr T* begin() noexcept { return data(); }
  [[nodiscard]] constexpr T* end() noexcept { return data() + size_; }
  [[nodiscard]] constexpr const T* begin() const noexcept { return data(); }
  [[nodiscard]] constexpr const T* end() const noexcept { return data() + size_; }

 private:
  std::size_t size_ = 0;
  std::array<T, kMaxJoints> values_{};
};

/// Radians, or metres where a joint slides.
using JointVector = PerJoint<double>;

}  // namespace armjig::arm
