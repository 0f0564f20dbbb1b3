// SPDX-License-Identifier: Apache-2.0
#include "harness/latency/generic_probe.hpp"

#include <algorithm>
#include <utility>

namespace armjig::generic {
namespace {

class FixedProbe final : public Probe {
 public:
  FixedProbe(std::string exchange, std::vector<std::byte> request, std::size_t answer_size)
      : exchange_{std::move(exchange)}, request_{std::move(request)}, answer_size_{answer_size} {}

  std::string_view exchange() const noexcept override { return exchange_; }
  Messages request() override { return {&message_, 1}; }
  std::size_t requested(Instant /*now*/, Bytes bytes) override {
    if (!std::ranges::equal(bytes, request_)) return 0;
    size_ = 0;  // what came before was the answer to something else
    return 1;
  }
  std::size_t receive(Instant /*now*/, Bytes bytes) override {
    size_ += bytes.size();
    const auto answers = size_ / answer_size_;
    size_ %= answer_size_;
    return answers;
  }

 private:
  std::string exchange_;
  std::vector<std::byte> request_;
  Bytes message_{request_};
  std::size_t answer_size_;
  std::size_t size_ = 0;  ///< of the answer that has begun
};

}  // namespace

std::unique_ptr<Probe> make_probe(std::string exchange, std::vector<std::byte> request,
                                  std::size_t answer_size) {
  return std::make_unique<FixedProbe>(std::move(exchange), std::move(request), answer_size);
}

}  // namespace armjig::generic
