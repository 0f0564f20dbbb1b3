// SPDX-License-Identifier: Apache-2.0
#include "tests/unit/support/allocations.hpp"

#include <malloc.h>

#include <atomic>
#include <cstdlib>
#include <new>

namespace armjig::test {
namespace {

std::atomic<std::uint64_t> taken{0};
std::atomic<std::size_t> in_use{0};

void* take(std::size_t size) noexcept {
  void* place = std::malloc(size);
  if (place == nullptr) return nullptr;
  ++taken;
  in_use += malloc_usable_size(place);
  return place;
}

void* take_aligned(std::size_t size, std::align_val_t alignment) noexcept {
  const auto unit = static_cast<std::size_t>(alignment);
  void* place = std::aligned_alloc(unit, (size + unit - 1) / unit * unit);
  if (place == nullptr) return nullptr;
  ++taken;
  in_use += malloc_usable_size(place);
  return place;
}

void give_back(void* place) noexcept {
  if (place == nullptr) return;
  in_use -= malloc_usable_size(place);
  std::free(place);
}

}  // namespace

std::uint64_t allocations() noexcept { return taken; }
std::size_t bytes_in_use() noexcept { return in_use; }

}  // namespace armjig::test

// The array and sized forms of the library end up in these.
void* operator new(std::size_t size) {
  void* place = armjig::test::take(size);
  if (place == nullptr) throw std::bad_alloc{};
  return place;
}
void* operator new(std::size_t size, const std::nothrow_t& /*tag*/) noexcept {
  return armjig::test::take(size);
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  void* place = armjig::test::take_aligned(size, alignment);
  if (place == nullptr) throw std::bad_alloc{};
  return place;
}
void operator delete(void* place) noexcept { armjig::test::give_back(place); }
void operator delete(void* place, std::size_t /*size*/) noexcept { armjig::test::give_back(place); }
void operator delete(void* place, std::align_val_t /*alignment*/) noexcept {
  armjig::test::give_back(place);
}
void operator delete(void* place, std::size_t /*size*/, std::align_val_t /*alignment*/) noexcept {
  armjig::test::give_back(place);
}
