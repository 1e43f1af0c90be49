// SPDX-License-Identifier: GPL-3.0-or-later
// What libFuzzer and the replay of its corpus run: each decoder that sees bytes from outside.
#pragma once

#include <cstddef>
#include <cstdint>

namespace binderjet {

// Each aborts if a decoder breaks its word.
void fuzz_frames(const std::uint8_t* data, std::size_t size);
void fuzz_messages(const std::uint8_t* data, std::size_t size);
void fuzz_usb_texts(const std::uint8_t* data, std::size_t size);
void fuzz_records(const std::uint8_t* data, std::size_t size);
// The printer's side: any bytes down its pipe.
void fuzz_printer(const std::uint8_t* data, std::size_t size);

}  // namespace binderjet
