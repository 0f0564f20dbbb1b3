// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include "emulators/campaign/material.hpp"

/// What scripts are changed with: odd values, and where they go in a record.
namespace armjig::campaign {

/// Numbers beside which computations turn: powers of two and of ten, and angles; each with what is
/// next to it, and the same below zero.
inline constexpr std::size_t kEdgeCount = std::size_t{28} * 6;
[[nodiscard]] std::int64_t edge_at(std::size_t place);

/// Bits of a float that computations go wrong with: NaN, inf, -inf, -0, denormal, ends, 1.
inline constexpr std::array<std::int64_t, 9> kOddFloats{0x7FC0'0000, 0x7F80'0000, 0xFF80'0000,
                                                        0x8000'0000, 1,           0x7F7F'FFFF,
                                                        0xFF7F'FFFF, 0x3F80'0000, 0x7F80'0001};

/// Bytes that readers of text or of numbers may take otherwise.
inline constexpr std::string_view kOddBytes{"\0\t\n\v\f\r :+-.,0%\x1a\x7f\x80\xff", 18};

/// Bits of a float with that value, or with a part of it.
[[nodiscard]] std::int64_t float_of(std::int64_t value, float part);

/// The places of the records that send bytes.
[[nodiscard]] std::vector<std::size_t> sent_in(const Script& script);

/// The last of what belongs to the record there: on a bus, a choice and what it chose are read
/// together.
[[nodiscard]] std::size_t end_of_exchange(const Script& script, std::size_t place);

/// The piece of a line that colons divide, replaced.
void set_piece(const Field& field, std::vector<std::byte>& line, std::string_view text);

/// The number into the fields, whose message `whole` is in the record. The message is sound then.
void set_number(const Material& material, KeptRecord& record, const Message& whole,
                std::span<const Field> fields, std::int64_t number, float part);

/// The message into the record; of a bus the address is part of the first and not of the second.
/// False: it is too long.
bool put(Bytes message, KeptRecord& record);

/// Makes lengths and checksums in the record right again, where somebody can.
void seal(const Material& material, KeptRecord& record);

/// What the record sends, in another form; an exchange with that in place of what it sends.
[[nodiscard]] KeptRecord sending(KeptRecord record, std::vector<std::byte> bytes);
[[nodiscard]] Script sending(Script exchange, std::vector<std::byte> bytes);

[[nodiscard]] KeptRecord in_one_piece(KeptRecord one, const KeptRecord& next);

/// Its first bytes; more than there are: some that are not zero at the end.
[[nodiscard]] std::vector<std::byte> cut(std::vector<std::byte> bytes, std::size_t size);

/// Whether all of it may be sent, wherever the device is.
[[nodiscard]] bool is_permitted(const Material& material, const Script& script);

/// With no pause longer than that.
void hurry(Script& script, Duration longest);

/// Leaves out what is for another kind of link, or needs hands that are not there.
void leave_out_unplayable(const Material& material, Script& script);

/// Of a bus whose transactions do not have any form: one of its own for each, of a size that
/// adapters take.
void make_playable(const Material& material, Script& script);

}  // namespace armjig::campaign
