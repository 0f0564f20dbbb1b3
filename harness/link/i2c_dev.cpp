// SPDX-License-Identifier: Apache-2.0
#include "harness/link/i2c_dev.hpp"

#include <fcntl.h>
#include <linux/i2c-dev.h>
#include <linux/i2c.h>
#include <sys/ioctl.h>
#include <sys/stat.h>

#include <cerrno>
#include <cstdint>
#include <utility>
#include <vector>

#include "harness/link/descriptor.hpp"
#include "harness/link/transaction_bus.hpp"

namespace armjig {
namespace {

constexpr std::size_t kLongestMessage = 8192;  // of the kernel

/// In the kernel's terms. It does not write to what is to be written.
i2c_msg to_kernel(const BusMessage& message) {
  i2c_msg out{};
  out.addr = message.address.value;
  const bool is_read = message.access == Access::kRead;
  if (is_read) out.flags = I2C_M_RD;
  out.len = static_cast<std::uint16_t>(is_read ? message.read.size() : message.write.size());
  out.buf = reinterpret_cast<std::uint8_t*>(is_read ? message.read.data()
                                                    : const_cast<std::byte*>(message.write.data()));
  return out;
}

/// Whether the bus behind a file is gone. Many drivers of adapters that were pulled out say no more
/// than that nobody acknowledged, but the kernel has taken the bus's node away by then.
bool is_gone(const Descriptor& descriptor) {
  struct stat node{};
  return ::fstat(descriptor.value(), &node) == 0 && node.st_nlink == 0;
}

/// The kernel's i2c/fault-codes, as far as drivers keep to them.
Result<Transfer> refusal_of(int error_number) {
  switch (error_number) {
    case ENXIO:
    case EREMOTEIO:
      return Transfer::kAddressRefused;
    case EIO:
      return Transfer::kByteRefused;
    case EAGAIN:
    case EBUSY:
      return fail(ErrorCode::kBusy, error_number);
    case ETIMEDOUT:
      return fail(ErrorCode::kTimedOut, error_number);
    case ENODEV:
    case ESHUTDOWN:
      return fail(ErrorCode::kDisconnected, error_number);
    case EOPNOTSUPP:
      return fail(ErrorCode::kUnsupported, error_number);
    default:
      return tl::unexpected{error_from_errno(error_number)};
  }
}

void send_last_message(int descriptor, Bytes message) noexcept {
  const BusAddress address{static_cast<std::uint8_t>(std::to_integer<unsigned>(message[0]) >> 1U)};
  auto part = to_kernel(write_to(address, message.subspan(1)));
  i2c_rdwr_ioctl_data request{&part, 1};
  ::ioctl(descriptor, I2C_RDWR, &request);
}

class I2cDev final : public RealBus {
 public:
  explicit I2cDev(Descriptor descriptor) noexcept : descriptor_{std::move(descriptor)} {}

  Result<Transfer> transfer(std::span<const BusMessage> messages) override {
    if (!can_do(messages, I2C_RDWR_IOCTL_MAX_MSGS, kLongestMessage)) {
      return fail(ErrorCode::kBadValue);
    }
    std::vector<i2c_msg> parts;
    for (const auto& message : messages) parts.push_back(to_kernel(message));
    i2c_rdwr_ioctl_data request{parts.data(), static_cast<std::uint32_t>(parts.size())};
    const int done = ::ioctl(descriptor_.value(), I2C_RDWR, &request);
    if (done < 0) {
      const int error_number = errno;
      if (is_gone(descriptor_)) return fail(ErrorCode::kDisconnected, error_number);
      return refusal_of(error_number);
    }
    // A driver that stops early without an error has had a byte refused.
    return static_cast<std::size_t>(done) == messages.size() ? Transfer::kDone
                                                             : Transfer::kByteRefused;
  }

  [[nodiscard]] std::optional<Lifeline> lifeline() const override {
    return Lifeline{descriptor_.value(), send_last_message};
  }

 private:
  Descriptor descriptor_;
};

const OpenHints kHints{
    .absent = "there is no such bus; 'i2cdetect -l' lists them, after 'modprobe i2c-dev'",
    .not_allowed = "'sudo usermod -aG i2c $USER' and a new login let you use I2C buses",
    .busy = "is it an I2C bus?",
    .gone = "is it an I2C bus?",
    .wrong_kind = ""};

}  // namespace

Outcome<std::unique_ptr<BusPort>> open_i2c_dev(const std::string& path) {
  Descriptor descriptor{::open(path.c_str(), O_RDWR | O_CLOEXEC)};
  const bool is_named = !path.empty() && (descriptor.is_open() || errno != EISDIR);
  if (!is_named) {
    return problem(ErrorCode::kBadTarget, "i2c:" + path,
                   "it is not an I2C bus; write i2c:/dev/i2c-N");
  }
  if (!descriptor.is_open()) return problem_of_open(path, error_from_errno(errno), kHints);
  unsigned long functions = 0;
  if (::ioctl(descriptor.value(), I2C_FUNCS, &functions) < 0) {
    return problem(ErrorCode::kUnsupported, path, "it is not an I2C bus; write i2c:/dev/i2c-N");
  }
  if (functions == 0) {  // as drivers say it whose adapter does not answer any more
    return problem(ErrorCode::kDisconnected, path,
                   "the adapter does not say what it can do: was it unplugged just now?");
  }
  if ((functions & I2C_FUNC_I2C) == 0) {
    return problem(ErrorCode::kUnsupported, path,
                   "the adapter knows SMBus commands only, and no plain I2C transactions");
  }
  return std::make_unique<I2cDev>(std::move(descriptor));
}

}  // namespace armjig
